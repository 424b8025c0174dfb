//! A run as a row.

use serde::Serialize;

/// Our name in tables.
pub(super) const PROGRAM: &str = "sinew";

/// Our method with which others are compared: single precision in fixed steps.
pub(super) const OWN: &str = "central-difference f32";

/// One run: a program with its own method, law and step.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SimulatorRow {
    /// The case: "pulled" or "pressed".
    pub case: String,
    /// Id of the law, also used for the fine run that defines the error.
    pub law: String,
    /// The program with its version.
    pub program: String,
    /// Its method.
    pub method: String,
    /// Step (s), the mean step if steps follow the stiffness.
    pub dt_s: f64,
    /// True if longer steps are unstable.
    pub is_limit: bool,
    /// Steps of the run.
    pub steps: usize,
    /// CPU time (s) of the steps for a simulated second, least of the laps.
    pub cpu_s_per_s: f64,
    /// Relative L2 error of the displacement over all instants.
    pub error: f64,
    /// The same at the last instant alone.
    pub error_at_end: f64,
}

impl SimulatorRow {
    /// True for runs of this program.
    #[must_use]
    pub fn is_ours(&self) -> bool {
        self.program.starts_with(PROGRAM)
    }
}
