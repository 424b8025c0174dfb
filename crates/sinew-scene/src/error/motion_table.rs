//! Faults of tables over time.

use std::path::{Path, PathBuf};

/// A table over time that cannot be used: its file, its line, and the fault.
#[derive(Debug, thiserror::Error)]
#[error("{}{}: {fault}", path.display(), line.map_or_else(String::new, |line| format!(":{line}")))]
pub struct MotionTableError {
    pub(crate) path: PathBuf,
    pub(crate) line: Option<usize>,
    pub(crate) fault: MotionTableFault,
}

impl MotionTableError {
    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The line, counted from 1; `None` if the fault concerns the whole file.
    #[must_use]
    pub fn line(&self) -> Option<usize> {
        self.line
    }

    /// The fault.
    #[must_use]
    pub fn fault(&self) -> &MotionTableFault {
        &self.fault
    }
}

/// A fault in a table over time.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MotionTableFault {
    /// A file that cannot be read.
    #[error("cannot be read: {0}")]
    Unreadable(#[from] std::io::Error),
    /// A header with other columns than those of such a table.
    #[error("the first line is {found:?}: expected the names of the columns, {expected}")]
    Header {
        /// The line, shortened.
        found: String,
        /// Description of the lines that fit.
        expected: String,
    },
    /// A row with more or fewer numbers than columns.
    #[error("expected {} numbers, {}, found {found}", columns.len(), columns.join(","))]
    Count {
        /// Number of entries found.
        found: usize,
        /// The names of the columns.
        columns: &'static [&'static str],
    },
    /// An entry that is not a finite number.
    #[error("{column} is {found:?}: expected a finite number")]
    NotANumber {
        /// Name of the column.
        column: &'static str,
        /// The entry, shortened.
        found: String,
    },
    /// A time that does not come after that of the row before.
    #[error("t_s = {t} does not come after {last}, the time of the row before")]
    Order {
        /// The time (s).
        t: f64,
        /// Time (s) of the row before.
        last: f64,
    },
    /// A third row of factors at one time.
    #[error(
        "t_s = {t} is the time of the two rows before: expected two rows at most, the factor before a jump and that after it"
    )]
    Jump {
        /// The time (s).
        t: f64,
    },
    /// A table without a row.
    #[error("there is no row below the names of the columns: expected at least one")]
    NoRows,
    /// Rows that are not valid strokes.
    #[error(transparent)]
    Strokes(#[from] sinew_cutting::StrokesError),
    /// A position along an axis that is not moved.
    #[error("{column} = {found}, but the axis is not among `axes`: expected 0")]
    UnnamedAxis {
        /// Name of the column.
        column: &'static str,
        /// The position (m).
        found: f64,
    },
}
