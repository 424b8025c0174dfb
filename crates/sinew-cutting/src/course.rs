//! Progress of a stroke through a body.

use sinew_mesh::vector::Vector;

/// Progress of a stroke through a body so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Course {
    /// The last pose of the blade.
    pub(crate) blade: Option<[Vector; 2]>,
    /// True if the stroke began inside the body, or an end of the blade was inside it: then the rim of the cut is
    /// inside, and partly cut tissue remains there.
    pub(crate) is_rimmed: bool,
    /// Distance (m) of the blade back from its farthest position.
    pub(crate) back: f64,
    /// True if the blade was outside the body at the last sheet.
    pub(crate) is_out: bool,
}
