//! Probes: the nodes and the tetrahedra with recorded values.

use std::collections::HashMap;

use sinew_fem::{Course, Model};
use sinew_mesh::{CutMesh, GroupMembers, TetMesh};

use super::model::BodyModel;
use crate::error::{Fault, SceneError};
use crate::number::short;
use crate::scene::{Places, ProbeAt, ProbePoint, Quantity};

/// A node, a part of the body, or the mass of an oscillator, with a quantity that is recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// Its name.
    pub name: String,
    /// Quantity that is recorded.
    pub quantity: Quantity,
    /// Its node; `None` for an oscillator, for a mean over a group, and for stress.
    pub node: Option<NearestNode>,
    /// The nodes whose motion it is the mean of; none for stress.
    pub nodes: Vec<ProbeNode>,
    /// The tetrahedra (0-based) whose stress it is the mean of, with shares that add up to 1; none for motions.
    pub tets: Vec<(u32, f64)>,
    /// Description of its position.
    pub place: String,
    /// True if all of its nodes and tetrahedra were removed by cuts: it no longer has a value.
    pub is_gone: bool,
}

/// A node of a probe, or the mass of an oscillator.
#[derive(Debug, Clone, PartialEq)]
pub struct ProbeNode {
    /// Its weight in the mean: the weights of a probe add up to 1.
    pub share: f64,
    /// Index in the mesh, from 0.
    pub index: u32,
    /// Its degrees of freedom: along x, y and z for a node, one for an oscillator. `None` in a direction in which the
    /// node is fixed or moved.
    pub dofs: Vec<Option<usize>>,
    /// The courses of each direction in which the node is moved; none in others.
    pub courses: Vec<Vec<Course>>,
}

/// The node nearest to the point of a probe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestNode {
    /// Index in the mesh, from 0.
    pub index: u32,
    /// Tag in the mesh file.
    pub tag: u64,
    /// Its distance from the probe's point (m).
    pub distance: f64,
}

impl ProbeNode {
    fn of(model: &Model, index: u32, share: f64) -> Self {
        let cell = model.cell_of_node(index);
        let dof = |axis: usize| -> Option<usize> {
            let dof = 3 * cell? as usize + axis;
            (!model.pinned()[dof]).then_some(dof)
        };
        let courses = (0..3).map(|axis| model.courses(index, axis).to_vec());
        Self {
            share,
            index,
            dofs: (0..3).map(dof).collect(),
            courses: courses.collect(),
        }
    }

    /// The displacement (m) that is prescribed in a direction at time `t` (s); 0 if none is.
    pub(crate) fn prescribed(&self, axis: usize, t: f64) -> f64 {
        let courses = self.courses.get(axis).into_iter().flatten();
        // A scene has no inputs.
        let along = |course: &Course| course.displacement_at(t, axis).unwrap_or(f64::NAN);
        courses.fold(0.0, |sum, course| sum + along(course))
    }
}

impl Probe {
    /// This probe of the uncut body, on the remaining body: it keeps its own nodes, with a copy instead of a node that
    /// lost its tetrahedra, and its own tetrahedra. If all are gone it has no value.
    ///
    /// `node_of` gives the first node of the mesh that is one of the uncut mesh or a copy of it.
    pub(super) fn after_cut(
        &self,
        cut: &CutMesh,
        node_of: impl Fn(u32) -> Option<u32>,
        model: &Model,
    ) -> Self {
        let nodes: Vec<(u32, f64)> = self
            .nodes
            .iter()
            .filter_map(|node| Some((node_of(node.index)?, node.share)))
            .collect();
        let tet_of = |tet: u32| cut.tets.binary_search(&tet).ok();
        let tets: Vec<(u32, f64)> = self
            .tets
            .iter()
            .filter_map(|(tet, share)| Some((tet_of(*tet)? as u32, *share)))
            .collect();
        let is_whole = nodes.len() == self.nodes.len() && tets.len() == self.tets.len();
        let is_gone = nodes.is_empty() && tets.is_empty();
        let [nodes, tets] = [nodes, tets].map(|shares| match is_whole {
            true => shares,
            false => of_sum_one(shares),
        });
        let nodes = nodes
            .into_iter()
            .map(|(index, share)| ProbeNode::of(model, index, share));
        let held = ProbeNode {
            share: 1.0,
            index: 0,
            dofs: vec![None; self.axes()],
            courses: Vec::new(),
        };
        // A node that is not looked at keeps the number of columns.
        let stand_in = (is_gone && self.axes() > 0).then_some(held);
        Self {
            node: self.node,
            nodes: nodes.chain(stand_in).collect(),
            tets,
            is_gone,
            name: self.name.clone(),
            quantity: self.quantity,
            place: self.place.clone(),
        }
    }

