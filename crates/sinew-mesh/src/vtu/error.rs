//! Reasons why a mesh cannot be written as .vtu.

use std::io;

use crate::cell_type::CellType;

/// A mesh cannot be written as .vtu.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteVtuError {
    /// The destination cannot be written.
    #[error("the .vtu file cannot be written: {0}")]
    Io(#[from] io::Error),
    /// VTK has no such cells, or an unknown numbering of their nodes.
    #[error("the mesh has {kind} cells, which cannot be written as .vtu")]
    UnsupportedCells {
        /// Their type.
        kind: CellType,
    },
    /// The fields do not fit together.
    #[error("{what} has {found} entries, but {expected} are needed")]
    BadLength {
        /// The field.
        what: String,
        /// Its length.
        found: usize,
        /// The length it should have.
        expected: usize,
    },
    /// A cell names a node that does not exist.
    #[error("a {kind} has node index {node}, but there are {nodes} nodes")]
    NodeOutOfRange {
        /// Type of the cell.
        kind: CellType,
        /// The node's index.
        node: u32,
        /// Number of nodes.
        nodes: usize,
    },
}
