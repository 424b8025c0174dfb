//! A verification as text for a terminal.

use std::fmt;

use crate::check::Asked;
use crate::results::{Verification, VerifiedRow};
use crate::ruled;
use crate::verdict::MarkVerdict;

/// Significant digits of a figure.
const DIGITS: usize = 5;

impl fmt::Display for Asked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Value { value, tolerance } => {
                write!(f, "{} +- {}", shown(*value, DIGITS), shown(*tolerance, 2))
            }
            Self::AtMost { value } => write!(f, "at most {}", shown(*value, DIGITS)),
            Self::AtLeast { value } => write!(f, "at least {}", shown(*value, DIGITS)),
        }
    }
}

/// A number with the necessary significant digits, up to `digits`.
pub(crate) fn shown(x: f64, digits: usize) -> String {
    let rounded: f64 = format!("{x:.*e}", digits - 1).parse().unwrap_or(x);
    match rounded.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e6).contains(&size) => rounded.to_string(),
        _ => format!("{rounded:e}"),
    }
}

impl VerifiedRow {
    /// The figure as text, or the reason why it is absent.
    pub(crate) fn got_in_words(&self) -> String {
        match (&self.missing, self.got) {
            (Some(reason), _) => reason.clone(),
            (None, Some(got)) => shown(got, DIGITS),
            (None, None) => "n/a".to_owned(),
        }
    }

    /// The difference from the required figure, in units of the tolerance or as a share of the bound.
    pub(crate) fn of_tolerance(&self) -> Option<f64> {
        match self.asked {
            Asked::Value { value, tolerance } if tolerance > 0.0 => {
                Some((self.got? - value).abs() / tolerance)
            }
            _ => None,
        }
    }
}

impl fmt::Display for Verification {
    /// Every row.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for subject in &self.subjects {
            writeln!(f, "{}\n", subject.title)?;
            let rows = subject.rows.iter().map(|row| {
                [
                    row.verdict.word().to_owned(),
                    row.case.clone(),
                    row.figure.clone(),
                    row.asked.to_string(),
                    row.got_in_words(),
                ]
            });
            let head = ["", "case", "figure", "asked", "got"];
            writeln!(f, "{}\n", ruled::lines(ruled::table(head, rows, 3), 2))?;
        }
        write!(f, "{}", self.brief())
    }
}

impl Verification {
    /// Counts by subject, and the rows that fail.
    #[must_use]
    pub fn brief(&self) -> String {
        let rows = self.subjects.iter().map(|subject| {
            let fails = |row: &&VerifiedRow| row.verdict == MarkVerdict::Fail;
            let failed = subject.rows.iter().filter(fails).count();
            let nearest = subject.rows.iter().filter_map(VerifiedRow::of_tolerance);
            [
                if failed == 0 {
                    MarkVerdict::Pass
                } else {
                    MarkVerdict::Fail
                }
                .word()
                .to_owned(),
                subject.title.to_owned(),
                subject.rows.len().to_string(),
                failed.to_string(),
                format!("{:.0} %", 100.0 * nearest.fold(0.0, f64::max)),
            ]
        });
        let head = ["", "subject", "rows", "fail", "most of a tolerance"];
        let mut text = ruled::lines(ruled::table(head, rows, 2), 2);
        for (subject, row) in self.failures() {
            text.push_str(&format!(
                "\nFAIL {}: {}: {}: asked {}, got {}",
                subject.id,
                row.case,
                row.figure,
                row.asked,
                row.got_in_words()
            ));
        }
        text.push_str(&format!("\n\n{}", self.summary()));
        text
    }

    /// The verdict in a sentence.
    #[must_use]
    pub fn summary(&self) -> String {
        let (rows, failed) = (self.rows().count(), self.failures().count());
        let verdict = match failed {
            0 => format!("all {rows} rows pass"),
            _ => format!("{failed} of {rows} rows fail"),
        };
        match self.left_out {
            0 => verdict,
            long => format!("{verdict}; {long} that take long are left out (--long)"),
        }
    }
}
