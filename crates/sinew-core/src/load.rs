//! Loads.

use crate::ramp::Ramp;

/// A force with one factor over time: `ramp(t)` times `entries`.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// The factor over time.
    pub ramp: Ramp,
    /// (degree of freedom, force (N)) of each loaded degree of freedom.
    pub entries: Vec<(u32, f64)>,
}
