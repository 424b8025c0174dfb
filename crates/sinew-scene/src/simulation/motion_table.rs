//! Tables of positions in CSV files.

use std::path::{Path, PathBuf};

const COLUMNS: [&str; 4] = ["t_s", "x_m", "y_m", "z_m"];

/// Positions relative to rest (m) over time (s).
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct MotionTable {
    pub(super) times: Vec<f64>,
    pub(super) positions: Vec<[f64; 3]>,
}

/// A table of positions that cannot be used: its file, its line, and what is wrong.
#[derive(Debug, thiserror::Error)]
#[error("{}{}: {fault}", path.display(), line.map_or_else(String::new, |line| format!(":{line}")))]
pub struct MotionTableError {
    path: PathBuf,
    line: Option<usize>,
    fault: MotionTableFault,
}

impl MotionTableError {
    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The line, counted from 1; `None` where the fault is that of the whole file.
    #[must_use]
    pub fn line(&self) -> Option<usize> {
        self.line
    }

    /// What is wrong.
    #[must_use]
    pub fn fault(&self) -> &MotionTableFault {
        &self.fault
    }
}

/// A fault in a table of positions.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MotionTableFault {
    /// A file that cannot be read.
    #[error("cannot be read: {0}")]
    Unreadable(#[from] std::io::Error),
    /// Other columns than those of a table of positions.
    #[error("the first line is {found:?}: expected the names of the columns, t_s,x_m,y_m,z_m")]
    Header {
        /// The line, shortened.
        found: String,
    },
    /// A row with more or fewer numbers than columns.
    #[error("expected 4 numbers, t_s,x_m,y_m,z_m, found {found}")]
    Count {
        /// How many there are.
        found: usize,
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
        /// That of the row before (s).
        last: f64,
    },
    /// A table without a row.
    #[error("there is no row below the names of the columns: expected at least one")]
    NoRows,
    /// A position along an axis that is not moved.
    #[error("{column} = {found}, but the axis is not among `axes`: expected 0")]
    UnnamedAxis {
        /// Name of the column.
        column: &'static str,
        /// The position (m).
        found: f64,
    },
}

impl MotionTable {
    /// Reads a table for a motion along `axes`.
    pub(super) fn read(path: &Path, axes: [bool; 3]) -> Result<Self, MotionTableError> {
        let error = |line, fault| MotionTableError {
            path: path.to_owned(),
            line,
            fault,
        };
        let text = std::fs::read_to_string(path).map_err(|source| error(None, source.into()))?;
        Self::parse(&text, axes).map_err(|(line, fault)| error(Some(line), fault))
    }

    /// The table of a text, or the line that is at fault.
    fn parse(text: &str, axes: [bool; 3]) -> Result<Self, (usize, MotionTableFault)> {
        // Spreadsheets begin a file with a mark of its byte order.
        let text = text.trim_start_matches('\u{feff}').trim_end();
        let mut lines = (1..).zip(text.lines());
        let header = lines.next().map_or("", |(_, line)| line);
        if !header.split(',').map(str::trim).eq(COLUMNS) {
            let found = shortened(header);
            return Err((1, MotionTableFault::Header { found }));
        }
        let mut table = Self::default();
        for (line, row) in lines {
            let [t, position @ ..] = numbers(row).map_err(|fault| (line, fault))?;
            if let Some(&last) = table.times.last()
                && t <= last
            {
                return Err((line, MotionTableFault::Order { t, last }));
            }
            let unnamed = |axis: &usize| !axes[*axis] && position[*axis] != 0.0;
            if let Some(axis) = (0..3).find(unnamed) {
                let fault = MotionTableFault::UnnamedAxis {
                    column: COLUMNS[axis + 1],
                    found: position[axis],
                };
                return Err((line, fault));
            }
            table.times.push(t);
            table.positions.push(position);
        }
        if table.times.is_empty() {
            return Err((1, MotionTableFault::NoRows));
        }
        Ok(table)
    }
}

fn numbers(row: &str) -> Result<[f64; 4], MotionTableFault> {
    let entries: Vec<&str> = row.split(',').map(str::trim).collect();
    if entries.len() != COLUMNS.len() {
        let found = if row.trim().is_empty() {
            0
        } else {
            entries.len()
        };
        return Err(MotionTableFault::Count { found });
    }
    let mut numbers = [0.0; 4];
    for ((number, entry), column) in numbers.iter_mut().zip(entries).zip(COLUMNS) {
        *number = match entry.parse::<f64>() {
            Ok(number) if number.is_finite() => number,
            _ => {
                let found = shortened(entry);
                return Err(MotionTableFault::NotANumber { column, found });
            }
        };
    }
    Ok(numbers)
}

/// Enough of a text to recognise it.
fn shortened(text: &str) -> String {
    const LONGEST: usize = 40;
    match text.char_indices().nth(LONGEST) {
        None => text.to_owned(),
        Some((end, _)) => format!("{}..", &text[..end]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [bool; 3] = [true; 3];

    #[test]
    fn rows_are_times_and_positions_whatever_ends_a_line() {
        let expected = MotionTable {
            times: vec![0.0, 0.25],
            positions: vec![[0.0; 3], [1e-3, -2.0, 3.0]],
        };
        for text in [
            "t_s,x_m,y_m,z_m\n0,0,0,0\n0.25,1e-3,-2,3\n",
            "\u{feff}t_s, x_m, y_m, z_m\r\n0, 0, 0, 0\r\n0.25, 1e-3, -2.0, 3.\r\n\r\n",
        ] {
            assert_eq!(MotionTable::parse(text, ALL).unwrap(), expected);
        }
        let one = MotionTable::parse("t_s,x_m,y_m,z_m\n1,0,0,2", ALL).unwrap();
        assert_eq!(one.positions, [[0.0, 0.0, 2.0]]);
    }

    #[test]
    fn faults_name_their_line() {
        let fault = |rows: &str| {
            let text = format!("t_s,x_m,y_m,z_m\n{rows}");
            let (line, fault) = MotionTable::parse(&text, [true, true, false]).unwrap_err();
            format!("{line}: {fault}")
        };
        assert_eq!(
            fault("0,0,0,0\n0.1,0,0\n"),
            "3: expected 4 numbers, t_s,x_m,y_m,z_m, found 3"
        );
        assert_eq!(
            fault("0,0,0,0\n\n0.2,0,0,0"),
            "3: expected 4 numbers, t_s,x_m,y_m,z_m, found 0"
        );
        assert_eq!(fault("0,0,,0"), "2: y_m is \"\": expected a finite number");
        assert_eq!(
            fault("0,inf,0,0"),
            "2: x_m is \"inf\": expected a finite number"
        );
        assert_eq!(
            fault("0,0,0,0\n0.2,0,0,0\n0.2,0,0,0"),
            "4: t_s = 0.2 does not come after 0.2, the time of the row before"
        );
        assert_eq!(
            fault("0,0,0,1"),
            "2: z_m = 1, but the axis is not among `axes`: expected 0"
        );
        assert_eq!(
            fault(""),
            "1: there is no row below the names of the columns: expected at least one"
        );
    }
}
