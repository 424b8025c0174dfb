//! Reasons why a mesh cannot be written.

use std::io;

/// A mesh cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteMshError {
    /// The destination cannot be written.
    #[error("the mesh cannot be written: {0}")]
    Io(#[from] io::Error),
    /// A coordinate is infinite or NaN.
    #[error(
        "the node with tag {node_tag} has coordinates {point:?}; only finite numbers can be written"
    )]
    NotFinite {
        /// Tag of the node.
        node_tag: u64,
        /// Its coordinates.
        point: [f64; 3],
    },
    /// A name with a line break.
    #[error("the name of group {tag} of dimension {dim} has a line break")]
    BadName {
        /// Dimension of the group.
        dim: u8,
        /// Tag of the group.
        tag: i32,
    },
    /// The name of a data field, with a line break or a double quote.
    #[error("the name of data field {name:?} has a line break or a double quote")]
    BadFieldName {
        /// The name.
        name: String,
    },
    /// A node tag is 0 or occurs twice.
    #[error("node tag {tag} {}", if *tag == 0 { "is not the tag of a node" } else { "occurs twice" })]
    BadNodeTag {
        /// The tag.
        tag: u64,
    },
    /// A tag is too large for the 31 bits that the format has for it.
    #[error("tag {tag} does not fit into the 31 bits that the format has for it there")]
    TagTooLarge {
        /// The tag.
        tag: u64,
    },
    /// The fields of the mesh do not fit together.
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
    #[error("cell {cell} of block {block} has node index {node}, but there are {nodes} nodes")]
    NodeOutOfRange {
        /// Index of the block.
        block: usize,
        /// Index of the cell in the block.
        cell: usize,
        /// The node's index.
        node: u32,
        /// Number of nodes.
        nodes: usize,
    },
}

/// Checks that a field is either left out or complete.
pub(super) fn full_or_empty(
    what: &str,
    found: usize,
    expected: usize,
) -> Result<(), WriteMshError> {
    if found == 0 || found == expected {
        return Ok(());
    }
    Err(WriteMshError::BadLength {
        what: what.to_owned(),
        found,
        expected,
    })
}
