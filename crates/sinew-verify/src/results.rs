//! Results of a verification.

use serde::Serialize;

use crate::check::{Asked, Source};
use crate::machine::Machine;
use crate::subject::Quoted;
use crate::verdict::MarkVerdict;

/// Version of the format of `verification.json`.
pub const SCHEMA: u32 = 1;

/// A whole verification: the content of `verification.json`.
#[derive(Clone, Debug, Serialize)]
pub struct Verification {
    /// Version of the format, [`SCHEMA`].
    pub schema: u32,
    /// Revision of the source that ran.
    pub revision: String,
    /// The machine that it ran on.
    pub machine: Machine,
    /// The subjects, in the order of the page.
    pub subjects: Vec<VerifiedSubject>,
    /// Rows that were skipped because they take long.
    pub left_out: usize,
}

/// A subject and its rows.
#[derive(Clone, Debug, Serialize)]
pub struct VerifiedSubject {
    /// Its short name.
    pub id: &'static str,
    /// Its heading.
    pub title: &'static str,
    /// Method by which its figures are computed.
    pub says: &'static str,
    /// A row for each figure.
    pub rows: Vec<VerifiedRow>,
    /// Figures from other sources, which are not computed.
    #[serde(skip_serializing_if = "<[Quoted]>::is_empty")]
    pub quoted: &'static [Quoted],
}

/// A required figure of the library, and the computed one.
#[derive(Clone, Debug, Serialize)]
pub struct VerifiedRow {
    /// The case.
    pub case: String,
    /// The figure, with its unit.
    pub figure: String,
    /// Requirement for the figure.
    pub asked: Asked,
    /// The figure; none if it could not be computed or is not finite.
    pub got: Option<f64>,
    /// Reason why the figure is absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub missing: Option<String>,
    /// The source of the required figure.
    pub source: Source,
    /// Verdict.
    pub verdict: MarkVerdict,
    /// A remark.
    #[serde(skip_serializing_if = "str::is_empty")]
    pub note: &'static str,
    /// Wall time (s) of the computation, which may also have given other figures.
    pub seconds: f64,
}

impl Verification {
    /// All rows with the titles of their subjects.
    pub fn rows(&self) -> impl Iterator<Item = (&VerifiedSubject, &VerifiedRow)> {
        let subjects = self.subjects.iter();
        subjects.flat_map(|subject| subject.rows.iter().map(move |row| (subject, row)))
    }

    /// The rows that fail.
    pub fn failures(&self) -> impl Iterator<Item = (&VerifiedSubject, &VerifiedRow)> {
        self.rows()
            .filter(|(_, row)| row.verdict == MarkVerdict::Fail)
    }
}
