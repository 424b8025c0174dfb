//! Tables of positions, poses, strokes and factors in CSV files.

use std::io::{Error, ErrorKind};
use std::path::Path;

use sinew_core::Ramp;
use sinew_cutting::{BladePose, Strokes};

use crate::error::{MotionTableError, MotionTableFault};
use crate::source::SceneSource;

/// The column of times.
const TIME: &str = "t_s";

/// Columns of a table of positions.
const POSITIONS: [&str; 4] = [TIME, "x_m", "y_m", "z_m"];

/// Columns of a table of poses.
const POSES: [&str; 7] = [TIME, "x_m", "y_m", "z_m", "rx_rad", "ry_rad", "rz_rad"];

/// Positions relative to rest (m) over time (s).
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct MotionTable {
    pub(super) times: Vec<f64>,
    pub(super) positions: Vec<[f64; 3]>,
}

/// Positions (m) and rotation vectors (rad) over time (s).
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct PoseTable {
    pub(super) times: Vec<f64>,
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) rotations: Vec<[f64; 3]>,
}

/// Columns of a table of strokes.
const STROKES: [&str; 8] = [
    "stroke", TIME, "ax_m", "ay_m", "az_m", "bx_m", "by_m", "bz_m",
];

/// Columns of a table of factors.
const FACTORS: [&str; 2] = [TIME, "factor"];

/// Rows of numbers, one number for each column.
struct Rows {
    columns: &'static [&'static str],
    rows: Vec<Vec<f64>>,
}

impl MotionTable {
    /// Reads a table for a motion along `axes`.
    pub(super) fn read(
        scene: &SceneSource,
        written: &Path,
        axes: [bool; 3],
    ) -> Result<Self, MotionTableError> {
        read(scene, written, |text| Self::parse(text, axes))
    }

    /// The table of a text, or the line with the fault.
    fn parse(text: &str, axes: [bool; 3]) -> Result<Self, (usize, MotionTableFault)> {
        let rows = Rows::parse(text, &[&POSITIONS], 1)?;
        let table = Self {
            times: rows.times(),
            positions: rows.vectors(1),
        };
        for (line, position) in (2..).zip(&table.positions) {
            let unnamed = |axis: &usize| !axes[*axis] && position[*axis] != 0.0;
            if let Some(axis) = (0..3).find(unnamed) {
                let fault = MotionTableFault::UnnamedAxis {
                    column: POSITIONS[axis + 1],
                    found: position[axis],
                };
                return Err((line, fault));
            }
        }
        Ok(table)
    }
}

impl PoseTable {
    /// Reads a table; without columns of rotations there is no rotation.
    pub(super) fn read(scene: &SceneSource, written: &Path) -> Result<Self, MotionTableError> {
        read(scene, written, Self::parse)
    }

    /// The table of a text, or the line with the fault.
    fn parse(text: &str) -> Result<Self, (usize, MotionTableFault)> {
        let rows = Rows::parse(text, &[&POSITIONS, &POSES], 1)?;
        Ok(Self {
            times: rows.times(),
            positions: rows.vectors(1),
            rotations: match rows.columns.len() == POSES.len() {
                true => rows.vectors(4),
                false => vec![[0.0; 3]; rows.rows.len()],
            },
        })
    }
}

/// Reads a table of the strokes of a blade.
pub(super) fn read_strokes(
    scene: &SceneSource,
    written: &Path,
) -> Result<Strokes, MotionTableError> {
    read(scene, written, strokes)
}

/// The strokes of a text, or the line with the fault.
fn strokes(text: &str) -> Result<Strokes, (usize, MotionTableFault)> {
    let rows = Rows::parse(text, &[&STROKES], 1)?;
    let ends = rows.vectors(2).into_iter().zip(rows.vectors(5));
    let poses = rows.rows.iter().zip(ends).map(|(row, (a, b))| BladePose {
        stroke: row[0],
        t: row[1],
        ends: [a, b],
    });
    // Row 1 is on line 2, below the names.
    Strokes::new(poses.collect()).map_err(|error| (error.row() + 1, error.into()))
}

/// Reads a table of factors, in which two rows at one time are a jump.
pub(super) fn read_factor(scene: &SceneSource, written: &Path) -> Result<Ramp, MotionTableError> {
    read(scene, written, factor)
}

/// The factor of a text, or the line with the fault.
fn factor(text: &str) -> Result<Ramp, (usize, MotionTableFault)> {
    let rows = Rows::parse(text, &[&FACTORS], 2)?;
    Ok(Ramp::Table {
        times: rows.times(),
        values: rows.rows.iter().map(|row| row[1]).collect(),
    })
}

/// Reads a file and makes a table of its text.
fn read<T>(
    scene: &SceneSource,
    written: &Path,
    parse: impl FnOnce(&str) -> Result<T, (usize, MotionTableFault)>,
) -> Result<T, MotionTableError> {
    let path = scene.resolve(written);
    let error = |line, fault| MotionTableError {
        path: path.clone(),
        line,
        fault,
    };
    let content = scene
        .read(&path)
        .map_err(|source| error(None, source.into()))?;
    let no_text = |_| Error::new(ErrorKind::InvalidData, "stream did not contain valid UTF-8");
    let text =
        std::str::from_utf8(&content).map_err(|invalid| error(None, no_text(invalid).into()))?;
    parse(text).map_err(|(line, fault)| error(Some(line), fault))
}

