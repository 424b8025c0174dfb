//! A row: a run with its error, its verdicts, its work and its cost.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::number;

mod gaps;
mod label;
mod pareto;

pub use gaps::Gap;
pub(crate) use label::label;
pub use pareto::mark_pareto;

/// Largest relative error that is called accurate.
pub const ACCURATE: f64 = 0.05;

/// A case and the reference its runs are measured against.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CaseInfo {
    /// Id, as in `paper-cube`.
    pub id: String,
    /// Title for people.
    pub title: String,
    /// Remarks for people.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub remarks: Vec<String>,
    /// Free degrees of freedom.
    pub dofs: usize,
    /// Simulated time (s).
    #[serde(deserialize_with = "gaps::null_is_nan")]
    pub duration_s: f64,
    /// Description of the method of the reference.
    pub reference: String,
    /// The reference's own estimated relative error (fraction).
    #[serde(deserialize_with = "gaps::null_is_nan")]
    pub reference_error: f64,
    /// Largest |component| of the displacement in the reference (m).
    #[serde(deserialize_with = "gaps::null_is_nan")]
    pub max_u_m: f64,
    /// Half the range of the reference's worst dof over the last fifth of the run (m).
    #[serde(deserialize_with = "gaps::null_is_nan")]
    pub late_amplitude_m: f64,
    /// Critical step `2 / omega_max` of the undamped system (s); none if omega_max is absent.
    #[serde(default)]
    pub critical_step_s: Option<f64>,
    /// The largest stable step of each method that ran and has one (s), by its label.
    #[serde(
        default,
        skip_serializing_if = "BTreeMap::is_empty",
        deserialize_with = "gaps::nulls_are_nan"
    )]
    pub stable_steps_s: BTreeMap<String, f64>,
}

/// One run: a case, an integrator with its options, a step. A number that cannot be represented is NaN; [`Row::gaps`]
/// names them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Id of the case.
    pub case: String,
    /// Id of the integrator.
    pub integrator: String,
    /// The body's law and element, if runs of a case differ in them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// Options that differ from the integrator's defaults.
    #[serde(default)]
    pub options: BTreeMap<String, Value>,
    /// The machine, precision and instructions that ran its program; none for a method with its own loops.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kernel: Option<String>,
    /// Step (s).
    #[serde(deserialize_with = "gaps::null_is_nan")]
    pub dt: f64,
    /// Steps taken.
    pub steps: u64,
    /// Sweeps per simulated second (1/s).
    #[serde(deserialize_with = "gaps::null_is_nan")]
    pub sweeps_per_s: f64,
    /// End of the run.
    pub outcome: RowOutcome,
    /// Simulated time at which the run was stopped (s); only when diverged or refused.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diverged_at_s: Option<f64>,
    /// The reason for which a step was refused; only when refused.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refusal: Option<String>,
    /// Every displacement is finite and at most ten times the largest of the reference.
    pub bounded: bool,
    /// The motion dies out if that of the reference does.
    pub settles: bool,
    /// Relative L2 error of the displacement (fraction, 1 = as wrong as returning zero); none only
    /// when diverged or refused.
    pub error: Option<f64>,
    /// Bound (fraction) below which the error lies, if the reference cannot measure one so small: a hundred times its
    /// own error. `error` is then the difference from the reference and should not be quoted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error_is_below: Option<f64>,
    /// Relative L2 error (fraction) of the forces on tools, means over the time between two instants; for bodies in
    /// contact with tools.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_error: Option<f64>,
    /// Relative L2 error to expect over the whole scene (fraction), with phase errors that continue to grow and without
    /// later changes of loads, never less than the measured error; only if just a first part of the scene was compared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expected_error: Option<f64>,
    /// Largest |component| of the displacement over the run (m); `None` if not finite.
    pub max_u: Option<f64>,
    /// Half the range of the worst dof over the last fifth of the steps (m); `None` if not finite.
    pub late_amplitude: Option<f64>,
    /// Share of the (dof, step) pairs that were saturated (fraction).
    #[serde(deserialize_with = "gaps::null_is_nan")]
    pub saturated: f64,
    /// Some cells were saturated: limited by the guard, not by the physics.
    #[serde(default)]
    pub guarded: bool,
    /// Inverted elements in the last state.
    pub inverted: u64,
    /// Largest depth (m) to which parts or surfaces of the body penetrated each other at instants spread over the run;
    /// none without penetration.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub overlap: Option<f64>,
    /// Work counts over the run; they reproduce, seconds do not.
    pub work: Work,
    /// CPU seconds per simulated second (thread CPU time, median of the repeats).
    #[serde(deserialize_with = "gaps::null_is_nan")]
    pub cpu_s_per_s: f64,
    /// CPU time per step (microseconds).
    #[serde(deserialize_with = "gaps::null_is_nan")]
    pub us_per_step: f64,
    /// CPU time of the set-up (s), not included in the other times.
    #[serde(default, deserialize_with = "gaps::null_is_nan")]
    pub setup_cpu_s: f64,
    /// Figures that the method's set-up found, by name: the certificate of a stabilised network, the
    /// degree of a propagator.
    #[serde(
        default,
        skip_serializing_if = "BTreeMap::is_empty",
        deserialize_with = "gaps::nulls_are_nan"
    )]
    pub facts: BTreeMap<String, f64>,
    /// Step over the critical step 2/omega_max; of hard cases only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step_over_critical: Option<f64>,
    /// Relative distance of the last displacement from equilibrium under the last loads, if the reference comes to
    /// rest; for hard cases only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub static_error: Option<f64>,
    /// Relative change of the method's energy in 1000 steps, if nothing damps or loads the
    /// system; of hard cases only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy_drift: Option<f64>,
    /// Largest excess of the energy over that of the start and the work of loads since, over all energy that these
    /// supplied; for bodies that follow a force law, without moving supports.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub energy_rise: Option<f64>,
    /// The smallest ratio of an element's volume to that at rest, over all steps; for bodies that follow a force law.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub smallest_volume_ratio: Option<f64>,
    /// Relative L2 error (fraction) of the mesh and its element, without any error in time, if known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh_error: Option<f64>,
    /// CPU time of the steps over that of the case's run to which costs are compared.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cost_ratio: Option<f64>,
    /// No other run of the case is both as cheap and as accurate; see [`mark_pareto`].
    #[serde(default)]
    pub pareto: bool,
}

