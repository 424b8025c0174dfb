//! The part of a mesh that a support fixes or a load acts on.

use std::fmt;

/// The part of a mesh that a support fixes or a load acts on. A name turns into [`On::Group`].
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum On {
    /// A group of the mesh, by name.
    Group(String),
    /// Nodes (0-based) in any order; one that is named twice counts once.
    Nodes(Vec<u32>),
    /// Triangles of nodes (0-based), in either orientation; one that is named twice counts once.
    Triangles(Vec<[u32; 3]>),
}

impl From<&str> for On {
    fn from(group: &str) -> Self {
        Self::Group(group.into())
    }
}

impl From<String> for On {
    fn from(group: String) -> Self {
        Self::Group(group)
    }
}

impl fmt::Display for On {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Group(name) => write!(f, "`{name}`"),
            Self::Nodes(nodes) => write!(f, "{} nodes", nodes.len()),
            Self::Triangles(triangles) => write!(f, "{} triangles", triangles.len()),
        }
    }
}