impl Rows {
    /// The rows of a text with one of these sets of columns, or the line with a fault. Up to `at_once` rows may have
    /// the same time.
    fn parse(
        text: &str,
        accepted: &[&'static [&'static str]],
        at_once: usize,
    ) -> Result<Self, (usize, MotionTableFault)> {
        // Spreadsheets begin a file with a mark of its byte order.
        let text = text.trim_start_matches('\u{feff}').trim_end();
        let mut lines = (1..).zip(text.lines());
        let header = lines.next().map_or("", |(_, line)| line);
        let fits = |columns: &&&'static [&'static str]| {
            let names = header.split(',').map(str::trim);
            names.eq(columns.iter().copied())
        };
        let Some(columns) = accepted.iter().find(fits) else {
            let expected: Vec<String> = accepted.iter().map(|names| names.join(",")).collect();
            let fault = MotionTableFault::Header {
                found: shortened(header),
                expected: expected.join(" or "),
            };
            return Err((1, fault));
        };
        let time = columns.iter().position(|name| *name == TIME).unwrap_or(0);
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for (line, row) in lines {
            let row = numbers(row, columns).map_err(|fault| (line, fault))?;
            let t = row[time];
            let before = rows.iter().rev().map(|row| row[time]);
            match before.clone().next() {
                Some(last) if t < last || (t == last && at_once == 1) => {
                    return Err((line, MotionTableFault::Order { t, last }));
                }
                _ if before.take_while(|last| *last == t).count() >= at_once => {
                    return Err((line, MotionTableFault::Jump { t }));
                }
                _ => {}
            }
            rows.push(row);
        }
        if rows.is_empty() {
            return Err((1, MotionTableFault::NoRows));
        }
        Ok(Self { columns, rows })
    }

    fn times(&self) -> Vec<f64> {
        self.rows.iter().map(|row| row[0]).collect()
    }

    /// The vectors of three columns from this one on.
    fn vectors(&self, first: usize) -> Vec<[f64; 3]> {
        let vector = |row: &Vec<f64>| std::array::from_fn(|axis| row[first + axis]);
        self.rows.iter().map(vector).collect()
    }
}

fn numbers(row: &str, columns: &'static [&'static str]) -> Result<Vec<f64>, MotionTableFault> {
    let entries: Vec<&str> = row.split(',').map(str::trim).collect();
    if entries.len() != columns.len() {
        let found = if row.trim().is_empty() {
            0
        } else {
            entries.len()
        };
        return Err(MotionTableFault::Count { found, columns });
    }
    let number = |(entry, column): (&str, &&'static str)| match entry.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => {
            let found = shortened(entry);
            Err(MotionTableFault::NotANumber { column, found })
        }
    };
    entries.into_iter().zip(columns).map(number).collect()
}

/// The beginning of a text, sufficient to recognise it.
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

    #[test]
    fn two_factors_at_one_time_are_a_jump_and_a_third_is_a_fault() {
        let expected = Ramp::Table {
            times: vec![0.0, 0.1, 0.1],
            values: vec![0.0, 1.0, -0.5],
        };
        assert_eq!(
            factor("t_s,factor\n0,0\n0.1,1\n0.1,-0.5\n").unwrap(),
            expected
        );
        let fault = |rows: &str| {
            let (line, fault) = factor(&format!("t_s,factor\n{rows}")).unwrap_err();
            format!("{line}: {fault}")
        };
        assert_eq!(
            fault("0,0\n0.1,1\n0.1,0\n0.1,2\n"),
            "5: t_s = 0.1 is the time of the two rows before: expected two rows at most, the factor before a jump and that \
             after it"
        );
        assert_eq!(
            fault("0.1,1\n0.1,0\n0,0\n"),
            "4: t_s = 0 does not come after 0.1, the time of the row before"
        );
        assert_eq!(
            fault("0,none"),
            "2: factor is \"none\": expected a finite number"
        );
        let (line, fault) = factor("t_s,force_N\n0,0").unwrap_err();
        assert_eq!(
            format!("{line}: {fault}"),
            "1: the first line is \"t_s,force_N\": expected the names of the columns, t_s,factor"
        );
    }

    #[test]
    fn poses_have_rotations_or_none() {
        let table = PoseTable::parse("t_s,x_m,y_m,z_m\n0,1,2,3\n").unwrap();
        assert_eq!(table.rotations, [[0.0; 3]]);
        let text = "t_s,x_m,y_m,z_m,rx_rad,ry_rad,rz_rad\n0,1,2,3,4,5,6\n1,0,0,0,0,0,7\n";
        let table = PoseTable::parse(text).unwrap();
        assert_eq!(table.times, [0.0, 1.0]);
        assert_eq!(table.positions, [[1.0, 2.0, 3.0], [0.0; 3]]);
        assert_eq!(table.rotations, [[4.0, 5.0, 6.0], [0.0, 0.0, 7.0]]);
    }

    #[test]
    fn faults_of_poses_name_the_columns_that_are_expected() {
        let fault = |text: &str| {
            let (line, fault) = PoseTable::parse(text).unwrap_err();
            format!("{line}: {fault}")
        };
        assert_eq!(
            fault("t_s,x_m,z_m\n0,0,0"),
            "1: the first line is \"t_s,x_m,z_m\": expected the names of the columns, t_s,x_m,y_m,z_m or \
             t_s,x_m,y_m,z_m,rx_rad,ry_rad,rz_rad"
        );
        assert_eq!(
            fault("t_s,x_m,y_m,z_m,rx_rad,ry_rad,rz_rad\n0,0,0,0,0,0,0\n1,0,0,0"),
            "3: expected 7 numbers, t_s,x_m,y_m,z_m,rx_rad,ry_rad,rz_rad, found 4"
        );
        assert_eq!(
            fault("t_s,x_m,y_m,z_m\n0,0,0,NaN"),
            "2: z_m is \"NaN\": expected a finite number"
        );
    }
}
