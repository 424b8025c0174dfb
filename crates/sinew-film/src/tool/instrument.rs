//! A rigid instrument.

use super::motion::{self, PoseAt};
use super::part::Part;

/// A rigid instrument.
#[derive(Debug, Clone, PartialEq)]
pub struct Tool {
    /// Parts of the instrument, in its own frame.
    pub parts: Vec<Part>,
    /// Poses in the order of time. Between two of them the instrument moves along a straight line; before the first and
    /// after the last it does not move.
    pub poses: Vec<PoseAt>,
    /// The times (s) between which the instrument is visible.
    pub seen: [f64; 2],
}

impl Tool {
    /// An instrument that is always visible.
    #[must_use]
    pub fn new(parts: Vec<Part>, poses: Vec<PoseAt>) -> Self {
        Self {
            parts,
            poses,
            seen: [f64::NEG_INFINITY, f64::INFINITY],
        }
    }

    /// The pose at a time (s); `None` if the instrument is not visible or has no poses.
    pub(crate) fn pose(&self, t: f64) -> Option<PoseAt> {
        let [from, to] = self.seen;
        let is_seen = t >= from && t <= to;
        motion::at(&self.poses, t).filter(|_| is_seen)
    }
}
