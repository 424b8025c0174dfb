//! Errors of calls with vectors at nodes.

/// A reason for which vectors at nodes are refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ForceError {
    /// A node that does not exist.
    #[error("node index {node} is out of range: the mesh has {nodes} nodes, counted from 0")]
    NodeOutOfRange {
        /// The index (0-based).
        node: u32,
        /// Nodes of the mesh.
        nodes: usize,
    },
    /// A component that is not a finite number.
    #[error("the vector at node index {node} has a component of {found}: expected finite numbers")]
    NotFinite {
        /// The node (0-based).
        node: u32,
        /// The component.
        found: f64,
    },
}

/// A reason for which a motion of supports is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SupportMotionError {
    /// A node that does not exist, or a component that is not finite.
    #[error(transparent)]
    Vector(#[from] ForceError),
    /// A displacement given to a free component.
    #[error("node index {node} is not fixed in {}", ["x", "y", "z"][*axis % 3])]
    NotHeld {
        /// The node (0-based).
        node: u32,
        /// The component: 0, 1, 2 for x, y, z.
        axis: usize,
    },
}
