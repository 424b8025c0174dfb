//! The memory that a scene needs, before it is built.

use serde::{Deserialize, Serialize};
use sinew_fem::{Law, On, Region};
use sinew_mesh::TetMesh;

use crate::scene::Body;

/// Counts of a body and the memory it needs, from its mesh and its supports.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Footprint {
    /// Nodes.
    pub nodes: usize,
    /// Tetrahedra.
    pub tets: usize,
    /// Blocks of the stiffness matrix: one for each node that moves, and two for each pair of such nodes that are
    /// coupled, by an edge or because strain is averaged over their neighbourhood.
    pub blocks: usize,
    /// Memory (bytes) of the matrices.
    pub matrix_bytes: usize,
    /// Memory (bytes) of mesh, matrices, their copies in a machine, and motion, without factors.
    pub bytes: usize,
}

impl Footprint {
    pub(super) fn of(body: &Body, mesh: &TetMesh) -> Self {
        const BLOCK: usize = 9 * size_of::<f64>();
        let (nodes, tets) = (mesh.points.len(), mesh.tets.len());
        let held = held(body, mesh);
        let moves = |node: u32| !held[node as usize];
        let cells = held.iter().filter(|held| !**held).count();
        let blocks = sinew_fem::smoothed_blocks(mesh, &body.problem).unwrap_or_else(|| {
            let edges = mesh.edges().into_iter();
            cells + 2 * edges.filter(|[a, b]| moves(*a) && moves(*b)).count()
        });
        let dashpots = body.problem.regions.iter().any(|region| {
            matches!(region.law, Law::Springs { damping_ratio, .. } if damping_ratio > 0.0)
        });
        let matrices = 1 + usize::from(dashpots);
        let pattern = blocks * size_of::<u32>() + (cells + 1) * size_of::<usize>();
        let vector = 3 * cells * size_of::<f64>();
        let matrix_bytes = matrices * blocks * BLOCK + pattern + vector;
        let takes_data = body.problem.regions.iter().any(Region::takes_data);
        let data = mesh.data.iter().filter(|_| takes_data);
        let data: usize = data.map(|data| data.values.len()).sum();
        // Corners, tags and region of each tetrahedron; position and tag of each node; data, and the values derived
        // from them for the body and for loops.
        let of_mesh = tets * 28 + nodes * 32 + 3 * data * size_of::<f64>();
        Self {
            nodes,
            tets,
            blocks,
            matrix_bytes,
            bytes: of_mesh + 2 * matrix_bytes + VECTORS * vector,
        }
    }
}

/// For each node, true if it is fixed or moved in all directions. Groups that the mesh does not have are skipped:
/// they are reported elsewhere.
fn held(body: &Body, mesh: &TetMesh) -> Vec<bool> {
    let mut held = vec![[false; 3]; mesh.points.len()];
    let fixed = body.problem.fixed.iter();
    let fixed = fixed.filter_map(|fixed| match &fixed.on {
        On::Group(name) => Some((name, fixed.axes)),
        On::Nodes(_) | On::Triangles(_) => None,
    });
    let moved = body
        .motions
        .iter()
        .map(|motion| (&motion.group, motion.axes));
    for (name, axes) in fixed.chain(moved) {
        let nodes = mesh.group(name).map(|group| mesh.group_nodes(group));
        for node in nodes.unwrap_or_default() {
            let held = &mut held[node as usize];
            for (held, axis) in held.iter_mut().zip(axes) {
                *held |= axis;
            }
        }
    }
    held.into_iter().map(|held| held == [true; 3]).collect()
}

/// Number of vectors that a run keeps: state, its start, registers, forces.
const VECTORS: usize = 10;
