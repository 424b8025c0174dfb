//! Quantities compared between meshes: displacements at points that all meshes have, forces on tools, and energies.

use sinew_scene::{BodyModel, ProbeAt, ProbePoint, Simulation, Subject as SceneSubject};

use super::caveats::Caveat;
use super::error::ConvergeError;
use super::quantity::{Subject, is_estimated};

/// Displacements, forces and energies of a motion, instant after instant.
#[derive(Clone, Debug, Default)]
pub(super) struct Observed {
    /// Displacements of the nodes of the scene's mesh, which are the first of every refined one (m).
    nodes: Vec<f64>,
    /// Displacements at the points of probes (m).
    probes: Vec<Vec<f64>>,
    /// Forces on tools, means since the previous instant (N).
    forces: Vec<Vec<f64>>,
    /// Elastic energy (J).
    energy: Vec<f64>,
}

/// The values of a quantity among the observed ones.
pub(super) type Of = Box<dyn Fn(&Observed) -> &[f64]>;

/// The points that are observed on every mesh.
#[derive(Clone, Debug)]
pub(super) struct Places {
    nodes: usize,
    probes: Vec<ProbePlace>,
    /// The names of the tools.
    tools: Vec<String>,
}

/// The place of a probe.
#[derive(Clone, Debug)]
struct ProbePlace {
    name: String,
    at: At,
    /// Its distance (m) from the body, if it is outside.
    outside: Option<f64>,
}

#[derive(Clone, Copy, Debug)]
enum At {
    /// A point within the body (m).
    Point([f64; 3]),
    /// A node of the scene's mesh.
    Node(u32),
    /// The mean over a group, for the probe with this index in the list.
    Mean(usize),
}

/// Barycentric coordinates above the negative of this belong to a tetrahedron.
const ON_FACE: f64 = 1e-9;

impl Places {
    pub(super) fn of(simulation: &Simulation) -> Result<Self, ConvergeError> {
        let body = body_of(simulation)?;
        let written = match simulation.scene().subject() {
            SceneSubject::Body(body) => &body.probes[..],
            SceneSubject::Oscillator(_) => &[],
        };
        let displaced = simulation.probes().iter().enumerate();
        let displaced = displaced.filter(|(_, probe)| is_estimated(probe));
        let probes = displaced.map(|(index, probe)| {
            let asked = written
                .iter()
                .find_map(|written| asked(written, &probe.name));
            let inside = asked.filter(|point| surrounding(body, *point).is_some());
            let outside = probe.node.filter(|_| asked.is_some() && inside.is_none());
            ProbePlace {
                name: probe.name.clone(),
                at: match (inside, probe.node) {
                    (Some(point), _) => At::Point(point),
                    (None, Some(node)) => At::Node(node.index),
                    (None, None) => At::Mean(index),
                },
                outside: outside.map(|node| node.distance),
            }
        });
        Ok(Self {
            nodes: body.mesh.points.len(),
            probes: probes.collect(),
            tools: body
                .tools
                .iter()
                .flat_map(|tools| tools.tools())
                .map(|tool| tool.name.clone())
                .collect(),
        })
    }

    /// All that is observed.
    pub(super) fn subjects(&self) -> Vec<(Subject, Of)> {
        let probes = self.probes.iter().enumerate().map(|(index, probe)| {
            let of: Of = Box::new(move |observed| &observed.probes[index]);
            (Subject::Probe(probe.name.clone()), of)
        });
        let forces = self.tools.iter().enumerate().map(|(index, name)| {
            let of: Of = Box::new(move |observed| &observed.forces[index]);
            (Subject::Force(name.clone()), of)
        });
        let nodes: Of = Box::new(|observed| &observed.nodes);
        let energy: Of = Box::new(|observed| &observed.energy);
        probes
            .chain(forces)
            .chain([
                (Subject::Displacement, nodes),
                (Subject::ElasticEnergy, energy),
            ])
            .collect()
    }

    /// Probes outside the body, for which the nearest node is used on all meshes.
    pub(super) fn outside(&self) -> impl Iterator<Item = Caveat> {
        self.probes.iter().filter_map(|probe| {
            Some(Caveat::ProbeOutside {
                name: probe.name.clone(),
                distance: probe.outside?,
            })
        })
    }
}

/// The point that the scene specifies, if any.
fn asked(written: &ProbePoint, name: &str) -> Option<[f64; 3]> {
    match written.at {
        ProbeAt::Point(point) if written.name == name => Some(point),
        _ => None,
    }
}

fn body_of(simulation: &Simulation) -> Result<&BodyModel, ConvergeError> {
    let body = simulation.model().body();
    Ok(body.ok_or(sinew_scene::RefinementError::NoMesh)?)
}

