//! The elements that are compared.

use std::fmt;

use sinew_fem::Element;

/// An element without the size of its patches, which depends on the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kind {
    /// [`Element::P1`].
    P1,
    /// [`Element::Fbar`].
    Fbar,
    /// [`Element::FbarEdge`] with this share of edges.
    Edge(f64),
}

impl Kind {
    /// All kinds in the tables.
    pub(crate) const ALL: [Self; 4] = [Self::P1, Self::Fbar, Self::Edge(1.0), Self::Edge(0.9)];

    /// The element; `patch` is the number of tetrahedra per patch, for elements that have patches.
    pub(crate) fn element(self, patch: Option<u32>) -> Element {
        match self {
            Self::P1 => Element::P1,
            Self::Fbar => Element::Fbar { patch },
            Self::Edge(edge_share) => Element::FbarEdge { edge_share, patch },
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::P1 => write!(f, "p1"),
            Self::Fbar => write!(f, "fbar"),
            Self::Edge(share) => write!(f, "fbar-edge, edge_share {share}"),
        }
    }
}