    /// Number of its directions: three, or one for an oscillator; none for stress.
    pub(crate) fn axes(&self) -> usize {
        self.nodes.first().map_or(0, |node| node.dofs.len())
    }

    /// The displacement (m) in each of its directions at time `t` (s), with that of the degrees of freedom at this
    /// time: 0 in fixed directions, the prescribed one in moved ones.
    pub fn displacement<'a>(&'a self, t: f64, u: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let own = move |dof: usize| u.get(dof).copied().unwrap_or(f64::NAN);
        (0..self.axes()).map(move |axis| {
            let along = |node: &ProbeNode| match node.dofs.get(axis) {
                Some(Some(dof)) => own(*dof),
                _ => node.prescribed(axis, t),
            };
            self.mean(along)
        })
    }

    /// The mean of a value of its nodes. The mean over a single node is exactly its value.
    pub(crate) fn mean(&self, mut of: impl FnMut(&ProbeNode) -> f64) -> f64 {
        match &self.nodes[..] {
            _ if self.is_gone => f64::NAN,
            [node] => of(node),
            nodes => nodes.iter().map(|node| node.share * of(node)).sum(),
        }
    }
}

/// The probes of a body.
pub(super) fn of_body(
    points: &[ProbePoint],
    places: &Places,
    body: &BodyModel,
) -> Result<Vec<Probe>, SceneError> {
    let probe = |(index, point): (usize, &ProbePoint)| {
        let place = places.of(&places.probes, index);
        let made = match point.quantity {
            Quantity::Displacement | Quantity::Velocity => of_motion(point, body),
            Quantity::Stress => of_stress(point, body),
        };
        made.map_err(|fault| match fault {
            Fault::Misplaced { key, .. } => place.value_fault(key, fault),
            _ => place.value_fault(place.part_key(), fault),
        })
    };
    points.iter().enumerate().map(probe).collect()
}

fn of_motion(point: &ProbePoint, body: &BodyModel) -> Result<Probe, Fault> {
    let mesh = &body.mesh;
    let at_node = |(index, distance): (u32, f64)| {
        let tag = mesh.node_tags[index as usize];
        let node = NearestNode {
            index,
            tag,
            distance,
        };
        let place = format!("node {tag}, {} m from the point", short(distance));
        (Some(node), vec![(index, 1.0)], place)
    };
    let (node, shares, place) = match &point.at {
        ProbeAt::Point(point) => at_node(mesh.nearest_node(*point)),
        ProbeAt::Mean(group) => {
            let shares = shares_of_nodes(mesh, group)?;
            if let [(node, _)] = shares[..] {
                at_node((node, 0.0))
            } else {
                let place = format!("mean over the {} nodes of `{group}`", shares.len());
                (None, shares, place)
            }
        }
    };
    let nodes = shares
        .into_iter()
        .map(|(index, share)| ProbeNode::of(&body.model, index, share));
    Ok(Probe {
        name: point.name.clone(),
        quantity: point.quantity,
        node,
        nodes: nodes.collect(),
        tets: Vec::new(),
        place,
        is_gone: false,
    })
}

fn of_stress(point: &ProbePoint, body: &BodyModel) -> Result<Probe, Fault> {
    let mesh = &body.mesh;
    let (tets, place) = match &point.at {
        ProbeAt::Point(point) => {
            let (tet, _) = mesh.tet_at(*point).unwrap_or_default();
            let place = format!("tetrahedron {}", mesh.tet_tags[tet as usize]);
            (vec![(tet, 1.0)], place)
        }
        ProbeAt::Mean(name) => {
            let tets = shares_of_tets(mesh, name)?;
            let place = match mesh.group_nodes(mesh.group(name)?)[..] {
                [node] => {
                    let tag = mesh.node_tags[node as usize];
                    format!("mean over the {} tetrahedra at node {tag}", tets.len())
                }
                _ => format!("mean over {} tetrahedra of `{name}`", tets.len()),
            };
            (tets, place)
        }
    };
    let regions = &body.model.report().regions;
    let springs = tets
        .iter()
        .map(|(tet, _)| body.model.region_of()[*tet as usize])
        .find(|region| regions[*region as usize].network.is_some());
    if let Some(region) = springs {
        let reason = format!(
            "\"stress\" is not known in [[region]] {}, which is made of springs",
            region + 1
        );
        return Err(Fault::Misplaced {
            key: "quantity",
            reason,
        });
    }
    Ok(Probe {
        name: point.name.clone(),
        quantity: point.quantity,
        node: None,
        nodes: Vec::new(),
        tets,
        place,
        is_gone: false,
    })
}

