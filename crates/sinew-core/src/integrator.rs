//! The contract of a time integrator.

use crate::batch::Batch;
use crate::cost_clock::CostClock;
use crate::input::Inputs;
use crate::properties::{Properties, StableStep};
use crate::state::State;
use crate::step_error::{SetupError, StepError};
use crate::step_report::StepReport;
use crate::system::System;

/// A method that takes a state step by step through time.
///
/// Holds caches and work buffers, never physics: all that a method must keep from one step to the next is stored in the
/// [`State`]. Duties that all methods share (checks of sizes, the clock, acceptance, divergence, the guard) are done
/// once, by the [`Batch`] that it runs.
///
/// ```
/// use sinew_core::{
///     Batch, EnergyBehaviour, Integrator, LoadTime, Needs, Prepared, Properties, SetupError,
///     StableStep, State, StepError, StepReport, Stepped, System,
/// };
///
/// /// Symplectic Euler.
/// #[derive(Default)]
/// struct Mine {
///     a: Vec<f64>,
/// }
///
/// impl Integrator for Mine {
///     fn id(&self) -> &'static str {
///         "mine"
///     }
///     fn properties(&self) -> Properties {
///         Properties::of_order(1, Needs::Forces, EnergyBehaviour::Bounded)
///     }
///     fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
///         Prepared::check(self.id(), system, dt)?;
///         self.a.resize(system.dofs(), 0.0);
///         Ok(StepReport::default())
///     }
///     fn stable_step_about(
///         &self,
///         _: &dyn System,
///         _: Option<&State>,
///     ) -> Result<StableStep, SetupError> {
///         Ok(StableStep::Unknown)
///     }
///     fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
///         batch.synchronise(state)?;
///         batch.each(state, |step, state| {
///             step.acceleration(LoadTime::start_of(state.t(), step.dt), state, &mut self.a)?;
///             for ((u, v), a) in state.u.iter_mut().zip(&mut state.v).zip(&self.a) {
///                 *v += step.dt * a;
///                 *u += step.dt * *v;
///             }
///             Ok(Stepped::at_same_time(StepReport::ONE_FORCE))
///         })
///     }
/// }
/// ```
pub trait Integrator: Send {
    /// The name users type.
    fn id(&self) -> &'static str;

    /// Properties that the method declares; the conformance suite checks them.
    fn properties(&self) -> Properties;

    /// Sets up for a system and a step: checks, buffers, factors. Called before every batch; results for the
    /// same system and step are reused.
    ///
    /// # Errors
    /// [`SetupError`] when the system lacks what the method needs or the step is not valid.
    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError>;

    /// The largest step at which the method is stable on this system for motions about a state, or
    /// about rest. The state matters to nonlinear systems only.
    ///
    /// # Errors
    /// [`SetupError`] when the system lacks what the method needs.
    fn stable_step_about(
        &self,
        system: &dyn System,
        state: Option<&State>,
    ) -> Result<StableStep, SetupError>;

    /// The largest step at which the method is stable on this system about rest.
    ///
    /// # Errors
    /// Same as [`Integrator::stable_step_about`].
    fn stable_step(&self, system: &dyn System) -> Result<StableStep, SetupError> {
        self.stable_step_about(system, None)
    }

    /// Takes the steps of a batch, for which [`Integrator::prepare`] was called. Most methods pass
    /// one step to [`Batch::each`].
    ///
    /// # Errors
    /// [`StepError`] when the system refuses a trial state; `state` is then that after the last step, or after the last
    /// substep of a divided step, as its clock shows.
    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError>;

    /// Takes `state` from t to t + dt: a batch of one, as live code needs it.
    ///
    /// # Errors
    /// [`StepError`] when set-up fails or the system refuses a trial state; `state` is then unchanged, or that after
    /// the last substep of a divided step, as its clock shows.
    fn step(
        &mut self,
        system: &dyn System,
        state: &mut State,
        dt: f64,
    ) -> Result<StepReport, StepError> {
        self.step_under(system, Inputs::none(), state, dt)
    }

    /// Takes `state` from t to t + dt under inputs from outside, given up to t + dt.
    ///
    /// # Errors
    /// Same as [`Integrator::step`].
    fn step_under(
        &mut self,
        system: &dyn System,
        inputs: &Inputs,
        state: &mut State,
        dt: f64,
    ) -> Result<StepReport, StepError> {
        let mut batch = Batch::new(system, inputs, dt, 1);
        batch.take(self, state)?;
        Ok(batch.work())
    }

    /// Facts that set-up found for the current system and step, for reports; may cost as much as
    /// set-up did.
    fn facts(&self) -> Vec<Fact> {
        Vec::new()
    }

    /// Remarks of set-up that a user should read, one sentence each.
    fn remarks(&self) -> Vec<String> {
        Vec::new()
    }

    /// The machine, precision and instructions that take the steps after set-up, for reports; `None` for a method with
    /// its own loops.
    fn kernel(&self) -> Option<String> {
        None
    }

    /// The clock that measures the cost of its steps, once it is set up.
    fn cost_clock(&self) -> CostClock {
        CostClock::default()
    }
}

/// A number that set-up found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fact {
    /// Its name, as results show it.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
}

impl Batch<'_> {
    /// Sets the integrator up, checks the state and takes the steps: the only function that takes steps.
    ///
    /// # Errors
    /// [`StepError`] when set-up fails or the system refuses a trial state, and [`StepError::Stalled`] for an integrator
    /// that skips steps without an error.
    pub fn take<I: Integrator + ?Sized>(
        &mut self,
        integrator: &mut I,
        state: &mut State,
    ) -> Result<(), StepError> {
        let work = integrator.prepare(self.system(), self.dt())?;
        self.count(work);
        self.check(integrator.id(), state)?;
        integrator.run(self, state)?;
        self.ended(integrator.id(), state)
    }

    /// Refuses a batch with steps left after `by`, an integrator or a machine, reported that it took them.
    ///
    /// # Errors
    /// [`StepError::Stalled`].
    pub fn ended(&self, by: &'static str, state: &State) -> Result<(), StepError> {
        match self.goes_on() {
            true => Err(StepError::Stalled { by, t: state.t() }),
            false => Ok(()),
        }
    }
}
