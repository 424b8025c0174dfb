//! Faults of tools.

use sinew_fem::FieldError;
use sinew_tools::{ShapeError, TableError, ToolsError};

use crate::number::short;

/// A fault of a tool.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ToolFault {
    /// A node inside the tool at t = 0.
    #[error("the tool begins inside the body: node {node} is {} m deep in it", short(*depth))]
    Inside {
        /// Tag of the deepest node.
        node: u64,
        /// Its depth (m).
        depth: f64,
    },
    /// A tool inside the body without a node in it that could be pushed out.
    #[error(
        "the tool begins inside the body, in tetrahedron {tet}, and holds no node that it could push out"
    )]
    Within {
        /// Tag of the tetrahedron that contains the middle of the tool.
        tet: u64,
    },
    /// A tool for which all nodes are fixed or moved.
    #[error("the tool can touch no node: all {nodes} are fixed or have a prescribed motion")]
    NothingToTouch {
        /// Number of the nodes.
        nodes: usize,
    },
    /// A tool that is thinner than the precision of positions.
    #[error(
        "a radius or half a thickness of {} m, less than 1e-9 of the body, {} m: expected more; are its lengths in m?",
        short(*half_width),
        short(*body)
    )]
    Tiny {
        /// The radius or half the thickness (m).
        half_width: f64,
        /// The size of the body (m).
        body: f64,
    },
    /// A position of a table that is so far away that its precision is not sufficient.
    #[error("at t = {} s the tool is at {position:?} m: expected coordinates of at most 1e6 m", short(*t))]
    Far {
        /// The time (s).
        t: f64,
        /// The position (m).
        position: [f64; 3],
    },
    /// A shape that is not valid.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// A table of poses that is not valid.
    #[error(transparent)]
    Table(#[from] TableError),
    /// Tools that do not fit together.
    #[error(transparent)]
    Tools(#[from] ToolsError),
    /// A state in which the positions of nodes are unknown.
    #[error(transparent)]
    Places(#[from] FieldError),
}
