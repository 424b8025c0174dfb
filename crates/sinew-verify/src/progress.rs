//! Progress of a verification or a bench.

use std::path::PathBuf;

/// Progress of a verification or a bench.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress {
    /// A scene is read and its reference is solved.
    Reference {
        /// The scene's file.
        scene: PathBuf,
    },
    /// A run begins.
    Run {
        /// Number of completed runs.
        done: usize,
        /// Number of all runs.
        of: usize,
        /// Description of the run.
        what: String,
    },
}
