//! Results as JSON, which has no NaN and no infinity.

use serde::Deserialize;
use sinew_measure::{CaseInfo, Outcome, Row};

use super::{BenchResults, SCHEMA};

/// Why results cannot be written as, or read from, JSON.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ResultsError {
    /// A number that JSON cannot hold.
    #[error("{of}: {field} is {value}, which JSON cannot hold")]
    NotFinite {
        /// The case or the run.
        of: String,
        /// The field.
        field: &'static str,
        /// Its value.
        value: f64,
    },
    /// A run that finished must have an error.
    #[error("{of}: finished without an error")]
    FinishedWithoutError {
        /// The run.
        of: String,
    },
    /// Another version of the format.
    #[error("results have schema {found}, this program knows {SCHEMA}")]
    Schema {
        /// The version found.
        found: u32,
    },
    /// Not the JSON of a bench.
    #[error("not the results of a bench: {0}")]
    Json(#[from] serde_json::Error),
}

impl BenchResults {
    /// Pretty JSON with a final newline.
    ///
    /// # Errors
    /// [`ResultsError`] when a number is not finite or a finished run has no error.
    pub fn to_json(&self) -> Result<String, ResultsError> {
        self.check()?;
        let mut json = serde_json::to_string_pretty(self)?;
        json.push('\n');
        Ok(json)
    }

    /// Reads what [`Self::to_json`] wrote.
    ///
    /// # Errors
    /// [`ResultsError`] when it is not JSON, not a bench, or of another schema.
    pub fn from_json(json: &str) -> Result<Self, ResultsError> {
        #[derive(Deserialize)]
        struct Version {
            schema: u32,
        }
        let Version { schema: found } = serde_json::from_str(json)?;
        if found != SCHEMA {
            return Err(ResultsError::Schema { found });
        }
        Ok(serde_json::from_str(json)?)
    }

    fn check(&self) -> Result<(), ResultsError> {
        for case in &self.cases {
            check_finite(case_numbers(case), || format!("case {}", case.id))?;
        }
        for row in &self.rows {
            let name = || format!("{}, {}, dt = {} s", row.case, row.label(), row.dt);
            check_finite(
                required_numbers(row).map(|(field, x)| (field, Some(x))),
                name,
            )?;
            check_finite(optional_numbers(row), name)?;
            if row.outcome == Outcome::Finished && row.error.is_none() {
                return Err(ResultsError::FinishedWithoutError { of: name() });
            }
        }
        for run in &self.skipped {
            check_finite([("dt", Some(run.dt))], || {
                format!("skipped {}, {}", run.case, run.integrator)
            })?;
        }
        Ok(())
    }
}

