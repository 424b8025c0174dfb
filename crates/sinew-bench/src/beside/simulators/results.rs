//! All runs, with the programs and versions that produced them.

use serde::Serialize;
use sinew_verify::Machine;

use super::row::{OWN, SimulatorRow};
use crate::report::two;

/// Runs of other simulators and of ours.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SimulatorResults {
    /// Revision of the code.
    pub revision: String,
    /// The computer.
    pub machine: Machine,
    /// Simulated time (s).
    pub duration_s: f64,
    /// Instants at which errors are taken, equally spaced, the last at the end.
    pub instants: usize,
    /// Laps of each run.
    pub laps: usize,
    /// Versions of each program and of the libraries that it uses.
    pub versions: Vec<String>,
    /// The runs.
    pub rows: Vec<SimulatorRow>,
    /// Requested programs without rows, with the reason.
    pub missing: Vec<String>,
}

impl SimulatorResults {
    /// Our run with which another one is compared, of the same case and law.
    fn own(&self, other: &SimulatorRow) -> Option<&SimulatorRow> {
        let mut rows = self.rows.iter();
        rows.find(|row| row.case == other.case && row.law == other.law && row.method == OWN)
    }

    /// Errors and costs relative to ours, one sentence for each run of another program.
    #[must_use]
    pub fn ratios(&self) -> Vec<String> {
        let others = self.rows.iter().filter(|row| !row.is_ours());
        let sentence = |row: &SimulatorRow| {
            let own = self.own(row)?;
            Some(format!(
                "{}, {}: {} {} has {} times the error of our {} at {} times its CPU time",
                row.case,
                row.law,
                row.program,
                row.method,
                two(row.error / own.error),
                own.method,
                two(row.cpu_s_per_s / own.cpu_s_per_s),
            ))
        };
        others.filter_map(sentence).collect()
    }
}
