//! Results of a bench: the content of `results.json`.
//!
//! JSON has no NaN and no infinity. An optional figure is an `Option`; any other number that is not finite is written
//! as `null`, read as NaN, and named with its reason in the list `missing`, so that only this number is lost.

use serde::{Deserialize, Serialize};
use sinew_measure::{CaseInfo, Row};
use sinew_verify::{Machine, MarkVerdict};

mod json;
mod mark;
mod missing;
mod stability_map;

pub use json::ResultsError;
pub use mark::Mark;
pub use missing::Missing;
pub use stability_map::{MapPanel, MapRun, StabilityMap};

/// Version of the format this crate writes and reads.
pub const SCHEMA: u32 = 1;

/// A whole bench.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BenchResults {
    /// Version of the format, [`SCHEMA`].
    pub schema: u32,
    /// Revision of the source that ran.
    pub revision: String,
    /// The subject of the page, if it is not the cost of accuracy.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub subject: Option<String>,
    /// Date of the run, as the caller wishes to write it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub date: Option<String>,
    /// The machine that it ran on.
    pub machine: Machine,
    /// The cases, in the order of the report.
    pub cases: Vec<CaseInfo>,
    /// One row per run.
    pub rows: Vec<Row>,
    /// Requested runs that were not executed.
    #[serde(default)]
    pub skipped: Vec<Skipped>,
    /// Missing scenes and maps. The written file also lists the numbers that cannot be shown;
    /// [`BenchResults::all_missing`] returns both.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub missing: Vec<Missing>,
    /// Pass marks of hard cases.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub marks: Vec<Mark>,
    /// Stability maps.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub maps: Vec<StabilityMap>,
}

/// A requested run that was not executed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Skipped {
    /// Id of the case.
    pub case: String,
    /// Id of the integrator, or its label with options.
    pub integrator: String,
    /// Step (s).
    pub dt: f64,
    /// Reason why it was not executed.
    pub reason: String,
}

impl BenchResults {
    /// Results without rows.
    #[must_use]
    pub fn new(revision: impl Into<String>, machine: Machine) -> Self {
        Self {
            schema: SCHEMA,
            revision: revision.into(),
            subject: None,
            date: None,
            machine,
            cases: Vec::new(),
            rows: Vec::new(),
            skipped: Vec::new(),
            missing: Vec::new(),
            marks: Vec::new(),
            maps: Vec::new(),
        }
    }

    /// The marks that failed.
    pub fn failed_marks(&self) -> impl Iterator<Item = &Mark> {
        let failed = |mark: &&Mark| mark.verdict == MarkVerdict::Fail;
        self.marks.iter().filter(failed)
    }

    /// The rows of a case, in their order.
    pub fn rows_of<'a>(&'a self, case: &'a str) -> impl Iterator<Item = &'a Row> {
        self.rows.iter().filter(move |row| row.case == case)
    }

    /// Ids of the cases: those with a description, then those that appear only in rows.
    #[must_use]
    pub fn case_ids(&self) -> Vec<&str> {
        let described = self.cases.iter().map(|case| case.id.as_str());
        let named = self.rows.iter().map(|row| row.case.as_str());
        let mut ids = Vec::new();
        for id in described.chain(named) {
            if !ids.contains(&id) {
                ids.push(id);
            }
        }
        ids
    }

    /// The description of a case.
    #[must_use]
    pub fn case(&self, id: &str) -> Option<&CaseInfo> {
        self.cases.iter().find(|case| case.id == id)
    }
}

impl BenchResults {
    /// The missing results: those found during the bench, and every number that cannot be shown.
    #[must_use]
    pub fn all_missing(&self) -> Vec<Missing> {
        let mut all = self.missing.clone();
        let of_cases = self.cases.iter().flat_map(|case| {
            let gaps = case.gaps().into_iter();
            gaps.map(|gap| Missing::number(&case.id, None, gap))
        });
        let of_rows = self.rows.iter().flat_map(|row| {
            let name = format!("{}, dt = {} s", row.label(), row.dt);
            let gaps = row.gaps().into_iter();
            gaps.map(move |gap| Missing::number(&row.case, Some(name.clone()), gap))
        });
        for missing in of_cases.chain(of_rows) {
            // Numbers that were missing when the results were written are reported once.
            let known = |other: &Missing| {
                (&other.scene, &other.row, &other.field)
                    == (&missing.scene, &missing.row, &missing.field)
            };
            if !all.iter().any(known) {
                all.push(missing);
            }
        }
        all
    }
}
