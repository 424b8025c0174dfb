//! Running an integrator.

use crate::batch::worst_beyond;
use crate::{
    Batch, Inputs, Integrator, Moment, RecordError, Recorder, State, StepError, StepReport, System,
    Verdict, Watch,
};

/// Largest number of steps of a batch, which bounds the memory of watched samples.
const LONGEST_BATCH: usize = 1024;

/// Length, number and limit of the steps of a run.
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
    /// Steps that cover `duration` (s); the last may end after it if dt does not divide it.
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

    /// Sets the limit (m) on displacement components.
    #[must_use]
    pub fn with_divergence_limit(self, divergence_limit: f64) -> Self {
        Self {
            divergence_limit,
            ..self
        }
    }
}

/// End of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Outcome {
    /// All steps taken.
    Finished,
    /// A displacement was not finite or passed the limit, or the last velocity was not finite.
    Diverged {
        /// Time of the state (s).
        t: f64,
        /// The degree of freedom that went farthest.
        dof: usize,
    },
    /// A recorder stopped it.
    Stopped,
}

/// Summary of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RunReport {
    /// End of the run.
    pub outcome: Outcome,
    /// Steps taken.
    pub steps: usize,
    /// Work of all steps.
    pub work: StepReport,
}

/// Reasons for which a run cannot continue.
#[derive(Debug, thiserror::Error)]
pub enum SimulateError {
    /// A step failed.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A recorder failed.
    #[error(transparent)]
    Record(#[from] RecordError),
}

/// Takes `run.steps` steps from `state`, in batches that end where the recorder wants to see a
/// state, and stops early when a displacement is not finite or passes `run.divergence_limit`.
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
    simulate_under(system, Inputs::none(), integrator, state, run, recorder)
}

/// Runs [`simulate`] under recorded inputs.
///
/// # Errors
/// Same as [`simulate`].
pub fn simulate_under(
    system: &dyn System,
    inputs: &Inputs,
    integrator: &mut dyn Integrator,
    state: &mut State,
    run: &Run,
    recorder: &mut dyn Recorder,
) -> Result<RunReport, SimulateError> {
    let mut shown = RecordedSteps::new(recorder);
    let outcome = shown.take((system, inputs), integrator, state, run)?;
    Ok(RunReport {
        outcome,
        steps: shown.steps(),
        work: shown.work(),
    })
}

/// Steps of a motion that a recorder receives as one sequence, however many calls take them.
pub struct RecordedSteps<'r, R: Recorder + ?Sized> {
    recorder: &'r mut R,
    watch: Watch,
    steps: usize,
    work: StepReport,
    /// True if the recorder has seen the present state.
    is_shown: bool,
}

impl<'r, R: Recorder + ?Sized> RecordedSteps<'r, R> {
    /// Begins with a state that the recorder has not seen.
    pub fn new(recorder: &'r mut R) -> Self {
        Self {
            watch: Watch::new(recorder.watches(), LONGEST_BATCH + 1),
            recorder,
            steps: 0,
            work: StepReport::default(),
            is_shown: false,
        }
    }

    /// Begins after steps that the recorder saw earlier, up to the present state.
    pub fn resumed(recorder: &'r mut R, steps: usize) -> Self {
        Self {
            steps,
            is_shown: true,
            ..Self::new(recorder)
        }
    }

    /// Steps taken, those before [`RecordedSteps::resumed`] included.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Work of the steps that were taken here.
    #[must_use]
    pub fn work(&self) -> StepReport {
        self.work
    }

    /// The recorder.
    pub fn recorder(&mut self) -> &mut R {
        self.recorder
    }

    /// Asks the recorder again for the degrees of freedom to watch, after the system changed.
    pub fn watch_again(&mut self) {
        self.watch = Watch::new(self.recorder.watches(), LONGEST_BATCH + 1);
    }

    /// Takes `run.steps` more steps, in batches that end where the recorder wants to see a state. Stops early if the
    /// recorder says so, or if a displacement is not finite or passes `run.divergence_limit`.
    ///
    /// # Errors
    /// [`SimulateError`] when a step or the recorder fails.
    pub fn take(
        &mut self,
        (system, inputs): (&dyn System, &Inputs),
        integrator: &mut dyn Integrator,
        state: &mut State,
        run: &Run,
    ) -> Result<Outcome, SimulateError> {
        let end = self.steps.saturating_add(run.steps);
        let watches = !self.watch.is_empty();
        if watches && !self.is_shown {
            self.watch.sample(state);
        }
        let (mut outcome, mut failed) = (Outcome::Finished, None);
        loop {
            let mut verdict = deliver(&mut self.watch, self.recorder)?;
            if let Some(error) = failed {
                return Err(error);
            }
            let mut next = match self.is_shown {
                true => None,
                false => self.recorder.next(self.steps),
            };
            if next == Some(self.steps) && outcome == Outcome::Finished {
                let moment = Moment {
                    system,
                    inputs,
                    state,
                    step: self.steps,
                    work: self.work,
                };
                if self.recorder.record(&moment)? == Verdict::Stop {
                    verdict = Verdict::Stop;
                }
                next = None;
            }
            self.is_shown = true;
            if verdict == Verdict::Stop && outcome == Outcome::Finished {
                outcome = Outcome::Stopped;
            }
            if self.steps >= end || outcome != Outcome::Finished {
                return Ok(outcome);
            }
            let next = next.or_else(|| self.recorder.next(self.steps + 1));
            let wished = next.map_or(end, |next| next.min(end));
            let count = (wished - self.steps).clamp(1, LONGEST_BATCH);
            let mut batch = Batch::new(system, inputs, run.dt, count)
                .with_divergence_limit(run.divergence_limit);
            if watches {
                batch = batch.with_watch(&mut self.watch);
            }
            failed = batch.take(integrator, state).err().map(SimulateError::from);
            self.steps += batch.taken();
            self.work += batch.work();
            self.is_shown = false;
            let ends = failed.is_none() && self.steps >= end;
            let diverged = batch.diverged();
            // Displacements are checked after each step; of the last one the velocity leads to no other.
            let last = || worst_beyond(&state.v, f64::INFINITY);
            let diverged = diverged.or_else(|| ends.then(last).flatten());
            if let Some(dof) = diverged {
                outcome = Outcome::Diverged { t: state.t(), dof };
            }
        }
    }
}

/// Passes watched samples on to the recorder, those of a run that fails or ends included.
fn deliver<R: Recorder + ?Sized>(
    watch: &mut Watch,
    recorder: &mut R,
) -> Result<Verdict, RecordError> {
    let mut verdict = Verdict::Continue;
    for (t, u) in watch.samples() {
        if recorder.watched(t, u)? == Verdict::Stop {
            verdict = Verdict::Stop;
        }
    }
    watch.clear();
    Ok(verdict)
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
}
