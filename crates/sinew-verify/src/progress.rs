//! Progress of a verification or a bench.

use std::path::PathBuf;

/// Progress of a verification or a bench.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress {
    /// A scene is read and its reference solved.
    Reference {
        /// The scene's file.
        scene: PathBuf,
    },
    /// A run begins.
    Run {
        /// Runs done before.
        done: usize,
        /// Runs in all.
        of: usize,
        /// Description of the run.
        what: String,
    },
}
