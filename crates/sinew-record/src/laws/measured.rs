//! Measured points for comparison with the curves of laws.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use sinew_fem::homogeneous::{Curve, Load};

/// Names that the columns may have.
const COLUMNS: [&[&str]; 3] = [
    &["load"],
    &["stretch", "shear", "stretch_or_shear", "stretch_or_shear_1"],
    &["stress", "stress_Pa", "nominal_stress_Pa"],
];

/// The line of column names, for messages.
const HEAD: &str = "load,stretch_or_shear,stress_Pa";

/// Characters of a text in messages.
const SHOWN: usize = 40;

/// Measured points: a CSV file with the columns `load` (`uniaxial`, `equibiaxial`, `planar` or `simple-shear`),
/// `stretch_or_shear` (1 and 0 at rest) and `stress_Pa` (nominal).
/// Empty lines and lines that begin with `#` are skipped.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// The load of each point, its amount and the nominal stress (Pa).
    pub points: Vec<(Load, f64, f64)>,
}

/// The difference between a curve and the points measured under its load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Misfit {
    /// Number of points within the range of the curve.
    pub(crate) points: usize,
    /// Number of points beyond that range.
    pub(crate) beyond: usize,
    /// The root of the mean square difference (Pa).
    pub(crate) root_mean_square: f64,
    /// The largest size of a measured stress (Pa).
    pub(crate) largest: f64,
}

/// A file of measured points that cannot be used: the file, the line, and the fault.
#[derive(Debug, thiserror::Error)]
#[error("{}{}: {fault}", path.display(), line.map_or_else(String::new, |line| format!(":{line}")))]
pub struct MeasuredError {
    /// The file.
    pub path: PathBuf,
    /// The line, from 1 on; `None` if the fault concerns the whole file.
    pub line: Option<usize>,
    /// The fault.
    pub fault: MeasuredFault,
}

/// A fault in a file of measured points.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeasuredFault {
    /// A file that cannot be read.
    #[error("cannot be read: {0}")]
    Unreadable(#[from] io::Error),
    /// Bytes that are not UTF-8 text.
    #[error("is no text in UTF-8: save the table as CSV (UTF-8)")]
    NotText,
    /// A header with other columns.
    #[error("the first line is {found:?}: expected the names of the columns, {HEAD}")]
    Header {
        /// The line, shortened.
        found: String,
    },
    /// A row with more or fewer entries than columns.
    #[error("expected 3 entries, {HEAD}, found {found}")]
    Count {
        /// Number of entries found.
        found: usize,
    },
    /// A load that does not exist.
    #[error("load is {found:?}: expected uniaxial, equibiaxial, planar or simple-shear")]
    Load {
        /// The entry, shortened.
        found: String,
    },
    /// An entry that is not a number within the allowed range.
    #[error("{column} is {found:?}: expected {expected}")]
    Number {
        /// The column.
        column: &'static str,
        /// The entry, shortened.
        found: String,
        /// The values that fit.
        expected: &'static str,
    },
    /// A file without rows.
    #[error("expected at least one row below the names of the columns")]
    Empty,
}

impl Measured {
    /// Reads a file.
    ///
    /// # Errors
    /// [`MeasuredError`].
    pub fn read(path: &Path) -> Result<Self, MeasuredError> {
        let at = |(line, fault)| MeasuredError {
            path: path.to_owned(),
            line,
            fault,
        };
        let bytes = fs::read(path).map_err(|error| at((None, error.into())))?;
        let text = String::from_utf8(bytes).map_err(|_| at((None, MeasuredFault::NotText)))?;
        Self::parse(&text).map_err(at)
    }

    fn parse(text: &str) -> Result<Self, (Option<usize>, MeasuredFault)> {
        let lines = text.trim_start_matches('\u{feff}').lines();
        let mut rows = (1..)
            .zip(lines.map(str::trim))
            .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        let (number, head) = rows.next().ok_or((None, MeasuredFault::Empty))?;
        let entries: Vec<&str> = head.split(',').map(unquoted).collect();
        let fits = |(entry, names): (&&str, &&[&str])| names.contains(entry);
        if entries.len() != COLUMNS.len() || !entries.iter().zip(&COLUMNS).all(fits) {
            let found = shortened(head);
            return Err((Some(number), MeasuredFault::Header { found }));
        }
        let points = rows.map(|(number, line)| point(line).map_err(|fault| (Some(number), fault)));
        let points: Vec<_> = points.collect::<Result<_, _>>()?;
        match points.is_empty() {
            true => Err((None, MeasuredFault::Empty)),
            false => Ok(Self { points }),
        }
    }

    /// The least and the largest stretch of all points and of 1; stretches of shears are 1 above their amounts.
    pub(crate) fn stretches(&self) -> [f64; 2] {
        let stretches = self.points.iter();
        let stretches = stretches.map(|(load, amount, _)| amount + 1.0 - load.rest());
        stretches.fold([1.0, 1.0], |[low, high], stretch| {
            [low.min(stretch), high.max(stretch)]
        })
    }