/// End of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RowOutcome {
    /// The run took all its steps.
    #[default]
    Finished,
    /// The run was stopped early: not finite, or far beyond the size of the body.
    Diverged,
    /// A step was refused: by the body's law, or by a method that did not solve its equations.
    Refused,
}

/// Work counts of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Work {
    /// Sweeps over the network (each the cost of one sparse product).
    #[serde(default)]
    pub sweeps: u64,
    /// Evaluations of the force.
    #[serde(default)]
    pub force_evaluations: u64,
    /// Solves with a factorised matrix.
    #[serde(default)]
    pub solves: u64,
    /// Factorisations.
    #[serde(default)]
    pub factorizations: u64,
    /// Newton iterations.
    #[serde(default)]
    pub newton_iterations: u64,
    /// Trials of a line search that were refused or decreased too little.
    #[serde(default)]
    pub backtracks: u64,
    /// Steps whose velocity was reduced, because the energy would have risen.
    #[serde(default)]
    pub limiter_hits: u64,
    /// Steps taken again by another formula.
    #[serde(default)]
    pub fallbacks: u64,
}

/// The verdict on a run in one word. Stability and accuracy are separate questions; see the
/// fields of [`Row`] for details.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RowVerdict {
    /// Finished, bounded, nothing saturated, error at most [`ACCURATE`].
    Accurate,
    /// Finished, bounded, nothing saturated, error above [`ACCURATE`].
    Wrong,
    /// Finished and bounded with saturated cells, for any error.
    Guarded,
    /// Finished, but exceeded the bound.
    Unbounded,
    /// The run was stopped early.
    Diverged,
    /// A step was refused.
    Refused,
}

impl RowVerdict {
    /// The verdicts, the best first.
    pub const ALL: [Self; 6] = [
        Self::Accurate,
        Self::Wrong,
        Self::Guarded,
        Self::Unbounded,
        Self::Diverged,
        Self::Refused,
    ];

