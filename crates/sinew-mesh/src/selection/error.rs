//! Selections that hit nothing.

/// A selection without members.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SelectionError {
    /// Nothing meets the conditions.
    #[error(
        "no {wanted} is {selection}; the body reaches from ({}, {}, {}) to ({}, {}, {}) m",
        low[0], low[1], low[2], high[0], high[1], high[2]
    )]
    Nothing {
        /// The kind of member: node, boundary triangle or tetrahedron.
        wanted: &'static str,
        /// The selection in words.
        selection: String,
        /// Least coordinates of the body (m).
        low: [f64; 3],
        /// Greatest coordinates of the body (m).
        high: [f64; 3],
    },
    /// Nodes meet the conditions, but no cell has only such nodes.
    #[error("no {wanted} has only nodes {selection}; of these there are {nodes}")]
    NoCell {
        /// The kind of cell: boundary triangle or tetrahedron.
        wanted: &'static str,
        /// The selection in words.
        selection: String,
        /// Number of nodes that are selected.
        nodes: usize,
    },
    /// A node tag that the mesh does not have, or that no tetrahedron uses.
    #[error("no tetrahedron has a node with tag {tag}")]
    UnknownTag {
        /// The tag.
        tag: u64,
    },
}
