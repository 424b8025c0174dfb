//! The cutting of a body, with its files read.

use sinew_cutting::Strokes;

use crate::scene::Cutting;

/// The cutting of a body, with its files read.
#[derive(Debug)]
pub(super) struct CutPlan {
    pub(super) cutting: Cutting,
    /// The strokes of a table.
    pub(super) strokes: Option<Strokes>,
}