fn required_numbers(row: &Row) -> [(&'static str, f64); 6] {
    [
        ("dt", row.dt),
        ("sweeps_per_s", row.sweeps_per_s),
        ("saturated", row.saturated),
        ("cpu_s_per_s", row.cpu_s_per_s),
        ("us_per_step", row.us_per_step),
        ("setup_cpu_s", row.setup_cpu_s),
    ]
}

fn optional_numbers(row: &Row) -> [(&'static str, Option<f64>); 7] {
    [
        ("error", row.error),
        ("max_u", row.max_u),
        ("late_amplitude", row.late_amplitude),
        ("diverged_at_s", row.diverged_at_s),
        ("step_over_critical", row.step_over_critical),
        ("static_error", row.static_error),
        ("energy_drift", row.energy_drift),
    ]
}

fn case_numbers(case: &CaseInfo) -> [(&'static str, Option<f64>); 5] {
    [
        ("duration_s", Some(case.duration_s)),
        ("reference_error", Some(case.reference_error)),
        ("max_u_m", Some(case.max_u_m)),
        ("late_amplitude_m", Some(case.late_amplitude_m)),
        ("critical_step_s", case.critical_step_s),
    ]
}

fn check_finite<const N: usize>(
    numbers: [(&'static str, Option<f64>); N],
    of: impl Fn() -> String,
) -> Result<(), ResultsError> {
    for (field, value) in numbers {
        if let Some(value) = value.filter(|x| !x.is_finite()) {
            return Err(ResultsError::NotFinite {
                of: of(),
                field,
                value,
            });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use serde_json::{Value, json};

    use super::*;
    use crate::results::{Machine, Skipped};
    use sinew_measure::{Verdict, Work, finite};

    fn row() -> Row {
        Row {
            case: "paper-cube".into(),
            integrator: "cnn".into(),
            options: BTreeMap::from([("saturation".into(), json!(4.0))]),
            dt: 0.02,
            steps: 50,
            sweeps_per_s: 50.0,
            bounded: true,
            error: Some(25.2),
            max_u: Some(0.160),
            late_amplitude: Some(0.080),
            saturated: 0.766,
            guarded: true,
            inverted: 1676,
            work: Work {
                sweeps: 50,
                ..Work::default()
            },
            cpu_s_per_s: 0.0009,
            us_per_step: 18.9,
            ..Row::default()
        }
    }

    fn results(rows: Vec<Row>) -> BenchResults {
        let mut results = BenchResults::new("abc", Machine::default());
        results.rows = rows;
        results
    }

    #[test]
    fn json_round_trip() {
        let mut written = results(vec![
            row(),
            Row {
                outcome: Outcome::Diverged,
                diverged_at_s: Some(0.34),
                error: None,
                max_u: None,
                late_amplitude: None,
                ..row()
            },
        ]);
        written.date = Some("2026-11-20".into());
        written.cases.push(CaseInfo {
            id: "paper-cube".into(),
            critical_step_s: Some(7.9e-3),
            ..CaseInfo::default()
        });
        written.skipped.push(Skipped {
            case: "paper-cube".into(),
            integrator: "modal".into(),
            dt: 0.02,
            reason: "no modes".into(),
        });
        let json = written.to_json().unwrap();
        assert_eq!(BenchResults::from_json(&json).unwrap(), written);
    }

    #[test]
    fn a_row_reads_as_documented() {
        let json = r#"{ "case": "paper-cube", "integrator": "cnn", "options": { "saturation": 4.0 },
            "dt": 0.02, "steps": 50, "sweeps_per_s": 50.0, "outcome": "finished", "bounded": true,
            "settles": false, "error": 25.2, "max_u": 0.160, "late_amplitude": 0.080,
            "saturated": 0.766, "inverted": 1676,
            "work": { "sweeps": 50, "solves": 0, "factorizations": 0 },
            "cpu_s_per_s": 0.0009, "us_per_step": 18.9, "pareto": false }"#;
        let read: Row = serde_json::from_str(json).unwrap();
        let expected = Row {
            guarded: false,
            ..row()
        };
        assert_eq!(read, expected);
        assert_eq!(read.verdict(), Verdict::Guarded);
    }

    #[test]
    fn numbers_that_are_missing_are_null_and_none_is_nan() {
        let diverged = Row {
            outcome: Outcome::Diverged,
            error: None,
            max_u: finite(f64::INFINITY),
            late_amplitude: finite(f64::NAN),
            ..row()
        };
        let json = results(vec![diverged]).to_json().unwrap();
        let value: Value = serde_json::from_str(&json).unwrap();
        for field in ["error", "max_u", "late_amplitude"] {
            assert_eq!(value["rows"][0][field], Value::Null, "{field}");
        }
        assert!(!json.contains("NaN") && !json.contains("inf"));
    }

    #[test]
    fn a_number_that_is_not_finite_is_refused_by_name() {
        let bad = Row {
            cpu_s_per_s: f64::NAN,
            ..row()
        };
        let message = results(vec![bad]).to_json().unwrap_err().to_string();
        assert_eq!(
            message,
            "paper-cube, cnn Q=4, dt = 0.02 s: cpu_s_per_s is NaN, which JSON cannot hold"
        );
        let bad = Row {
            max_u: Some(f64::INFINITY),
            ..row()
        };
        assert!(results(vec![bad]).to_json().is_err());
    }

    #[test]
    fn a_finished_run_has_an_error() {
        let bad = Row {
            error: None,
            ..row()
        };
        assert!(matches!(
            results(vec![bad]).to_json(),
            Err(ResultsError::FinishedWithoutError { .. })
        ));
    }

    #[test]
    fn another_schema_is_refused() {
        let json = results(vec![])
            .to_json()
            .unwrap()
            .replace("\"schema\": 1", "\"schema\": 2");
        assert!(matches!(
            BenchResults::from_json(&json),
            Err(ResultsError::Schema { found: 2 })
        ));
    }
}
