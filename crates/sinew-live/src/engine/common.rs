//! Common cells of two bodies of a scene with different cuts.

use std::sync::Arc;

use sinew_mesh::TetMesh;
use sinew_scene::BodyModel;

use crate::picture::twins;
use crate::protocol::NONE;

/// Cells of two bodies that are the same corner of the same tetrahedron.
pub(super) struct Common {
    meshes: [Arc<TetMesh>; 2],
    pairs: Vec<Pair>,
}

/// A cell of each body.
struct Pair {
    cells: [u32; 2],
    /// The vector (m) at rest from the second to the first: nodes near a cut are moved onto it.
    apart: [f64; 3],
}

impl Common {
    pub(super) fn of(own: &BodyModel, other: &BodyModel) -> Self {
        let pair = |[a, b]: [u32; 2]| {
            let cells = [own.model.cell_of_node(a)?, other.model.cell_of_node(b)?];
            let (a, b) = (own.mesh.points[a as usize], other.mesh.points[b as usize]);
            let apart = std::array::from_fn(|axis| a[axis] - b[axis]);
            Some(Pair { cells, apart })
        };
        let known = |twins: Vec<u32>| (0..).zip(twins).filter(|(_, twin)| *twin != NONE);
        // Of a node that is whole in one body alone all copies in the other.
        let forth = known(twins(own, other)).map(|(node, twin)| [node, twin]);
        let back = known(twins(other, own)).map(|(node, twin)| [twin, node]);
        let mut nodes: Vec<[u32; 2]> = forth.chain(back).collect();
        nodes.sort_unstable();
        nodes.dedup();
        Self {
            meshes: [Arc::clone(&own.mesh), Arc::clone(&other.mesh)],
            pairs: nodes.into_iter().filter_map(pair).collect(),
        }
    }

    /// True if these are the common cells of these two bodies.
    pub(super) fn is_of(&self, own: &BodyModel, other: &BodyModel) -> bool {
        let [a, b] = &self.meshes;
        Arc::ptr_eq(a, &own.mesh) && Arc::ptr_eq(b, &other.mesh)
    }

    /// The largest component of a displacement (m) of the first body, and the largest distance (m) along an axis
    /// between positions of both; `None` if the bodies have no common cells left.
    pub(super) fn largest(&self, own: impl Fn(usize) -> f64, other: &[f64]) -> Option<[f64; 2]> {
        let mut largest = [0.0_f64; 2];
        for Pair { cells, apart } in &self.pairs {
            let [a, b] = cells.map(|cell| 3 * cell as usize);
            for axis in 0..3 {
                let u = own(a + axis);
                let distance = (u - other[b + axis] + apart[axis]).abs();
                largest[0] = largest[0].max(u.abs());
                // What is not a number is farther away than anything.
                largest[1] = match distance.is_nan() {
                    true => f64::INFINITY,
                    false => largest[1].max(distance),
                };
            }
        }
        (!self.pairs.is_empty()).then_some(largest)
    }
}
