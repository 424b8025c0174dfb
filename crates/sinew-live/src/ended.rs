//! Result of a session that has ended.

use sinew_scene::Scene;
use sinew_world::{JournalError, Log};

/// A session that has ended.
#[derive(Debug)]
pub struct Ended {
    /// The simulated time (s).
    pub t: f64,
    /// True if a page asked for the start page.
    pub goes_to_start: bool,
    /// The scene, with the page's changes of tools.
    pub scene: Scene,
    /// Values that were set in its file to get it, as `KEY=VALUE`.
    pub values: Vec<String>,
    /// Files of [`Live::keep_logs`](crate::Live::keep_logs) with incomplete logs.
    pub unkept: Vec<JournalError>,
    /// The log of each pane.
    pub logs: Vec<Log>,
}
