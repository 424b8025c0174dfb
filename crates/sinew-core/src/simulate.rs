//! Running an integrator.

use crate::{Integrator, RecordError, Recorder, State, StepError, StepReport, System, Verdict};

/// How far and in which steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// Step (s).
    pub dt: f64,
    /// Number of steps.
    pub steps: usize,
    /// Largest displacement component (m) before the run counts as diverged.
    pub divergence_limit: f64,
}

impl Run {
    /// As many steps as cover `duration` (s); a last step may pass it where dt does not divide it.
    #[must_use]
    pub fn covering(duration: f64, dt: f64) -> Self {
        // The subtrahend keeps a quotient like 50.000000000000004 from costing one step more.
        let steps = (duration / dt - 1e-9).ceil().max(0.0);
        Self {
            dt,
            steps: steps as usize,
            divergence_limit: f64::INFINITY,
        }
    }

    /// With a limit (m) on displacement components.
    #[must_use]
    pub fn with_divergence_limit(self, divergence_limit: f64) -> Self {
        Self {
            divergence_limit,
            ..self
        }
    }
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// All steps taken.
    Finished,
    /// A displacement was not finite or passed the limit.
    Diverged {
        /// Time of the state (s).
        t: f64,
        /// The worst degree of freedom.
        cell: usize,
    },
    /// A recorder stopped it.
    Stopped,
}

/// What a run did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunReport {
    /// How it ended.
    pub outcome: Outcome,
    /// Steps taken.
    pub steps: usize,
    /// Work of all steps.
    pub work: StepReport,
}

/// Why a run could not go on.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimulateError {
    /// A step failed.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A recorder failed.
    #[error(transparent)]
    Record(#[from] RecordError),
}

/// Takes `run.steps` steps from `state`, showing states to the recorder as it asks for them, and
/// stops early when a displacement is not finite or passes `run.divergence_limit`.
///
/// Set-up work done by the first step counts; call [`Integrator::prepare`] first to keep it out.
///
/// # Errors
/// [`SimulateError`] when a step or a recorder fails.
pub fn simulate(
    system: &dyn System,
    integrator: &mut dyn Integrator,
    state: &mut State,
    run: &Run,
    recorder: &mut dyn Recorder,
) -> Result<RunReport, SimulateError> {
    let mut report = RunReport {
        outcome: Outcome::Finished,
        steps: 0,
        work: StepReport::default(),
    };
    let mut show = |system: &dyn System, state: &State, step| {
        if recorder.wants(step, state.t()) {
            recorder.record(system, state)
        } else {
            Ok(Verdict::Continue)
        }
    };
    if show(system, state, 0)? == Verdict::Stop {
        report.outcome = Outcome::Stopped;
        return Ok(report);
    }
    while report.steps < run.steps {
        report.work += integrator.step(system, state, run.dt)?;
        report.steps += 1;
        if let Some(cell) = beyond(&state.u, run.divergence_limit) {
            report.outcome = Outcome::Diverged { t: state.t(), cell };
            return Ok(report);
        }
        if show(system, state, report.steps)? == Verdict::Stop {
            report.outcome = Outcome::Stopped;
            return Ok(report);
        }
    }
    Ok(report)
}

/// The degree of freedom farthest beyond `limit`; one that is not a number is farthest of all.
fn beyond(u: &[f64], limit: f64) -> Option<usize> {
    let fine = |value: &f64| value.abs() <= limit && value.is_finite();
    if u.iter().all(fine) {
        return None;
    }
    let distance = |value: f64| {
        if value.is_nan() {
            f64::INFINITY
        } else {
            value.abs()
        }
    };
    (0..u.len()).max_by(|&i, &j| distance(u[i]).total_cmp(&distance(u[j])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_covers_its_duration() {
        assert_eq!(Run::covering(1.0, 0.02).steps, 50);
        assert_eq!(Run::covering(1.0, 0.015).steps, 67);
        assert_eq!(Run::covering(1.0, 0.02 / 3.0).steps, 150);
        assert_eq!(Run::covering(0.0, 0.02).steps, 0);
    }

    #[test]
    fn the_worst_degree_of_freedom_is_named() {
        assert_eq!(beyond(&[1.0, -2.0], 3.0), None);
        assert_eq!(beyond(&[1.0, -5.0, 4.0], 3.0), Some(1));
        assert_eq!(beyond(&[1.0, 7.0, f64::NAN], 3.0), Some(2));
        assert_eq!(beyond(&[f64::INFINITY], f64::INFINITY), Some(0));
    }
}
