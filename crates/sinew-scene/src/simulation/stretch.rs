//! Runs of bodies that are cut: stretches of steps between changes of the body.

use std::cell::RefCell;

use sinew_core::{
    Inputs, Integrator, Moment, Outcome, RecordError, Recorder, Run, RunReport, SimulateError,
    State, StepReport, Verdict, simulate,
};

use super::Simulation;
use super::cutter::{Cutter, CuttingError};

/// The steps of a run up to where its body becomes another one, or to its end.
#[derive(Debug)]
pub struct Stretch {
    /// Its end, steps and work.
    pub report: RunReport,
    /// The change at its end.
    pub change: Option<Box<BodyChange>>,
}

/// A body that became another one between two steps.
#[derive(Debug)]
pub struct BodyChange {
    /// The scene as it goes on; the state of the run is carried over to it.
    pub simulation: Simulation,
    /// The state before.
    pub before: State,
}

/// Reasons for which a stretch ends before its time.
#[derive(Debug, thiserror::Error)]
pub enum StretchError {
    /// A step or a recorder that failed.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// A cut that leaves nothing to go on with.
    #[error("t = {t} s: {source}")]
    Cutting {
        /// Time (s).
        t: f64,
        /// The reason.
        source: CuttingError,
    },
}

/// Where a recorder stands at the beginning of a stretch.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Seen {
    /// Steps that it counts before.
    pub steps: usize,
    /// Whether it has seen the state at the beginning.
    pub beginning: bool,
}

impl Simulation {
    /// Takes the steps of `run`, up to where the `cutter` makes its body another one.
    ///
    /// Between two acts of the blade steps are taken at once, as by [`simulate`]; the recorder sees one run.
    ///
    /// # Errors
    /// [`StretchError`].
    pub fn stretch(
        &self,
        (cutter, integrator, state): (Option<&RefCell<Cutter>>, &mut dyn Integrator, &mut State),
        run: &Run,
        (recorder, seen): (&mut dyn Recorder, Seen),
    ) -> Result<Stretch, StretchError> {
        let mut onwards = Onwards {
            recorder,
            before: seen.steps,
            work: StepReport::default(),
            is_seen: seen.beginning,
            skips_sample: false,
        };
        let mut taken = 0;
        let mut before = State::at_rest(0);
        loop {
            let mut steps = run.steps - taken;
            if let Some(cutter) = cutter.filter(|_| steps > 0) {
                if !onwards.is_seen {
                    // What stands at the beginning is the body before any cut.
                    steps = 0;
                } else {
                    let t = state.t();
                    let mut clock = state.clock;
                    clock.advance(run.dt);
                    let end = clock.time();
                    let mut cutter = cutter.borrow_mut();
                    let idle = cutter.idle_until(t);
                    if idle < end {
                        before.clone_from(state);
                        let cut = cutter.follow(self, state, Inputs::none(), end);
                        let cut = cut.map_err(|source| {
                            // The scene is that before the cut, and so is its state.
                            state.clone_from(&before);
                            StretchError::Cutting { t, source }
                        })?;
                        if let Some(simulation) = cut {
                            let change = Box::new(BodyChange { simulation, before });
                            return Ok(Stretch {
                                report: onwards.report(Outcome::Finished, taken),
                                change: Some(change),
                            });
                        }
                        steps = 1;
                    } else {
                        // A stroke that is met late is followed from its beginning all the same.
                        steps = steps.min(((idle - t) / run.dt) as usize).max(1);
                    }
                }
            }
            let part = Run { steps, ..*run };
            onwards.skips_sample = onwards.is_seen;
            let report = simulate(self.system(), integrator, state, &part, &mut onwards)?;
            taken += report.steps;
            onwards.before += report.steps;
            onwards.work += report.work;
            onwards.is_seen = true;
            if report.outcome != Outcome::Finished || taken >= run.steps {
                return Ok(Stretch {
                    report: onwards.report(report.outcome, taken),
                    change: None,
                });
            }
        }
    }
}

/// Shows a recorder several runs as one.
struct Onwards<'a> {
    recorder: &'a mut dyn Recorder,
    /// Steps and work before the run at hand.
    before: usize,
    work: StepReport,
    /// Whether the state at its beginning was seen as the end of the last one.
    is_seen: bool,
    /// Whether that state is the next sample that comes.
    skips_sample: bool,
}

impl Onwards<'_> {
    fn report(&self, outcome: Outcome, steps: usize) -> RunReport {
        let work = self.work;
        RunReport {
            outcome,
            steps,
            work,
        }
    }
}

impl Recorder for Onwards<'_> {
    fn next(&mut self, step: usize) -> Option<usize> {
        let step = if self.is_seen { step.max(1) } else { step };
        self.recorder
            .next(self.before + step)?
            .checked_sub(self.before)
    }

    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        let mut work = self.work;
        work += moment.work;
        let step = self.before + moment.step;
        self.recorder.record(&Moment {
            step,
            work,
            ..*moment
        })
    }

    fn watches(&self) -> Vec<u32> {
        self.recorder.watches()
    }

    fn watched(&mut self, t: f64, u: &[f64]) -> Result<Verdict, RecordError> {
        if std::mem::take(&mut self.skips_sample) {
            return Ok(Verdict::Continue);
        }
        self.recorder.watched(t, u)
    }
}
