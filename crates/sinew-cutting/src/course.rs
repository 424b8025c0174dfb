//! How far a stroke went through a body.

use crate::vector::Vector;

/// How far a stroke went through a body so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Course {
    /// The last pose of the blade.
    pub(crate) blade: Option<[Vector; 2]>,
    /// Whether it began within the body, or an end of the blade was in it: then its rim lies within, and tissue that was entered in part is left there.
    pub(crate) is_rimmed: bool,
    /// How far behind its farthest place the blade is (m).
    pub(crate) back: f64,
    /// Whether it was out of the body at the last sheet.
    pub(crate) is_out: bool,
}
