//! Errors of set-up and steps.

use crate::evaluation_error::EvaluationError;
use crate::synchronise::SynchroniseError;

/// Reasons for which a method cannot run on a system.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SetupError {
    /// The system lacks a property that the method needs.
    #[error("`{integrator}` needs {needs}, which this system does not offer")]
    Lacks {
        /// Integrator id.
        integrator: &'static str,
        /// The missing part.
        needs: &'static str,
    },
    /// Single precision for steps that are computed in double precision only.
    #[error(
        "`{integrator}`: these steps are computed in f64 only: {reason}; leave `precision` out"
    )]
    SinglePrecision {
        /// Integrator id.
        integrator: &'static str,
        /// Reason.
        reason: &'static str,
    },
    /// A machine that does not run the system or the method.
    #[error("`{integrator}`: {reason}")]
    Machine {
        /// Integrator id.
        integrator: &'static str,
        /// Reason and remedy.
        reason: String,
    },
    /// Contact, for steps whose response to contact forces has no closed form.
    #[error("`{integrator}`: {reason}; take {methods}")]
    Contact {
        /// Integrator id.
        integrator: &'static str,
        /// Reason why contact is impossible.
        reason: &'static str,
        /// Methods that can.
        methods: &'static str,
    },
    /// A precision whose rounding error exceeds the requested error.
    #[error(
        "`{integrator}`: f32 may be off by {expected:.0e}, more than the tolerance of {asked:e}; take \
         precision = \"f64\", or a tolerance from {expected:.0e} on"
    )]
    Rounding {
        /// Integrator id.
        integrator: &'static str,
        /// The requested error (relative).
        asked: f64,
        /// The error of rounding (relative).
        expected: f64,
    },
    /// A step that is not positive and finite.
    #[error("`{integrator}`: dt = {dt} s: expected a finite step above 0")]
    Step {
        /// Integrator id.
        integrator: &'static str,
        /// The step (s).
        dt: f64,
    },
    /// A mass that is not positive.
    #[error("`{integrator}`: {cell} has a mass of {mass} kg: expected a finite mass above 0")]
    Mass {
        /// Integrator id.
        integrator: &'static str,
        /// The cell, as the system names it.
        cell: String,
        /// Its mass (kg).
        mass: f64,
    },
    /// A number of internal variables other than the system's.
    #[error("`{integrator}`: the state has {state} internal variables, the system has {system}")]
    Internal {
        /// Integrator id.
        integrator: &'static str,
        /// Internal variables of the state.
        state: usize,
        /// Internal variables of the system.
        system: usize,
    },
    /// A load follows an input that the caller does not give.
    #[error("`{integrator}`: a load follows input {channel}, which the inputs do not have")]
    NoInput {
        /// Integrator id.
        integrator: &'static str,
        /// The channel's number.
        channel: u32,
    },
    /// A force from outside on a degree of freedom that does not exist.
    #[error("`{integrator}`: a force acts on degree of freedom {dof}: there are {dofs} (0-based)")]
    ForceOutOfRange {
        /// Integrator id.
        integrator: &'static str,
        /// The degree of freedom named.
        dof: u32,
        /// Degrees of freedom of the system.
        dofs: usize,
    },
    /// A staggered state under loads that differ from those that produced it.
    #[error(
        "`{integrator}`: the loads were replaced in mid-run; a velocity half a step behind follows from \
         those before. Give loads that change as it happens through `Inputs`, or call \
         `State::synchronise` before replacing them"
    )]
    OtherLoads {
        /// Integrator id.
        integrator: &'static str,
    },
    /// A state of another size than the system.
    #[error("`{integrator}`: the state has {state} degrees of freedom, the system has {system}")]
    StateSize {
        /// Integrator id.
        integrator: &'static str,
        /// Length of the state's vectors.
        state: usize,
        /// Degrees of freedom of the system.
        system: usize,
    },
    /// The method cannot be accurate at this step.
    #[error("`{integrator}`: {reason}")]
    Unresolved {
        /// Integrator id.
        integrator: &'static str,
        /// The reason, and the remedy.
        reason: String,
    },
    /// The matrix of an implicit step could not be factorised.
    #[error("`{integrator}`: the matrix of the step could not be factorised: {reason}")]
    Factorization {
        /// Integrator id.
        integrator: &'static str,
        /// Message of the factorisation.
        reason: String,
    },
}

/// Reasons for which a step fails.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StepError {
    /// Set-up failed.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// A batch was run without set-up.
    #[error("the integrator was not set up: call `prepare` first, or take steps by `Batch::take`")]
    NotPrepared,
    /// A velocity that no other step or method can continue from.
    #[error(transparent)]
    Synchronise(#[from] SynchroniseError),
    /// The method found that its step would be wrong.
    #[error("`{integrator}` at t = {} s: {reason}", to_nine_digits(*t))]
    Inaccurate {
        /// Integrator id.
        integrator: &'static str,
        /// Time of the state (s).
        t: f64,
        /// The reason, and the remedy.
        reason: String,
    },
    /// Steps that were not taken although no error was returned.
    #[error(
        "`{by}` at t = {} s: its `run` ended without an error before all steps were taken; expected each step \
         of the batch, or the reason against it",
        to_nine_digits(*t)
    )]
    Stalled {
        /// The integrator's id, or the machine's name.
        by: &'static str,
        /// Time of the state (s).
        t: f64,
    },
    /// The nonlinear equations of a step were not solved.
    #[error(
        "`{integrator}` at t = {} s: {iterations} Newton iterations left {residual:.1e} of the forces unbalanced: \
         {reason}; take a shorter step",
        to_nine_digits(*t)
    )]
    NotConverged {
        /// Integrator id.
        integrator: &'static str,
        /// Time of the state (s), which is that before the step.
        t: f64,
        /// Iterations of the step.
        iterations: u64,
        /// Unbalanced force, relative to the largest of the forces.
        residual: f64,
        /// Reason why the iteration ended.
        reason: String,
    },
    /// The system refused a trial state.
    #[error("at t = {} s: {source}", to_nine_digits(*t))]
    Refused {
        /// Time of the trial (s).
        t: f64,
        /// Error of the system.
        source: EvaluationError,
    },
}

/// A time without the rounding of the sum of steps.
pub(crate) fn to_nine_digits(t: f64) -> f64 {
    format!("{t:.8e}").parse().unwrap_or(t)
}
