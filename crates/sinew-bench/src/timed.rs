//! Timed runs, which count only if they were completed.

use std::time::Instant;

use sinew_cnn::Machine;
use sinew_core::{
    Batch, Integrator, Outcome, Run, RunReport, SimulateError, State, StepError, System, simulate,
};
use sinew_measure::thread_cpu_time;

/// Reasons for which the time of a run is meaningless.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TimedRunError {
    /// A run that fails.
    #[error("a timed run failed: {0}")]
    Run(#[from] SimulateError),
    /// A step of a machine that fails.
    #[error("a timed run failed: {0}")]
    Step(#[from] StepError),
    /// A run that ends before its last step, or whose motion is not finite.
    #[error(
        "a timed run took {taken} of {steps} steps and its motion is {}: its time is not that of a whole run",
        if *.is_finite { "finite" } else { "not finite" }
    )]
    Unfinished {
        /// Steps that were taken.
        taken: usize,
        /// The requested steps.
        steps: usize,
        /// True if every displacement is a number.
        is_finite: bool,
    },
}

/// Time of some work (s).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spent {
    /// Wall time.
    pub(crate) wall: f64,
    /// CPU time of this thread.
    pub(crate) cpu: f64,
}

/// Time of work that cannot fail, or whose result is checked elsewhere.
pub(crate) fn time<R>(work: impl FnOnce() -> R) -> (R, Spent) {
    let (wall, cpu) = (Instant::now(), thread_cpu_time());
    let done = work();
    let cpu = (thread_cpu_time() - cpu).as_secs_f64();
    let wall = wall.elapsed().as_secs_f64();
    (done, Spent { wall, cpu })
}

/// Time of a batch on a machine.
pub(crate) fn time_batch(
    machine: &mut dyn Machine,
    batch: &mut Batch<'_>,
    steps: usize,
    state: &mut State,
) -> Result<Spent, TimedRunError> {
    let (done, spent) = time(|| machine.run(batch, state));
    done?;
    whole(batch.taken(), steps, batch.diverged().is_none(), state)?;
    Ok(spent)
}

/// Time of a run.
pub(crate) fn time_run(
    system: &dyn System,
    integrator: &mut dyn Integrator,
    state: &mut State,
    run: &Run,
) -> Result<(RunReport, Spent), TimedRunError> {
    let (report, spent) = time(|| simulate(system, integrator, state, run, &mut ()));
    let report = report?;
    let is_finished = report.outcome == Outcome::Finished;
    whole(report.steps, run.steps, is_finished, state)?;
    Ok((report, spent))
}

fn whole(
    taken: usize,
    steps: usize,
    is_finished: bool,
    state: &State,
) -> Result<(), TimedRunError> {
    let is_finite = is_finished && state.u.iter().all(|u| u.is_finite());
    match is_finite && taken == steps {
        true => Ok(()),
        false => Err(TimedRunError::Unfinished {
            taken,
            steps,
            is_finite,
        }),
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use sinew_cnn::Program;
    use sinew_core::{Inputs, LinearModel, LinearOperators, Options};

    use super::*;

    /// A machine with one defect.
    #[derive(Debug)]
    enum Broken {
        Refuses,
        TakesNone,
        LosesTheMotion,
    }

    impl Machine for Broken {
        fn name(&self) -> &'static str {
            "broken"
        }

        fn load(&mut self, _: Arc<Program>, _: &dyn System) {}

        fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
            match self {
                Self::Refuses => return Err(StepError::NotPrepared),
                Self::TakesNone => {}
                Self::LosesTheMotion => {
                    state.u.fill(f64::NAN);
                    while batch.goes_on() {
                        let done = sinew_core::Stepped::at_same_time(Default::default());
                        batch.end_step(state, done)?;
                    }
                }
            }
            Ok(())
        }
    }

    fn oscillator() -> LinearModel {
        LinearModel::new(LinearOperators::oscillator(0.1, 100.0, 1.0).unwrap())
    }

    #[test]
    fn batches_that_fail_end_early_or_lose_the_motion_have_no_time() {
        let model = oscillator();
        let timed = |mut machine: Broken| {
            let mut batch = Batch::new(&model, Inputs::none(), 1e-3, 5);
            let mut state = State::new(vec![0.0], vec![-5.0]);
            let timed = time_batch(&mut machine, &mut batch, 5, &mut state);
            timed.unwrap_err().to_string()
        };
        assert!(timed(Broken::Refuses).starts_with("a timed run failed: "));
        assert!(timed(Broken::TakesNone).starts_with("a timed run took 0 of 5 steps"));
        assert!(timed(Broken::LosesTheMotion).contains("not finite"));
    }

    #[test]
    fn a_run_that_diverges_has_no_time_and_one_that_ends_has() {
        let model = oscillator();
        let timed = |dt: f64| {
            let mut method = sinew_integrators::build("forward-euler", &Options::new()).unwrap();
            let mut state = State::new(vec![0.0], vec![-5.0]);
            let run = Run::covering(20.0, dt).with_divergence_limit(1e3);
            time_run(&model, &mut *method, &mut state, &run).map(|(_, spent)| spent)
        };
        assert!(timed(1e-3).is_ok_and(|spent| spent.wall > 0.0));
        let error = timed(0.02).unwrap_err();
        assert!(
            matches!(error, TimedRunError::Unfinished { steps: 1000, .. }),
            "{error}"
        );
    }
}
