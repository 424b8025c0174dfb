//! Results as JSON, which has no NaN and no infinity.

use serde::Deserialize;

use super::{BenchResults, SCHEMA};

/// Reasons why results cannot be written as JSON or read from it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ResultsError {
    /// Another version of the format.
    #[error("results have schema {found}, this program knows {SCHEMA}")]
    Schema {
        /// The version found.
        found: u32,
    },
    /// The text is not the JSON of a bench.
    #[error("not the results of a bench: {0}")]
    Json(#[from] serde_json::Error),
}

impl BenchResults {
    /// Pretty JSON with a final newline. Numbers that are not finite are `null`, and named in
    /// `missing`.
    ///
    /// # Errors
    /// [`ResultsError::Json`], which is not known to occur.
    pub fn to_json(&self) -> Result<String, ResultsError> {
        let written = Self {
            missing: self.all_missing(),
            ..self.clone()
        };
        let mut json = serde_json::to_string_pretty(&written)?;
        json.push('\n');
        Ok(json)
    }

    /// Reads the output of [`Self::to_json`].
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
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use serde_json::{Value, json};

    use super::*;
    use crate::results::Skipped;
    use sinew_measure::{CaseInfo, Row, RowOutcome, RowVerdict, Work, finite};
    use sinew_verify::Machine;

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
                outcome: RowOutcome::Diverged,
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
        assert_eq!(read.verdict(), RowVerdict::Guarded);
    }

    #[test]
    fn numbers_that_are_missing_are_null_and_none_is_nan() {
        let diverged = Row {
            outcome: RowOutcome::Diverged,
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
    fn a_number_that_is_not_finite_is_null_and_named_with_its_reason() {
        let bad = Row {
            cpu_s_per_s: f64::NAN,
            max_u: Some(f64::INFINITY),
            error: None,
            ..row()
        };
        let mut written = results(vec![row(), bad]);
        written.cases.push(CaseInfo {
            id: "paper-cube".into(),
            max_u_m: f64::INFINITY,
            ..CaseInfo::default()
        });
        let json = written.to_json().unwrap();
        let value: Value = serde_json::from_str(&json).unwrap();
        assert_eq!(value["cases"][0]["max_u_m"], Value::Null);
        assert_eq!(value["rows"][1]["cpu_s_per_s"], Value::Null);
        assert_eq!(value["rows"][0]["cpu_s_per_s"], 0.0009);
        let not_finite = "it is not a finite number";
        let run = "cnn Q=4, dt = 0.02 s";
        assert_eq!(
            value["missing"],
            json!([
                { "scene": "paper-cube", "field": "max_u_m", "value": "inf", "reason": not_finite },
                { "scene": "paper-cube", "row": run, "field": "error",
                  "reason": "the run finished and no finite number came of it" },
                { "scene": "paper-cube", "row": run, "field": "max_u", "value": "inf",
                  "reason": not_finite },
                { "scene": "paper-cube", "row": run, "field": "cpu_s_per_s", "value": "NaN",
                  "reason": not_finite },
            ])
        );

        // Read again, it tells the same.
        let read = BenchResults::from_json(&json).unwrap();
        assert!(read.cases[0].max_u_m.is_nan() && read.rows[1].cpu_s_per_s.is_nan());
        assert_eq!(read.all_missing(), written.all_missing());
        assert_eq!(read.to_json().unwrap(), json);
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
