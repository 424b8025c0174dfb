//! What a session leaves.

use sinew_session::Log;

/// A session that has ended.
#[derive(Clone, Debug)]
pub struct Ended {
    /// The simulated time (s).
    pub t: f64,
    /// The log of each pane.
    pub logs: Vec<Log>,
}
