//! Tools and the cells that they may touch.

use sinew_core::Inputs;

use super::tool_body::{ToolBody, ToolBodyError};
use crate::motion::Motion;
use crate::shape::Shape;
use crate::vector::add;

/// A rigid tool.
#[derive(Clone, Debug)]
pub struct Tool {
    /// Its name, unique among the tools of a body.
    pub name: String,
    /// Its shape.
    pub shape: Shape,
    /// Prescribed motion, or the path to which the coupling pulls the tool.
    pub motion: Motion,
    /// Mass and coupling of a tool that is a dynamic body; `None` for a tool that follows its motion exactly.
    pub body: Option<ToolBody>,
    /// Coefficient of Coulomb's friction.
    pub friction: f64,
    /// The cells that it may touch, by their indices among the touched cells of [`crate::Tools`], increasing.
    pub cells: Vec<u32>,
    /// Indices, among those of [`crate::Tools`], of the triangles that it may touch in addition to nodes: for a tool
    /// smaller than the triangles.
    pub triangles: Vec<u32>,
    /// Time during which it grasps the tissue that it touches; `None` if it never grasps.
    pub grasp: Option<Grasp>,
}

impl Tool {
    /// True if it grasps the tissue that it touches in a step that ends at `t` (s), under inputs from outside.
    pub(super) fn holds(&self, t: f64, inputs: &Inputs) -> bool {
        let own = self
            .grasp
            .is_some_and(|grasp| (grasp.from..=grasp.to).contains(&t));
        match &self.motion {
            Motion::Steered(_, steering) => steering.holds(t, inputs).unwrap_or(own),
            _ => own,
        }
    }

    /// True if it can grasp tissue: by its own schedule or by steering.
    pub(super) fn may_hold(&self) -> bool {
        self.grasp.is_some() || matches!(self.motion, Motion::Steered(..))
    }
}

/// An interval of time in which a tool grasps the tissue that it touches: a cell that it pushes in this interval moves
/// with it until the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grasp {
    /// Its beginning (s).
    pub from: f64,
    /// Its end (s).
    pub to: f64,
}

/// A cell at the surface of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchedCell {
    /// Its number in the system.
    pub cell: u32,
    /// Its position at rest (m).
    pub rest: [f64; 3],
    /// Flags for x, y and z: true if the cell can move in that direction.
    pub free: [bool; 3],
}

impl TouchedCell {
    /// Current position (m), with the displacements of all cells.
    pub(super) fn at(&self, u: &[f64]) -> [f64; 3] {
        add(self.rest, along_axes(u, self.cell))
    }
}

/// The three numbers of a cell in a vector.
pub(super) fn along_axes(values: &[f64], cell: u32) -> [f64; 3] {
    let first = 3 * cell as usize;
    [values[first], values[first + 1], values[first + 2]]
}

/// A triangle of the surface of a body, given by its corners, counter-clockwise as seen from outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchedTriangle {
    /// The corners.
    pub corners: [Corner; 3],
}

/// A corner of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Corner {
    /// A touched cell, by its index among them.
    Cell(u32),
    /// A fixed position (m).
    Held([f64; 3]),
}

impl Corner {
    /// Current position (m); `cell` gives that of the cell with an index.
    pub(super) fn at(self, cell: impl Fn(u32) -> [f64; 3]) -> [f64; 3] {
        match self {
            Self::Cell(place) => cell(place),
            Self::Held(at) => at,
        }
    }

    /// The index of a cell among the touched ones; `None` if the corner is fixed.
    pub(super) fn place(self) -> Option<u32> {
        match self {
            Self::Cell(place) => Some(place),
            Self::Held(_) => None,
        }
    }
}

impl ToolsError {
    /// The name of the tool at fault; `None` if it is not a single tool.
    #[must_use]
    pub fn tool(&self) -> Option<&str> {
        match self {
            Self::TooMany { .. } | Self::NoLip { .. } => None,
            Self::SameName { name }
            | Self::Friction { name, .. }
            | Self::Grasp { name, .. }
            | Self::Body { name, .. }
            | Self::NoTriangle { name, .. }
            | Self::NoCell { name, .. } => Some(name),
        }
    }
}

/// Tools that do not fit together, or to their cells.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ToolsError {
    /// More tools than one body can have.
    #[error("{count} tools: expected at most {most}")]
    TooMany {
        /// Their number.
        count: usize,
        /// The largest number.
        most: usize,
    },
    /// Two tools with the same name.
    #[error("two tools are named \"{name}\": give each a different name")]
    SameName {
        /// The name.
        name: String,
    },
    /// A coefficient of friction that is negative or not finite.
    #[error("\"{name}\": friction = {friction}: expected a finite number, 0 or above")]
    Friction {
        /// The tool.
        name: String,
        /// The coefficient.
        friction: f64,
    },
    /// A grasp whose end is not after its beginning.
    #[error("\"{name}\": grasp from {from} s to {to} s: expected an end after the beginning")]
    Grasp {
        /// The tool.
        name: String,
        /// The beginning (s).
        from: f64,
        /// The end (s).
        to: f64,
    },
    /// A dynamic body that is not physical.
    #[error("\"{name}\": {source}")]
    Body {
        /// The tool.
        name: String,
        /// Reason why its body is refused.
        source: ToolBodyError,
    },
    /// An index beyond the triangles.
    #[error(
        "\"{name}\" may touch triangle {place} of {triangles}: expected a place below their number, and corners below that of cells"
    )]
    NoTriangle {
        /// The tool.
        name: String,
        /// The place.
        place: u32,
        /// Number of triangles.
        triangles: usize,
    },
    /// A corner of a cut face beyond the touched cells.
    #[error("a cut face has cell {place} of {cells}: expected a place below their number")]
    NoLip {
        /// The place.
        place: u32,
        /// Number of touched cells.
        cells: usize,
    },
    /// An index beyond the touched cells.
    #[error("\"{name}\" may touch cell {place} of {cells}: expected a place below their number")]
    NoCell {
        /// The tool.
        name: String,
        /// The place.
        place: u32,
        /// Number of touched cells.
        cells: usize,
    },
}
