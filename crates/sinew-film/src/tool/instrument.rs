//! A rigid instrument.

use super::motion::{self, PoseAt};
use super::part::Part;

/// A rigid instrument.
#[derive(Debug, Clone, PartialEq)]
pub struct Tool {
    /// What it is made of, in its own frame.
    pub parts: Vec<Part>,
    /// Where it is over time, in the order of time; between two of them it moves straight, before the first and after the
    /// last it stays.
    pub poses: Vec<PoseAt>,
    /// The times (s) between which it is seen.
    pub seen: [f64; 2],
}

impl Tool {
    /// An instrument that is always seen.
    #[must_use]
    pub fn new(parts: Vec<Part>, poses: Vec<PoseAt>) -> Self {
        Self {
            parts,
            poses,
            seen: [f64::NEG_INFINITY, f64::INFINITY],
        }
    }

    /// Where it is seen at a time (s); `None` where it is not, or has no poses.
    pub(crate) fn pose(&self, t: f64) -> Option<PoseAt> {
        let [from, to] = self.seen;
        let is_seen = t >= from && t <= to;
        motion::at(&self.poses, t).filter(|_| is_seen)
    }
}
