//! Recorders, which observe states while a simulation runs.

use crate::{EvaluationError, Inputs, LoadTime, State, StepReport, System, Trial};

/// Decision to continue or end a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The run continues.
    Continue,
    /// The run ends here.
    Stop,
}

/// Error of a recorder that could not record.
#[derive(Debug, thiserror::Error)]
#[error("recording at t = {t} s failed: {source}")]
pub struct RecordError {
    /// Time of the state (s).
    pub t: f64,
    /// The cause.
    pub source: Box<dyn std::error::Error + Send + Sync>,
}

/// A moment of a running simulation.
#[derive(Clone, Copy)]
pub struct Moment<'a> {
    /// The system.
    pub system: &'a dyn System,
    /// Inputs from outside.
    pub inputs: &'a Inputs,
    /// The state.
    pub state: &'a State,
    /// Steps taken since the simulation began.
    pub step: usize,
    /// Work of these steps.
    pub work: StepReport,
}

impl Moment<'_> {
    /// Writes the velocity at the displacement's time (m/s) into `out`; see
    /// [`State::velocity_at_t`].
    ///
    /// # Errors
    /// [`EvaluationError`] when the system refuses the state.
    pub fn velocity(&self, out: &mut [f64]) -> Result<(), EvaluationError> {
        self.state.velocity_at_t(self.system, self.inputs, out)
    }

    /// Writes the acceleration (m/s^2) that the system gives a motion with the displacement of this moment and a
    /// velocity `v` (m/s) at the same time.
    ///
    /// # Errors
    /// [`EvaluationError`] when the system refuses the state.
    pub fn acceleration(&self, v: &[f64], out: &mut [f64]) -> Result<(), EvaluationError> {
        let trial = Trial {
            load: LoadTime::at(self.state.t()).under(self.inputs),
            dt: 0.0,
            u: &self.state.u,
            v,
            internal: &self.state.internal,
        };
        self.system.net_force(&trial, out)?;
        if let Some(contact) = self.system.contact() {
            contact.add_forces(self.state, false, out);
        }
        for (force, mass) in out.iter_mut().zip(self.system.mass()) {
            *force /= mass;
        }
        Ok(())
    }
}

/// An observer of a running simulation. It asks beforehand for the moments it wants, which saves copies and
/// lets a method take many steps in one batch.
pub trait Recorder {
    /// The first of the steps from `step` on (0: the initial state) after which it wants to see the
    /// state, if any.
    fn next(&mut self, step: usize) -> Option<usize>;

    /// Records a requested moment. `state.v` may be staggered: use [`Moment::velocity`].
    ///
    /// # Errors
    /// [`RecordError`] when it could not store the moment; the simulation ends.
    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError>;

    /// Degrees of freedom whose displacements it wants of every step. Called once.
    fn watches(&self) -> Vec<u32> {
        Vec::new()
    }

    /// Displacements (m) of the degrees of freedom that it watches, after the step to time `t` (s) and
    /// of the initial state. They come in order, but not before the batch that they belong to is taken.
    ///
    /// # Errors
    /// Same as [`Recorder::record`].
    fn watched(&mut self, _t: f64, _u: &[f64]) -> Result<Verdict, RecordError> {
        Ok(Verdict::Continue)
    }
}

/// Requests no states.
impl Recorder for () {
    fn next(&mut self, _step: usize) -> Option<usize> {
        None
    }

    fn record(&mut self, _moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        Ok(Verdict::Continue)
    }
}

/// Requests every state.
impl<F> Recorder for F
where
    F: FnMut(&Moment<'_>) -> Result<Verdict, RecordError>,
{
    fn next(&mut self, step: usize) -> Option<usize> {
        Some(step)
    }

    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        self(moment)
    }
}
