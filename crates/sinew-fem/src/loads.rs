//! Loads on nodes.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use sinew_core::{Load, Ramp};
use sinew_mesh::TetMesh;

use crate::body::Body;
use crate::cells::Cells;
use crate::error::{Cause, FemError, Item};
use crate::following::FollowingPressure;
use crate::motion::Motions;
use crate::report::LoadFacts;
use crate::supports::HeldLoad;
use crate::{LoadKind, LoadSpec, MoveFacts, Problem};

/// The loads of a problem on a body.
pub(crate) struct LoadsOnBody {
    /// Loads on free components: in the order of the problem, gravity last.
    pub(crate) moving: Vec<Load>,
    /// Source of each of them.
    pub(crate) items: Vec<Item>,
    /// Parts of the loads on fixed components; loads without one are left out.
    pub(crate) held: Vec<HeldLoad>,
    /// Additional contributions of pressures that follow the surface.
    pub(crate) following: Vec<FollowingPressure>,
    /// Resultants of the loads.
    pub(crate) facts: Vec<LoadFacts>,
    /// Resultant of gravity.
    pub(crate) gravity: Option<LoadFacts>,
}

impl LoadsOnBody {
    /// Shares out the loads and, with the lumped `masses` of the nodes (kg), gravity. Notes in the facts of the
    /// prescribed motions the loads that fall on them. Refuses a load on supports alone, if the body is not cut.
    pub(crate) fn new(
        mesh: &TetMesh,
        body: &Body,
        (problem, region_of, is_cut): (&Problem, &[u32], bool),
        masses: &[f64],
        motions: &Motions,
        moves: &mut [MoveFacts],
    ) -> Result<Self, FemError> {
        let (mut moving, mut held, mut facts) = (Vec::new(), Vec::new(), Vec::new());
        let (mut items, mut following) = (Vec::new(), Vec::new());
        let is_large = |tet: usize| {
            problem.regions[region_of[tet] as usize]
                .law
                .is_hyperelastic()
        };
        for (index, spec) in problem.loads.iter().enumerate() {
            let item = Item::Load(index);
            let parts = assemble((mesh, &is_large), body, motions, spec, index)?;
            following.extend(parts.following);
            let mut on_moved = false;
            for part in parts.held.iter().flat_map(|held| held.moved_by(motions)) {
                on_moved = true;
                if let Some(facts) = moves.get_mut(part)
                    && facts.loads.last() != Some(&index)
                {
                    facts.loads.push(index);
                }
            }
            if parts.moving.entries.is_empty() && !on_moved && !is_cut {
                let on = spec.on.clone();
                return Err(FemError::new(item, Cause::NothingLoaded { on }));
            }
            moving.push(parts.moving);
            items.push(item);
            held.extend(parts.held);
            facts.push(parts.facts);
        }
        let gravity = problem.gravity.map(|acceleration| {
            let parts = gravity(&body.cells, masses, acceleration);
            moving.push(parts.moving);
            items.push(Item::Gravity);
            held.extend(parts.held);
            parts.facts
        });
        Ok(Self {
            moving,
            items,
            held,
            following,
            facts,
            gravity,
        })
    }
}

/// The parts of a load on moving and on fixed components.
struct Parts {
    moving: Load,
    held: Option<HeldLoad>,
    following: Option<FollowingPressure>,
    facts: LoadFacts,
}