/// The observed points in one of the meshes.
pub(super) struct Eye<'a> {
    simulation: &'a Simulation,
    body: &'a BodyModel,
    nodes: usize,
    /// Nodes of each probe and their shares.
    probes: Vec<Vec<(u32, f64)>>,
    /// Displacement of all nodes (m).
    all: Vec<[f64; 3]>,
    /// The instant (s) of the last observation, and the impulses (N s) of tools up to it.
    last: (f64, Vec<f64>),
    pub(super) seen: Observed,
}

impl<'a> Eye<'a> {
    pub(super) fn new(simulation: &'a Simulation, places: &Places) -> Result<Self, ConvergeError> {
        let body = body_of(simulation)?;
        let shares = |probe: &ProbePlace| match probe.at {
            At::Node(node) => vec![(node, 1.0)],
            // Refined tetrahedra fill the same body but for rounding.
            At::Point(point) => match surrounding(body, point) {
                Some(shares) => shares.to_vec(),
                None => vec![(body.mesh.nearest_node(point).0, 1.0)],
            },
            At::Mean(index) => {
                let nodes = simulation.probes().get(index).into_iter();
                let nodes = nodes.flat_map(|probe| &probe.nodes);
                nodes.map(|node| (node.index, node.share)).collect()
            }
        };
        Ok(Self {
            simulation,
            body,
            nodes: places.nodes,
            probes: places.probes.iter().map(shares).collect(),
            all: vec![[0.0; 3]; body.mesh.points.len()],
            last: (
                simulation.initial_state().t(),
                vec![0.0; 3 * places.tools.len()],
            ),
            seen: Observed {
                forces: vec![Vec::new(); places.tools.len()],
                probes: vec![Vec::new(); places.probes.len()],
                ..Observed::default()
            },
        })
    }

    /// Records the displacement `u` (m) of the degrees of freedom at a time (s), and the impulses (N s) of tools up to
    /// it, x, y, z of each.
    pub(super) fn look(
        &mut self,
        t: f64,
        u: &[f64],
        impulses: &[f64],
    ) -> Result<(), ConvergeError> {
        let found = self.body.model.displacements_at(t, u, &mut self.all);
        found.map_err(|error| ConvergeError::Field(error.to_string()))?;
        let seen = &mut self.seen;
        seen.nodes
            .extend(self.all[..self.nodes].iter().flatten().copied());
        for (values, shares) in seen.probes.iter_mut().zip(&self.probes) {
            let along = |axis: usize| {
                let terms = shares.iter();
                let terms = terms.map(|(node, share)| share * self.all[*node as usize][axis]);
                terms.sum::<f64>()
            };
            values.extend([along(0), along(1), along(2)]);
        }
        let (before, last) = &mut self.last;
        let values = seen.forces.iter_mut();
        let values = values.zip(
            impulses
                .as_chunks::<3>()
                .0
                .iter()
                .zip(last.as_chunks::<3>().0),
        );
        for (values, (now, last)) in values {
            values.extend((0..3).map(|axis| (now[axis] - last[axis]) / (t - *before)));
        }
        (*before, *last) = (t, impulses.to_vec());
        // Where supports move, elements between them and the body are in no matrix.
        let energy = match self.body.problem.moves.is_empty() {
            true => {
                let energy = self.simulation.system().energy(u, &vec![0.0; u.len()]);
                energy.map(|energy| energy.elastic)
            }
            false => None,
        };
        seen.energy.push(match energy {
            Some(energy) => energy,
            None => {
                let energy = self.body.model.elastic_energy(&self.all);
                energy.map_err(|error| ConvergeError::Field(error.to_string()))?
            }
        });
        Ok(())
    }
}

impl Observed {
    /// Displacements of the nodes at the last instant.
    pub(super) fn last(&self, nodes: usize) -> &[f64] {
        &self.nodes[self.nodes.len().saturating_sub(3 * nodes)..]
    }

    /// The displacement of the scene's nodes, instant after instant.
    pub(super) fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// True if any node was displaced.
    pub(super) fn moves(&self) -> bool {
        self.nodes.iter().any(|u| *u != 0.0)
    }
}

impl Places {
    /// Number of nodes of the scene's mesh.
    pub(super) fn nodes(&self) -> usize {
        self.nodes
    }
}

/// The tetrahedron around a point, as its nodes and their shares of the point; `None` for a point outside.
fn surrounding(body: &BodyModel, point: [f64; 3]) -> Option<[(u32, f64); 4]> {
    let (tet, shares) = body.mesh.tet_at(point)?;
    let nodes = body.mesh.tets[tet as usize];
    let holds = shares.iter().all(|share| *share >= -ON_FACE);
    holds.then(|| std::array::from_fn(|corner| (nodes[corner], shares[corner])))
}
