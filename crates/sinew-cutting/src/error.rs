//! Reasons for which a body cannot be cut.

/// Reasons for which a body cannot be cut.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CutError {
    /// A face of more than two tetrahedra.
    #[error("the face of nodes {nodes:?} (0-based) has more than two tetrahedra: it cannot be cut")]
    SharedFace {
        /// The nodes of the face, increasing.
        nodes: [u32; 3],
    },
    /// A tetrahedron that names a node twice.
    #[error("tetrahedron {tet} (0-based) names a node twice: it cannot be cut")]
    Collapsed {
        /// The tetrahedron.
        tet: usize,
    },
    /// A face that belongs to no tetrahedron.
    #[error(
        "face {vertex} of tetrahedron {tet} (0-based): there are {tets} tetrahedra, with faces 0 to 3"
    )]
    NoFace {
        /// The tetrahedron.
        tet: u32,
        /// The vertex opposite.
        vertex: usize,
        /// Number of tetrahedra.
        tets: usize,
    },
    /// More or fewer positions than nodes.
    #[error("{found} positions for {expected} nodes")]
    Positions {
        /// Number of positions.
        found: usize,
        /// Number of nodes.
        expected: usize,
    },
}
