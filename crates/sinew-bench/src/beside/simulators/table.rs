//! Runs of simulators as a table for readers.

use std::fmt;

use sinew_verify::ruled;

use super::results::SimulatorResults;
use super::row::SimulatorRow;
use crate::report::{milliseconds, percent, three};

pub(super) const HEAD: [&str; 8] = [
    "case",
    "law",
    "program",
    "method",
    "steps x dt\n[ms]",
    "CPU\n[s/s]",
    "error\n[%]",
    "error at\nthe end [%]",
];

/// Meaning of the rows.
pub(super) const MEANING: &str = "Each error is taken against a fine run of ours under the same law on the same mesh, so that programs with \
     different laws are not compared by their motion. Steps with a * are the longest stable ones of their method, found by halving; `dt auto` shows the \
     mean step. CPU is that of the steps for a simulated second, least of the laps, without building and compiling.";

impl SimulatorResults {
    /// The body and the method of measurement.
    pub(super) fn body(&self) -> String {
        format!(
            "Cube of 0.1 m, linear tetrahedra, 1060 kg/m3, E = 3500 Pa, nu = 0.45, undamped, bottom held, {} s from rest. \
             pulled: 600 Pa upwards on the top from t = 0 on; pressed: 300 Pa downwards. Relative L2 error of the displacement at {} instants; laps: {}; one thread. \
             Measured on {}.",
            self.duration_s, self.instants, self.laps, self.machine.cpu
        )
    }
}

impl fmt::Display for SimulatorResults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}\n{MEANING}", self.body())?;
        for versions in &self.versions {
            writeln!(f, "{versions}")?;
        }
        let table = ruled::table(HEAD, self.rows.iter().map(cells), 4);
        writeln!(f, "\n{}\n", ruled::lines(table, 2))?;
        for ratio in self.ratios() {
            writeln!(f, "{ratio}")?;
        }
        for missing in &self.missing {
            writeln!(f, "missing: {missing}")?;
        }
        Ok(())
    }
}

pub(super) fn cells(row: &SimulatorRow) -> [String; 8] {
    let limit = if row.is_limit { "*" } else { "" };
    [
        row.case.clone(),
        row.law.clone(),
        row.program.clone(),
        row.method.clone(),
        format!("{limit}{} x {}", row.steps, milliseconds(row.dt_s)),
        three(row.cpu_s_per_s),
        percent(row.error),
        percent(row.error_at_end),
    ]
}

#[cfg(test)]
mod tests {
    use super::super::row::OWN;
    use super::*;
    use sinew_verify::Machine;

    fn row(program: &str, method: &str, cpu_s_per_s: f64, error: f64) -> SimulatorRow {
        SimulatorRow {
            case: "pulled".into(),
            law: "stvk".into(),
            program: program.into(),
            method: method.into(),
            dt_s: 2e-3,
            is_limit: program == "X 1.0",
            steps: 250,
            cpu_s_per_s,
            error,
            error_at_end: 2.0 * error,
        }
    }

    fn results() -> SimulatorResults {
        SimulatorResults {
            revision: "r".into(),
            machine: Machine {
                cpu: "a processor".into(),
                ..sinew_verify::machine()
            },
            duration_s: 0.5,
            instants: 10,
            laps: 3,
            versions: vec!["X 1.0, Python 3.11".into()],
            rows: vec![
                row("X 1.0", "Euler", 0.4, 0.03),
                row("sinew 0.1.0", OWN, 0.1, 0.01),
            ],
            missing: vec!["Y: no wheel".into()],
        }
    }

    #[test]
    fn a_row_has_cost_and_errors_and_a_ratio_follows() {
        let text = results().to_string();
        let line = text.lines().find(|line| line.contains("Euler")).unwrap();
        let cells: Vec<&str> = line.split_whitespace().collect();
        assert_eq!(
            cells,
            [
                "pulled", "stvk", "X", "1.0", "Euler", "*250", "x", "2", "0.400", "3.00", "6.00"
            ]
        );
        assert!(
            text.contains(
                "pulled, stvk: X 1.0 Euler has 3.0 times the error of our central-difference f32 at 4.0 times its CPU time"
            ),
            "{text}"
        );
        assert!(text.contains("missing: Y: no wheel") && text.contains("on a processor."));
    }

    #[test]
    fn the_page_has_the_rows_and_the_versions() {
        let page = results().html();
        for part in [
            "X 1.0, Python 3.11",
            "*250 x 2",
            "Y: no wheel",
            "3.0 times the error",
        ] {
            assert!(page.contains(part), "{part}");
        }
    }
}
