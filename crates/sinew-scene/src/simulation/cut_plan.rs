//! The cutting of a body, with the content of its files.

use sinew_cutting::Strokes;

use crate::scene::Cutting;

/// The cutting of a body, with the content of its files.
#[derive(Debug)]
pub(super) struct CutPlan {
    pub(super) cutting: Cutting,
    /// The strokes of a table.
    pub(super) strokes: Option<Strokes>,
}