    /// A symbol that shows the verdict without colour.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Accurate => "✓",
            Self::Wrong => "✗",
            Self::Guarded => "G",
            Self::Unbounded => "∞",
            Self::Diverged => "D",
            Self::Refused => "R",
        }
    }

    /// The verdict in one word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Accurate => "accurate",
            Self::Wrong => "wrong",
            Self::Guarded => "guarded",
            Self::Unbounded => "unbounded",
            Self::Diverged => "diverged",
            Self::Refused => "refused",
        }
    }
}

impl Row {
    /// The integrator and its non-default options, as in `cnn Q=4`.
    #[must_use]
    pub fn method(&self) -> String {
        label(&self.integrator, &self.options)
    }

    /// The method, with the law and the element if they distinguish runs.
    #[must_use]
    pub fn label(&self) -> String {
        match &self.material {
            Some(material) => format!("{}, {material}", self.method()),
            None => self.method(),
        }
    }

    /// The error in per cent without the sign, as in `1.23`, or as in `< 4.5e-8` if the reference only gives a bound;
    /// none if there is no error.
    #[must_use]
    pub fn error_in_percent(&self) -> Option<String> {
        match self.error_is_below {
            Some(bound) => Some(format!("< {}", number::percent(bound))),
            None => self.error.map(number::percent),
        }
    }

    /// The largest error (fraction) that the run may have, within the accuracy of the reference.
    #[must_use]
    pub fn error_at_most(&self) -> Option<f64> {
        self.error_is_below.or(self.error)
    }

    /// The error, if it is meaningful: for a run that finished within bounds and without saturation.
    #[must_use]
    pub fn sound_error(&self) -> Option<f64> {
        match self.verdict() {
            RowVerdict::Accurate | RowVerdict::Wrong => self.error,
            RowVerdict::Guarded
            | RowVerdict::Unbounded
            | RowVerdict::Diverged
            | RowVerdict::Refused => None,
        }
    }

    /// Like [`Row::sound_error`], over the whole scene: the expected error if only a first part was compared.
    #[must_use]
    pub fn sound_error_over_scene(&self) -> Option<f64> {
        let error = self.sound_error()?;
        Some(self.expected_error.unwrap_or(error))
    }

    /// CPU time (s) of set-up and of the steps that simulate `duration` (s).
    #[must_use]
    pub fn total_cpu_s(&self, duration: f64) -> f64 {
        self.setup_cpu_s + self.cpu_s_per_s * duration
    }

    /// The verdict in one word.
    #[must_use]
    pub fn verdict(&self) -> RowVerdict {
        match self.outcome {
            RowOutcome::Diverged => RowVerdict::Diverged,
            RowOutcome::Refused => RowVerdict::Refused,
            RowOutcome::Finished if !self.bounded => RowVerdict::Unbounded,
            RowOutcome::Finished if self.guarded || self.saturated > 0.0 => RowVerdict::Guarded,
            RowOutcome::Finished if self.error.is_some_and(|e| e <= ACCURATE) => {
                RowVerdict::Accurate
            }
            RowOutcome::Finished => RowVerdict::Wrong,
        }
    }
}

/// `Some` if the value is finite, for fields that JSON must represent.
#[must_use]
pub fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verdicts() {
        let clean = Row {
            bounded: true,
            error: Some(ACCURATE),
            ..Row::default()
        };
        assert_eq!(clean.verdict(), RowVerdict::Accurate);
        let with = |change: fn(&mut Row)| {
            let mut row = clean.clone();
            change(&mut row);
            row.verdict()
        };
        assert_eq!(with(|r| r.error = Some(0.051)), RowVerdict::Wrong);
        assert_eq!(with(|r| r.guarded = true), RowVerdict::Guarded);
        assert_eq!(with(|r| r.saturated = 1e-6), RowVerdict::Guarded);
        assert_eq!(with(|r| r.bounded = false), RowVerdict::Unbounded);
        assert_eq!(
            with(|r| r.outcome = RowOutcome::Diverged),
            RowVerdict::Diverged
        );
        assert_eq!(
            with(|r| r.outcome = RowOutcome::Refused),
            RowVerdict::Refused
        );
    }
}