/// The share of each node in the mean of a linear field over a group, in the order of the nodes.
fn shares_of_nodes(mesh: &TetMesh, group: &str) -> Result<Vec<(u32, f64)>, Fault> {
    let mut weights: Vec<Option<f64>> = vec![None; mesh.points.len()];
    let mut add = |nodes: &[u32], weight: f64| {
        for node in nodes {
            *weights[*node as usize].get_or_insert(0.0) += weight;
        }
    };
    let group = mesh.group(group)?;
    match &group.members {
        GroupMembers::Tets(tets) => tets
            .iter()
            .for_each(|tet| add(&mesh.tets[*tet as usize], mesh.volume(*tet as usize))),
        GroupMembers::Triangles(triangles) => triangles
            .iter()
            .for_each(|triangle| add(triangle, mesh.area(*triangle))),
        GroupMembers::Lines(_) | GroupMembers::Nodes(_) => add(&mesh.group_nodes(group), 1.0),
    }
    let weighted = (0..).zip(weights);
    let weighted = weighted.filter_map(|(node, weight)| Some((node, weight?)));
    Ok(of_sum_one(weighted.collect()))
}

/// The share of each tetrahedron in the mean over a group; for a group of triangles over the tetrahedra at them, by
/// area.
fn shares_of_tets(mesh: &TetMesh, group: &str) -> Result<Vec<(u32, f64)>, Fault> {
    let group = mesh.group(group)?;
    Ok(match &group.members {
        GroupMembers::Tets(tets) => {
            let weighted = tets.iter().map(|tet| (*tet, mesh.volume(*tet as usize)));
            of_sum_one(weighted.collect())
        }
        GroupMembers::Triangles(triangles) => {
            let sorted = |mut nodes: [u32; 3]| {
                nodes.sort_unstable();
                nodes
            };
            let areas: HashMap<[u32; 3], f64> = triangles
                .iter()
                .map(|triangle| (sorted(*triangle), mesh.area(*triangle)))
                .collect();
            let area = |[a, b, c, d]: [u32; 4]| -> f64 {
                let faces = [[a, b, c], [a, b, d], [a, c, d], [b, c, d]];
                faces
                    .iter()
                    .filter_map(|face| areas.get(&sorted(*face)))
                    .sum()
            };
            let weighted = (0..)
                .zip(&mesh.tets)
                .map(|(tet, nodes)| (tet, area(*nodes)));
            of_sum_one(weighted.filter(|(_, area)| *area > 0.0).collect())
        }
        GroupMembers::Lines(_) | GroupMembers::Nodes(_) => {
            let nodes = mesh.group_nodes(group);
            by_volume(mesh, |tet| {
                let of = mesh.tets[tet as usize].iter();
                of.clone().any(|node| nodes.binary_search(node).is_ok())
            })
        }
    })
}

fn by_volume(mesh: &TetMesh, is_in: impl Fn(u32) -> bool) -> Vec<(u32, f64)> {
    let tets = (0..mesh.tets.len() as u32).filter(|tet| is_in(*tet));
    of_sum_one(tets.map(|tet| (tet, mesh.volume(tet as usize))).collect())
}

/// Weights divided by their sum; equal weights if the sum overflows.
fn of_sum_one(mut weighted: Vec<(u32, f64)>) -> Vec<(u32, f64)> {
    let sum: f64 = weighted.iter().map(|(_, weight)| weight).sum();
    let alike = (weighted.len() as f64).recip();
    for (_, weight) in &mut weighted {
        *weight = if sum.is_normal() {
            *weight / sum
        } else {
            alike
        };
    }
    weighted
}

pub(super) fn of_oscillator() -> Probe {
    Probe {
        name: "mass".into(),
        quantity: Quantity::Displacement,
        node: None,
        nodes: vec![ProbeNode {
            share: 1.0,
            index: 0,
            dofs: vec![Some(0)],
            courses: Vec::new(),
        }],
        tets: Vec::new(),
        place: "the mass".into(),
        is_gone: false,
    }
}
