//! Probes: which degrees of freedom are written down.

use super::BodyModel;
use crate::scene::ProbePoint;

/// A node, or the mass of an oscillator, whose motion is written down.
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// Its name.
    pub name: String,
    /// The node it stands for, where a body moves.
    pub node: Option<NearestNode>,
    /// Its degrees of freedom: along x, y and z for a node, one for an oscillator. `None` where
    /// the node is held.
    pub dofs: Vec<Option<usize>>,
}

/// The node nearest to a probe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestNode {
    /// Index in the mesh, from 0.
    pub index: u32,
    /// Tag in the mesh file.
    pub tag: u64,
    /// Its distance from the probe's point (m).
    pub distance: f64,
}

impl Probe {
    /// The displacement (m) of each of its degrees of freedom; 0 where it is held.
    pub fn displacement<'a>(&'a self, u: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let value = |dof: usize| u.get(dof).copied().unwrap_or(f64::NAN);
        self.dofs.iter().map(move |dof| dof.map_or(0.0, value))
    }
}

pub(super) fn of_body(points: &[ProbePoint], body: &BodyModel) -> Vec<Probe> {
    let probe = |ProbePoint { name, point }: &ProbePoint| {
        let (index, distance) = body.mesh.nearest_node(*point);
        let cell = body.model.cell_of_node(index);
        let dof = |axis: usize| -> Option<usize> {
            let dof = 3 * cell? as usize + axis;
            (!body.model.pinned()[dof]).then_some(dof)
        };
        Probe {
            name: name.clone(),
            node: Some(NearestNode {
                index,
                tag: body.mesh.node_tags[index as usize],
                distance,
            }),
            dofs: (0..3).map(dof).collect(),
        }
    };
    points.iter().map(probe).collect()
}

pub(super) fn of_oscillator() -> Probe {
    Probe {
        name: "mass".into(),
        node: None,
        dofs: vec![Some(0)],
    }
}
