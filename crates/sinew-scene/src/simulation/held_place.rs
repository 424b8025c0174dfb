//! The parts of a body that a scene's supports and motions fix or move.

use std::fmt;

use serde::{Deserialize, Serialize};
use sinew_fem::On;

/// A part of the body that a table of the scene fixes or moves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HeldPlace {
    /// The table.
    pub by: ReactionOf,
    /// The part of the body.
    pub on: On,
    /// Its nodes (0-based) with the components that it fixes or moves and that no earlier part fixes or moves, so that
    /// the forces of all parts add up to the total.
    pub nodes: Vec<(u32, [bool; 3])>,
    /// Mean (m) of the positions at rest of its nodes before all cuts.
    pub centre: [f64; 3],
}

/// A table of a scene that fixes or moves components, given by its index in the list (0-based).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ReactionOf {
    /// `[[fixed]]`.
    Fixed(usize),
    /// `[[move]]`.
    Move(usize),
}

impl fmt::Display for ReactionOf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fixed(index) => write!(f, "[[fixed]] {}", index + 1),
            Self::Move(index) => write!(f, "[[move]] {}", index + 1),
        }
    }
}