    /// Amounts and nominal stresses (Pa) of a load.
    pub(crate) fn of(&self, load: Load) -> impl Iterator<Item = (f64, f64)> + '_ {
        let points = self.points.iter().filter(move |point| point.0 == load);
        points.map(|(_, amount, stress)| (*amount, *stress))
    }

    /// The amounts of a load, each once.
    pub(crate) fn amounts(&self, load: Load) -> Vec<f64> {
        let mut amounts: Vec<f64> = self.of(load).map(|(amount, _)| amount).collect();
        amounts.sort_by(f64::total_cmp);
        amounts.dedup();
        amounts
    }

    /// The misfit of a curve; `None` if nothing was measured under its load.
    pub(crate) fn misfit(&self, curve: &Curve) -> Option<Misfit> {
        let largest = self.of(curve.load).map(|(_, stress)| stress.abs());
        let largest = largest.fold(0.0, f64::max);
        // Squares of numbers of any size are numbers by this measure.
        let scale = if largest > 0.0 { largest } else { 1.0 };
        let (mut points, mut beyond, mut sum) = (0, 0, 0.0);
        for (amount, stress) in self.of(curve.load) {
            match curve.at(amount) {
                Some(found) => {
                    points += 1;
                    let difference = found / scale - stress / scale;
                    sum += difference * difference;
                }
                None => beyond += 1,
            }
        }
        (points + beyond > 0).then(|| Misfit {
            points,
            beyond,
            root_mean_square: scale * (sum / points as f64).sqrt(),
            largest,
        })
    }
}

fn point(line: &str) -> Result<(Load, f64, f64), MeasuredFault> {
    let entries: Vec<&str> = line.split(',').map(unquoted).collect();
    let [load, amount, stress] = entries[..] else {
        let found = entries.len();
        return Err(MeasuredFault::Count { found });
    };
    let load = Load::by_id(load).ok_or_else(|| MeasuredFault::Load {
        found: shortened(load),
    })?;
    let number = |text: &str, column, expected, fits: fn(f64) -> bool| {
        let number = text.parse().ok().filter(|number: &f64| number.is_finite());
        number
            .filter(|number| fits(*number))
            .ok_or_else(|| MeasuredFault::Number {
                column,
                found: shortened(text),
                expected,
            })
    };
    let amount = match load.is_shear() {
        true => number(amount, "shear", "a finite amount of shear", |_| true),
        false => number(
            amount,
            "stretch",
            "a finite stretch above 0, 1 at rest",
            |l| l > 0.0,
        ),
    }?;
    let stress = number(stress, "stress", "a finite nominal stress in Pa", |_| true)?;
    Ok((load, amount, stress))
}

/// An entry without surrounding spaces and quotation marks.
fn unquoted(entry: &str) -> &str {
    let entry = entry.trim();
    let inner = entry
        .strip_prefix('"')
        .and_then(|entry| entry.strip_suffix('"'));
    inner.map_or(entry, str::trim)
}

fn shortened(text: &str) -> String {
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}..", &text[..end]),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_read_with_comments_and_spaces() {
        let text = "# mine\n\nload, stretch, stress_Pa\nuniaxial, 1.5, 900\n# more\nsimple-shear,0.5,-3e2\n";
        let measured = Measured::parse(text).unwrap();
        assert_eq!(
            measured.points,
            [
                (Load::Uniaxial, 1.5, 900.0),
                (Load::SimpleShear, 0.5, -300.0)
            ]
        );
        assert_eq!(measured.stretches(), [1.0, 1.5]);
    }

    #[test]
    fn entries_in_quotation_marks_are_read() {
        let text = "\"load\",\"stretch\",\"stress\"\r\n\"planar\",\"1.5\",900\r\n";
        let measured = Measured::parse(text).unwrap();
        assert_eq!(measured.points, [(Load::Planar, 1.5, 900.0)]);
    }

    #[test]
    fn faults_are_named_with_their_line() {
        let said = |text: &str| {
            let (line, fault) = Measured::parse(text).unwrap_err();
            format!("{line:?} {fault}")
        };
        assert!(said("").starts_with("None expected at least one row"));
        assert!(said("load,stretch,stress_Pa\n").starts_with("None expected at least"));
        assert!(said("load,stretch,stress_kPa\n").starts_with("Some(1) the first line is"));
        assert!(said("uniaxial,1.1,5\n").starts_with("Some(1) the first line is"));
        let row = |row: &str| said(&format!("load,stretch,stress\n\n{row}\n"));
        assert!(row("uniaxial,1.1").starts_with("Some(3) expected 3 entries"));
        assert!(row("tension,1.1,5").starts_with("Some(3) load is \"tension\""));
        assert!(row("uniaxial,-1.1,5").starts_with("Some(3) stretch is \"-1.1\""));
        assert!(row("simple-shear,nan,5").starts_with("Some(3) shear is \"nan\""));
        assert!(row("planar,1.1,5 kPa").starts_with("Some(3) stress is \"5 kPa\""));
    }
}
