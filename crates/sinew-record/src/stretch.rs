//! The steps of a run between two changes of its body.

use std::cell::RefCell;

use sinew_core::{
    Inputs, Moment, Outcome, RecordError, Run, SimulateError, State, StepError, StepReport, System,
};
use sinew_integrators::Stepper;
use sinew_scene::{Cutter, Seen, Simulation, StretchError};

use crate::error::RecordRunError;
use crate::recorder::RunRecorder;
use crate::run_end::Ended;

/// The steps of a run up to where its body becomes another one, or to its end.
pub(crate) struct RecordedStretch {
    pub(crate) steps: usize,
    pub(crate) work: StepReport,
    /// The end of the run, unless the body changed.
    pub(crate) ended: Ended,
    pub(crate) change: Option<Change>,
}

/// A body that became another one.
pub(crate) struct Change {
    /// The scene as it goes on.
    pub(crate) simulation: Simulation,
    /// The energy (J) that the change brought in.
    pub(crate) energy: f64,
}

/// Takes the steps of `run` with a recorder, which may have seen the state at the beginning.
pub(crate) fn take(
    simulation: &Simulation,
    cutter: Option<&RefCell<Cutter>>,
    integrator: &mut dyn Stepper,
    state: &mut State,
    run: &Run,
    (recorder, is_seen): (&mut RunRecorder<'_>, bool),
) -> Result<RecordedStretch, RecordRunError> {
    let system = simulation.system();
    let energy_of_cuts = || cutter.map_or(0.0, |cutter| cutter.borrow().totals().energy());
    let (energy, begins) = (energy_of_cuts(), state.t());
    let seen = Seen {
        steps: 0,
        beginning: is_seen,
    };
    let stretch = simulation.stretch((cutter, integrator, state), run, (recorder, seen));
    let (report, change) = match stretch {
        Ok(stretch) => (stretch.report, stretch.change),
        Err(error) => {
            // Steps are known by the time they reached; work since the last record is not.
            let steps = ((state.t() - begins) / simulation.dt() + 0.5).floor() as usize;
            let (t, reason) = refusal(error, system)?;
            return Ok(RecordedStretch {
                steps,
                work: recorder.work,
                ended: Ended::Refused { t, reason },
                change: None,
            });
        }
    };
    let change = match change {
        None => None,
        Some(change) => {
            recorder.close_balance(&Moment {
                system,
                inputs: Inputs::none(),
                state: &change.before,
                step: report.steps,
                work: report.work,
            })?;
            Some(Change {
                simulation: change.simulation,
                energy: energy_of_cuts() - energy,
            })
        }
    };
    Ok(RecordedStretch {
        steps: report.steps,
        work: report.work,
        ended: match report.outcome {
            Outcome::Finished => Ended::Finished,
            Outcome::Diverged { t, dof } => Ended::Diverged {
                t,
                place: system.cell_name(dof),
            },
            Outcome::Stopped => Ended::Interrupted { t: state.t() },
        },
        change,
    })
}

/// Time (s) and reason of a refusal, by a law or by a method that found no equilibrium.
///
/// # Errors
/// Any other error, as it is.
fn refusal(error: StretchError, system: &dyn System) -> Result<(f64, String), RecordRunError> {
    let error = match error {
        StretchError::Simulate(error) => error,
        StretchError::Cutting { t, source } => return Ok((t, source.to_string())),
    };
    match error {
        SimulateError::Step(StepError::Inaccurate { t, .. }) if system.as_linear().is_none() => {
            Ok((t, error.to_string()))
        }
        SimulateError::Step(StepError::Refused { t, source }) => Ok((t, source.to_string())),
        SimulateError::Step(StepError::NotConverged { t, .. }) => Ok((t, error.to_string())),
        SimulateError::Record(RecordError { t, source }) => {
            match source.downcast::<RecordRunError>() {
                Ok(cause) => match *cause {
                    RecordRunError::State(refused) => Ok((t, refused.to_string())),
                    other => Err(other),
                },
                Err(source) => Err(SimulateError::Record(RecordError { t, source }).into()),
            }
        }
        other => Err(other.into()),
    }
}
