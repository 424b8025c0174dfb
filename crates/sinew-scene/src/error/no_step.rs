//! Errors of dt = "auto".

use sinew_core::{EvaluationError, OptionError, SetupError};

/// Reasons why the stable step of an integrator cannot be found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StableStepError {
    /// An option that the integrator refuses.
    #[error(transparent)]
    Option(#[from] OptionError),
    /// A system without a needed property.
    #[error(transparent)]
    Setup(#[from] SetupError),
}

/// Reasons why an integrator gives no step for a scene.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoStableStep {
    /// The body neither vibrates nor is damped.
    #[error("nothing in this scene limits the step of `{integrator}`")]
    Unlimited {
        /// Integrator id.
        integrator: String,
    },
    /// The motion grows at every step.
    #[error("`{integrator}` is stable at no step on this scene")]
    Never {
        /// Integrator id.
        integrator: String,
    },
    /// The integrator is stable at any step.
    #[error("`{integrator}` is stable at any step")]
    Any {
        /// Integrator id.
        integrator: String,
    },
    /// The body cannot be computed as it is at the start.
    #[error("the body is refused at t = 0: {0}")]
    Refused(EvaluationError),
    /// Moduli with which the stiffness of the undeformed body overflows.
    #[error(
        "the stiffness of the body at t = 0 is not finite: a modulus or a density is too large or too small"
    )]
    NotFinite,
    /// The integrator does not know its largest stable step.
    #[error("`{integrator}` cannot tell up to which step it is stable")]
    Unknown {
        /// Integrator id.
        integrator: String,
    },
    /// The integrator cannot compute its largest stable step.
    #[error(transparent)]
    NoAnswer(#[from] StableStepError),
}
