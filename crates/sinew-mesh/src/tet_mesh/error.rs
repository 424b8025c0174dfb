//! Reasons why a mesh cannot be simulated.

use crate::cell_type::CellType;

/// A mesh cannot be simulated.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TetMeshError {
    /// There are no tetrahedra.
    #[error("the mesh has no tetrahedra (it has {found}); a simulation needs 4-node tetrahedra")]
    NoTetrahedra {
        /// The cells that there are, as text.
        found: String,
    },
    /// There are cells of a type that cannot be simulated yet.
    #[error(
        "the mesh has {count} {kind} cells (the first has tag {element_tag}); only 4-node tetrahedra, with 3-node \
         triangles, 2-node lines and vertices as groups, can be simulated so far"
    )]
    UnsupportedCells {
        /// Their type.
        kind: CellType,
        /// Their number.
        count: usize,
        /// The tag of the first.
        element_tag: u64,
    },
    /// A cell names a node that does not exist.
    #[error("{kind} with tag {element_tag} has node index {node}, but there are {nodes} nodes{}", up_to(*nodes))]
    NodeOutOfRange {
        /// Type of the cell.
        kind: CellType,
        /// Tag of the cell.
        element_tag: u64,
        /// The node's index.
        node: u32,
        /// Number of nodes.
        nodes: usize,
    },
    /// More cells than a 32-bit index can count.
    #[error("the mesh has {count} tetrahedra; at most {} are supported", u32::MAX)]
    TooManyTetrahedra {
        /// Their number.
        count: usize,
    },
}

fn up_to(nodes: usize) -> String {
    nodes
        .checked_sub(1)
        .map_or_else(String::new, |last| format!(" (0..={last})"))
}
