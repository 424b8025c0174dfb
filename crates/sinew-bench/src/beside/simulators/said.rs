//! Lines that scripts of other simulators print.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;
use serde_json::Value;
use sinew_verify::LabError;

use super::cube::{CubeBody, DURATION, INSTANTS};
use super::row::SimulatorRow;

/// A line that a script should not print.
#[derive(Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SaidError {
    /// A line that cannot be read.
    #[error("{script}, line {line}: `{text}`: {reason}")]
    Line {
        /// The script.
        script: String,
        /// The number of the line, from 1 on.
        line: usize,
        /// Its beginning.
        text: String,
        /// Reason for which it is refused.
        reason: String,
    },
    /// Output that ends too early.
    #[error("{script} printed no {what}")]
    Without {
        /// The script.
        script: String,
        /// Kind of line that it did not print.
        what: &'static str,
    },
}

/// All output of a script.
#[derive(Clone, Debug, PartialEq)]
pub struct Said {
    /// Versions of the program, and of the libraries that it uses, by name; the program first.
    versions: Vec<(String, String)>,
    /// Its runs.
    pub(super) runs: Vec<SaidRun>,
}

/// A run of another program.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SaidRun {
    /// The case.
    pub case: String,
    /// The program's own method.
    pub method: String,
    /// The law, by our id.
    pub law: String,
    /// Step (s).
    pub dt_s: f64,
    /// True if longer steps are unstable.
    pub is_limit: bool,
    /// Number of steps.
    pub steps: usize,
    /// CPU time (s) of all steps.
    pub cpu_s: f64,
    /// The file with the displacements.
    pub file: String,
}

impl Said {
    /// Reads what a script printed; `program` is the name of the program among the versions.
    ///
    /// # Errors
    /// [`SaidError`] for the first line that differs from the scripts' documentation.
    pub fn read(script: &str, program: &str, text: &str) -> Result<Self, SaidError> {
        let mut versions: Option<BTreeMap<String, String>> = None;
        let mut runs = Vec::new();
        for (index, line) in text.lines().enumerate() {
            let bad = |reason: String| SaidError::Line {
                script: script.to_owned(),
                line: index + 1,
                text: line.chars().take(60).collect(),
                reason,
            };
            let mut value: Value =
                serde_json::from_str(line).map_err(|error| bad(error.to_string()))?;
            match value.get_mut("versions").map(Value::take) {
                Some(said) => {
                    let said = serde_json::from_value(said);
                    versions = Some(said.map_err(|error| bad(error.to_string()))?);
                }
                None => {
                    let run: SaidRun =
                        serde_json::from_value(value).map_err(|error| bad(error.to_string()))?;
                    run.check().map_err(|reason| bad(reason.to_owned()))?;
                    runs.push(run);
                }
            }
        }
        let without = |what| SaidError::Without {
            script: script.to_owned(),
            what,
        };
        let mut versions = versions.ok_or_else(|| without("versions"))?;
        let own = versions.remove(program);
        let own = own.ok_or_else(|| without("version of its program"))?;
        if runs.is_empty() {
            return Err(without("run"));
        }
        let mut all = vec![(program.to_owned(), own)];
        all.extend(versions);
        Ok(Self {
            versions: all,
            runs,
        })
    }

    /// All versions in a line.
    pub(super) fn versions(&self) -> String {
        let versions = self.versions.iter();
        let versions = versions.map(|(name, version)| format!("{name} {version}"));
        versions.collect::<Vec<_>>().join(", ")
    }

    /// The program with its version.
    fn program(&self) -> String {
        let program = self.versions.first();
        program.map_or_else(String::new, |(name, version)| format!("{name} {version}"))
    }

    /// The row of a run, without errors.
    pub(super) fn row(&self, run: &SaidRun) -> SimulatorRow {
        SimulatorRow {
            case: run.case.clone(),
            law: run.law.clone(),
            program: self.program(),
            method: run.method.clone(),
            dt_s: run.dt_s,
            is_limit: run.is_limit,
            steps: run.steps,
            cpu_s_per_s: run.cpu_s / DURATION,
            error: f64::NAN,
            error_at_end: f64::NAN,
        }
    }

    /// Displacements (m) of all nodes at the instants.
    pub(super) fn motion(
        &self,
        run: &SaidRun,
        folder: &Path,
        body: &CubeBody,
    ) -> Result<Vec<Vec<f64>>, LabError> {
        let path = folder.join(&run.file);
        let wrong = |what: String| LabError::new(format!("{}: {what}", path.display()));
        let bytes = std::fs::read(&path).map_err(|error| wrong(error.to_string()))?;
        let (numbers, rest) = bytes.as_chunks();
        let expected = INSTANTS * 3 * body.nodes;
        if numbers.len() != expected || !rest.is_empty() {
            return Err(wrong(format!(
                "{} bytes instead of {}",
                bytes.len(),
                8 * expected
            )));
        }
        let numbers: Vec<f64> = numbers.iter().map(|&n| f64::from_le_bytes(n)).collect();
        if !numbers.iter().all(|number| number.is_finite()) {
            return Err(wrong("not all numbers are finite".to_owned()));
        }
        Ok(numbers
            .chunks(3 * body.nodes)
            .map(<[f64]>::to_vec)
            .collect())
    }
}