/// A load shared out to nodes.
fn assemble(
    (mesh, is_large): (&TetMesh, &dyn Fn(usize) -> bool),
    body: &Body,
    motions: &Motions,
    load: &LoadSpec,
    index: usize,
) -> Result<Parts, FemError> {
    let (cells, on, item) = (&body.cells, &load.on, Item::Load(index));
    let mut following = None;
    let mut nodal: Vec<(u32, Vector3<f64>)> = Vec::new();
    match load.kind {
        LoadKind::Traction(traction) => {
            for triangle in on.triangles(mesh).map_err(FemError::at(item))?.iter() {
                let share = share_of_corner(mesh, triangle, Spread::Traction(traction));
                nodal.extend(triangle.map(|node| (node, share)));
            }
        }
        LoadKind::Pressure(pressure) | LoadKind::FollowingPressure(pressure) => {
            let outward = mesh
                .outward_faces(&on.triangles(mesh).map_err(FemError::at(item))?)
                .map_err(FemError::at(item))?;
            for (triangle, _) in &outward {
                let share = share_of_corner(mesh, triangle, Spread::Pressure(pressure));
                nodal.extend(triangle.map(|node| (node, share)));
            }
            if matches!(load.kind, LoadKind::FollowingPressure(_)) {
                let large = outward.into_iter().filter(|(_, tet)| is_large(*tet));
                let large = large.map(|(triangle, _)| triangle);
                following = FollowingPressure::new(mesh, (index, &load.ramp, pressure), large);
            }
        }
        LoadKind::Force(force) => {
            let nodes = on.nodes(mesh).map_err(FemError::at(item))?;
            let is_moved = |node: u32| {
                (0..3).any(|axis| motions.part_of(node, axis).is_some()) || motions.is_frozen(node)
            };
            let free = nodes
                .into_iter()
                .filter(|node| cells.of_node(*node).is_some() || is_moved(*node));
            let free: Vec<u32> = free.collect();
            let share = Vector3::from(force) / free.len() as f64;
            nodal.extend(free.into_iter().map(|node| (node, share)));
        }
    }
    Ok(Parts {
        following,
        ..gather(cells, &nodal, load.ramp.clone(), item)
    })
}

/// The weight of every node.
fn gravity(cells: &Cells, masses: &[f64], gravity: [f64; 3]) -> Parts {
    let weights = masses.iter().map(|mass| Vector3::from(gravity) * *mass);
    let nodal: Vec<(u32, Vector3<f64>)> = (0..).zip(weights).collect();
    gather(cells, &nodal, Ramp::Step, Item::Gravity)
}

fn gather(cells: &Cells, nodal: &[(u32, Vector3<f64>)], ramp: Ramp, item: Item) -> Parts {
    let mut force = vec![0.0; cells.pinned.len()];
    let mut loaded = vec![false; cells.pinned.len()];
    let nothing_asked = nodal.iter().all(|(_, share)| *share == Vector3::zeros());
    let mut asked = Vector3::zeros();
    let mut held: BTreeMap<u32, [f64; 3]> = BTreeMap::new();
    for (node, share) in nodal {
        asked += share;
        for axis in 0..3 {
            if let Some(dof) = cells.free_dof(*node, axis) {
                let dof = dof as usize;
                force[dof] += share[axis];
                loaded[dof] |= nothing_asked || share[axis] != 0.0;
            } else if share[axis] != 0.0 {
                held.entry(*node).or_default()[axis] += share[axis];
            }
        }
    }
    let mut acting = Vector3::zeros();
    let mut entries = Vec::new();
    for (dof, value) in force
        .into_iter()
        .enumerate()
        .filter(|(dof, _)| loaded[*dof])
    {
        acting[dof % 3] += value;
        if value != 0.0 {
            entries.push((dof as u32, value));
        }
    }
    // A load of zero on a free group is no mistake: keep one entry to say so.
    if entries.is_empty()
        && let Some(dof) = loaded.iter().position(|loaded| *loaded)
    {
        entries.push((dof as u32, 0.0));
    }
    let facts = LoadFacts {
        asked: asked.into(),
        acting: acting.into(),
    };
    let held = (!held.is_empty()).then(|| HeldLoad {
        item,
        ramp: ramp.clone(),
        forces: held.into_iter().collect(),
    });
    Parts {
        moving: Load { ramp, entries },
        held,
        following: None,
        facts,
    }
}

/// Surface load that is spread over triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Spread {
    /// Force over area (Pa).
    Traction([f64; 3]),
    /// Force over area (Pa), against the normal of triangles that are seen counter-clockwise from outside.
    Pressure(f64),
}

/// The force (N) on each corner of a triangle.
pub(crate) fn share_of_corner(mesh: &TetMesh, triangle: &[u32; 3], spread: Spread) -> Vector3<f64> {
    let area = area_vector(mesh, triangle);
    match spread {
        Spread::Traction(traction) => area.norm() / 3.0 * Vector3::from(traction),
        Spread::Pressure(pressure) => area * (-pressure / 3.0),
    }
}

/// Area times normal (m^2).
fn area_vector(mesh: &TetMesh, triangle: &[u32; 3]) -> Vector3<f64> {
    let [a, b, c] = triangle.map(|node| Vector3::from(mesh.points[node as usize]));
    (b - a).cross(&(c - a)) / 2.0
}
