//! Interface between a method and its frame.

use std::convert::Infallible;

use sinew_cnn::Program;
use sinew_core::spectrum::Spectrum;
use sinew_core::{
    Fact, LinearSystem, Needs, Properties, SetupError, StableStep, State, Step, StepError,
    StepReport, Stepped, System,
};

use crate::numerical_dissipation::NumericalDissipation;

/// A method whose steps come from its set-up and run in a [`crate::Frame`].
pub trait Scheme: Send + Sized + 'static {
    /// The name that users type.
    const ID: &'static str;

    /// Steps that no program of sweeps expresses; [`Infallible`] if a program always
    /// does.
    type ByHand: StepByHand + 'static;

    /// Properties that it declares.
    fn properties(&self) -> Properties;

    /// The relative error that the user requested, if there is such an option: a precision with a larger rounding error
    /// is refused.
    fn asked_error(&self) -> Option<f64> {
        None
    }

    /// The energy that it dissipates numerically, if a closed form exists.
    fn numerical_dissipation(&self) -> Option<NumericalDissipation> {
        None
    }

    /// The error for a system without a needed property.
    fn lacking(&self) -> SetupError {
        self.properties().needs.lacking(Self::ID)
    }

    /// True if its steps depend on the loads, so that set-up must be checked again when they change.
    fn depends_on_loads(&self) -> bool {
        false
    }

    /// True if no step of this method supports contact; set-up, which may take long, is skipped then on a body with
    /// tools.
    fn refuses_contact(&self) -> bool {
        false
    }

    /// Remedy if loads break the condition of [`Properties::changing_loads`].
    fn load_remedy(&self) -> &'static str {
        "choose a dt that meets that instant"
    }

    /// The largest stable step for motions about a state, or about rest. The system has the parts
    /// named by [`Properties::needs`].
    ///
    /// # Errors
    /// [`SetupError`] when the system lacks a needed property.
    fn stable_step(
        &self,
        _system: &dyn System,
        _about: Option<&State>,
    ) -> Result<StableStep, SetupError> {
        Ok(StableStep::Any)
    }

    /// The largest stable step if these are the fastest motions.
    fn stable_step_of(&self, _spectrum: &Spectrum) -> StableStep {
        StableStep::Unknown
    }

    /// Creates its steps of `dt` (s) on a system. The step and the masses are valid, and the system has the parts named
    /// by [`Properties::needs`]. Parts of `before`, its last steps on any system, may be reused.
    ///
    /// # Errors
    /// [`SetupError`] when the method cannot run there.
    fn set_up(
        &mut self,
        system: &dyn System,
        dt: f64,
        before: Option<Self::ByHand>,
    ) -> Result<SetUp<Self::ByHand>, SetupError>;

    /// Facts that set-up found, for reports; may cost as much as set-up did.
    fn facts(&self) -> Vec<Fact> {
        Vec::new()
    }

    /// Remarks of set-up that a user should read, one sentence each.
    fn remarks(&self) -> Vec<String> {
        Vec::new()
    }
}

/// Result of set-up.
pub struct SetUp<S> {
    /// The steps.
    pub steps: Steps<S>,
    /// The work of making them.
    pub work: StepReport,
}

/// The steps of a method on a system.
pub enum Steps<S> {
    /// A program, which a machine runs.
    Program(Box<Program>),
    /// Steps that no program of sweeps expresses.
    ByHand(Box<S>),
}

impl<S> From<Program> for SetUp<S> {
    fn from(program: Program) -> Self {
        Self {
            steps: Steps::Program(Box::new(program)),
            work: StepReport::default(),
        }
    }
}

impl<S> SetUp<S> {
    /// Steps by hand, with the work of their set-up.
    pub fn by_hand(steps: S, work: StepReport) -> Self {
        Self {
            steps: Steps::ByHand(Box::new(steps)),
            work,
        }
    }
}

/// Steps with all that they need, made by set-up.
pub trait StepByHand: Send {
    /// True if the velocity stays in the middle of the last step.
    fn is_staggered(&self) -> bool {
        false
    }

    /// True if the steps support contact.
    fn meets_contact(&self) -> bool {
        false
    }

    /// Moves u and v over a step. The velocity is at the displacement's time, or in the middle of
    /// a last step of the same length if steps are staggered.
    ///
    /// # Errors
    /// [`StepError`] when the system refuses a trial state or the step would be inaccurate.
    fn step(&mut self, step: &Step<'_>, state: &mut State) -> Result<Stepped, StepError>;

    /// Reason why no program of sweeps expresses them.
    fn without_program(&self) -> &'static str;

    /// Facts that the steps found, for reports.
    fn facts(&self) -> Vec<Fact> {
        Vec::new()
    }

    /// Remarks on the steps taken that a user should read, one sentence each.
    fn remarks(&self) -> Vec<String> {
        Vec::new()
    }
}

impl StepByHand for Infallible {
    fn step(&mut self, _step: &Step<'_>, _state: &mut State) -> Result<Stepped, StepError> {
        match *self {}
    }

    fn without_program(&self) -> &'static str {
        match *self {}
    }
}

/// The matrices and loads of a system.
///
/// # Errors
/// [`SetupError::Lacks`] when it shows none.
pub(crate) fn linear<'a>(
    system: &'a dyn System,
    integrator: &'static str,
) -> Result<&'a dyn LinearSystem, SetupError> {
    let linear = system.as_linear();
    linear.ok_or_else(|| Needs::Matrices.lacking(integrator))
}
