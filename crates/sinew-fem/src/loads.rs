//! Loads on nodes.

use nalgebra::Vector3;
use sinew_core::{Load, Ramp};
use sinew_mesh::{Group, GroupMembers, TetMesh};

use crate::cells::Cells;
use crate::error::{Cause, FemError, Item};
use crate::{LoadKind, LoadSpec, check};

/// What a load asks for and what of it acts, at full value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadFacts {
    /// Resultant of the load (N).
    pub asked: [f64; 3],
    /// Resultant of what falls on components that move (N); the rest goes into the supports.
    pub acting: [f64; 3],
}

/// The load on cells and its resultants.
pub(crate) fn assemble(
    mesh: &TetMesh,
    cells: &Cells,
    load: &LoadSpec,
    item: Item,
) -> Result<(Load, LoadFacts), FemError> {
    let group = match load.kind {
        LoadKind::Force(_) => check::group(mesh, &load.group, item)?,
        // A volume and its surface may have one name.
        LoadKind::Traction(_) | LoadKind::Pressure(_) => mesh
            .group_of_dim(&load.group, 2)
            .or_else(|_| check::group(mesh, &load.group, item))?,
    };
    let mut nodal: Vec<(u32, Vector3<f64>)> = Vec::new();
    match load.kind {
        LoadKind::Traction(traction) => {
            for triangle in triangles(group, item)? {
                let share = area_vector(mesh, triangle).norm() / 3.0 * Vector3::from(traction);
                nodal.extend(triangle.map(|node| (node, share)));
            }
        }
        LoadKind::Pressure(pressure) => {
            let outward = mesh
                .outward_triangles(triangles(group, item)?)
                .map_err(|error| FemError::new(item, error.into()))?;
            for triangle in &outward {
                let share = area_vector(mesh, triangle) * (-pressure / 3.0);
                nodal.extend(triangle.map(|node| (node, share)));
            }
        }
        LoadKind::Force(force) => {
            let nodes = mesh.group_nodes(group);
            let free = nodes
                .into_iter()
                .filter(|node| cells.of_node(*node).is_some());
            let free: Vec<u32> = free.collect();
            let share = Vector3::from(force) / free.len() as f64;
            nodal.extend(free.into_iter().map(|node| (node, share)));
        }
    }
    let (load, facts) = gather(cells, &nodal, load.ramp.clone());
    if load.entries.is_empty() {
        let group = group.name.clone();
        return Err(FemError::new(item, Cause::NothingLoaded { group }));
    }
    Ok((load, facts))
}

/// The weight of every node.
pub(crate) fn gravity(cells: &Cells, masses: &[f64], gravity: [f64; 3]) -> (Load, LoadFacts) {
    let weights = masses.iter().map(|mass| Vector3::from(gravity) * *mass);
    let nodal: Vec<(u32, Vector3<f64>)> = (0..).zip(weights).collect();
    gather(cells, &nodal, Ramp::Step)
}

fn gather(cells: &Cells, nodal: &[(u32, Vector3<f64>)], ramp: Ramp) -> (Load, LoadFacts) {
    let mut force = vec![0.0; cells.pinned.len()];
    let mut loaded = vec![false; cells.pinned.len()];
    let nothing_asked = nodal.iter().all(|(_, share)| *share == Vector3::zeros());
    let mut asked = Vector3::zeros();
    for (node, share) in nodal {
        asked += share;
        if let Some(cell) = cells.of_node(*node) {
            for axis in 0..3 {
                let dof = 3 * cell as usize + axis;
                if !cells.pinned[dof] {
                    force[dof] += share[axis];
                    loaded[dof] |= nothing_asked || share[axis] != 0.0;
                }
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
    (Load { ramp, entries }, facts)
}

fn triangles(group: &Group, item: Item) -> Result<&[[u32; 3]], FemError> {
    match &group.members {
        GroupMembers::Triangles(triangles) => Ok(triangles),
        _ => Err(check::dimension(
            item,
            group,
            "a group of triangles (dimension 2)",
        )),
    }
}

/// Area times normal (m^2).
fn area_vector(mesh: &TetMesh, triangle: &[u32; 3]) -> Vector3<f64> {
    let [a, b, c] = triangle.map(|node| Vector3::from(mesh.points[node as usize]));
    (b - a).cross(&(c - a)) / 2.0
}
