//! Errors of logs.

use std::io;
use std::path::PathBuf;

/// Reasons for which a log cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LogError {
    /// A file that cannot be read.
    #[error("{path}: {source}", path = .path.display())]
    File {
        /// Its path.
        path: PathBuf,
        /// The error.
        source: io::Error,
    },
    /// A line that is not valid.
    #[error("{path}:{line}: {fault}", path = .path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// The fault.
        fault: LogFault,
    },
}

/// A fault in a line of a log.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LogFault {
    /// A file of another kind.
    #[error("expected `{expected}`: this is not the log of a session")]
    Kind {
        /// The first line of logs.
        expected: String,
    },
    /// A log of a later version.
    #[error("a log of version {found}: this program reads version {known}; take a newer one")]
    Newer {
        /// Its version.
        found: usize,
        /// The version that is known.
        known: usize,
    },
    /// A word other than the expected one.
    #[error("\"{found}\": expected {expected}")]
    Word {
        /// The word.
        found: String,
        /// Description of the expected text.
        expected: &'static str,
    },
    /// A step before that of the line above.
    #[error(
        "step {found} comes after step {last} of the line above: lines must be in the order of steps"
    )]
    Step {
        /// The step.
        found: usize,
        /// The step before.
        last: usize,
    },
    /// A time before that of the line above, and no reset between them.
    #[error(
        "t = {found} s comes after t = {last} s of the line above: without a reset time rises with the steps"
    )]
    Time {
        /// The time (s).
        found: f64,
        /// The time before (s).
        last: f64,
    },
    /// A line after the end.
    #[error("a line after the end: expected none after `{end} end`")]
    AfterEnd {
        /// Steps at the end.
        end: usize,
    },
    /// A log that was cut off within its first lines.
    #[error("the log is cut off before its first command: there is nothing to repeat")]
    NoHead,
}