impl SaidRun {
    /// True for the case and the law of a body.
    pub(super) fn is_of(&self, body: &CubeBody) -> bool {
        self.case == body.case && self.law == body.law
    }

    fn check(&self) -> Result<(), &'static str> {
        let is_positive = |number: f64| number.is_finite() && number > 0.0;
        if !is_positive(self.dt_s) || !is_positive(self.cpu_s) || self.steps == 0 {
            return Err("step, CPU time and number of steps are to be above 0");
        }
        let covered = self.dt_s * self.steps as f64;
        if (covered - DURATION).abs() > 1e-6 * DURATION {
            return Err("its steps do not cover the simulated time");
        }
        let path = Path::new(&self.file);
        match path
            .file_name()
            .is_some_and(|name| name == path.as_os_str())
        {
            true => Ok(()),
            false => Err("`file` is to be a name without folders"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VERSIONS: &str = r#"{"versions": {"Python": "3.11.7", "X": "1.8.0"}}"#;
    const RUN: &str = r#"{"case": "pulled", "method": "Euler", "law": "stvk", "dt_s": 0.001, "is_limit": true, "steps": 500, "cpu_s": 0.2, "file": "x.f64"}"#;

    fn read(lines: &[&str]) -> Result<Said, SaidError> {
        Said::read("x_cube.py", "X", &lines.join("\n"))
    }

    #[test]
    fn versions_and_runs_become_rows() {
        let said = read(&[VERSIONS, RUN]).unwrap();
        assert_eq!(said.versions(), "X 1.8.0, Python 3.11.7");
        let row = said.row(&said.runs[0]);
        assert_eq!((row.program.as_str(), row.steps), ("X 1.8.0", 500));
        assert_eq!((row.method.as_str(), row.law.as_str()), ("Euler", "stvk"));
        assert!((row.cpu_s_per_s - 0.4).abs() < 1e-12 && row.is_limit);
    }

    #[test]
    fn each_bad_line_gives_one_clear_error() {
        for (line, expected) in [
            ("Warp 1.19.0 initialized", "expected value"),
            (r#"{"case": "pulled"}"#, "missing field `method`"),
            (&RUN.replace("0.2", "NaN"), "expected value"),
            (&RUN.replace("0.2", "0"), "above 0"),
            (&RUN.replace("0.2", "\"fast\""), "expected f64"),
            (
                &RUN.replace("500", "400"),
                "do not cover the simulated time",
            ),
            (&RUN.replace("x.f64", "../x.f64"), "without folders"),
            (&RUN.replace("is_limit", "limit"), "unknown field `limit`"),
            ("[1, 2]", "invalid type"),
            ("", "EOF"),
            (r#"{"versions": 4}"#, "expected a map"),
        ] {
            let error = read(&[VERSIONS, line, RUN]).unwrap_err().to_string();
            assert!(error.starts_with("x_cube.py, line 2: `"), "{error}");
            assert!(error.contains(expected), "{error}");
            assert_eq!(error.lines().count(), 1, "{error}");
        }
    }

    #[test]
    fn output_that_ends_too_early_says_what_is_missing() {
        let error = |lines: &[&str]| read(lines).unwrap_err().to_string();
        assert_eq!(error(&[RUN]), "x_cube.py printed no versions");
        assert_eq!(error(&[VERSIONS]), "x_cube.py printed no run");
        let other = VERSIONS.replace("\"X\"", "\"Y\"");
        assert!(error(&[&other, RUN]).contains("no version of its program"));
    }

    #[test]
    fn displacements_of_another_size_are_refused() {
        let cube = super::super::cube::SharedCube::new(true).unwrap();
        let body = &cube.bodies[0];
        let said = read(&[VERSIONS, RUN]).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let motion = || said.motion(&said.runs[0], folder.path(), body);
        assert!(motion().unwrap_err().to_string().contains("x.f64"));
        let write = |numbers: &[f64]| {
            let bytes: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
            std::fs::write(folder.path().join("x.f64"), bytes).unwrap();
        };
        let size = INSTANTS * 3 * body.nodes;
        write(&vec![0.5; size]);
        assert_eq!(motion().unwrap().len(), INSTANTS);
        write(&vec![0.5; size - 1]);
        let said = motion().unwrap_err().to_string();
        assert!(said.contains("bytes instead of"), "{said}");
        write(&vec![f64::NAN; size]);
        assert!(motion().unwrap_err().to_string().contains("finite"));
    }
}
