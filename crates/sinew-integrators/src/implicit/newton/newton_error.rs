//! Errors of Newton's method.

use sinew_core::EvaluationError;

use crate::implicit::factor_error::FactorError;

/// Reasons for which nonlinear equations are not solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NewtonError {
    /// The path to the solution leaves the law's domain.
    #[error(transparent)]
    Refused(#[from] EvaluationError),
    /// The iteration ended before the forces balanced.
    #[error(
        "{iterations} Newton iterations left {residual:.1e} of the forces unbalanced: {reason}"
    )]
    Unbalanced {
        /// Iterations.
        iterations: u64,
        /// Residual over the size of the forces.
        residual: f64,
        /// Reason.
        reason: String,
    },
    /// Even the projected tangent has no inverse.
    #[error("the projected tangent could not be factorised: {0}")]
    Singular(#[source] FactorError),
}

/// Reasons for which a tangent gives no direction.
pub(super) enum NoDirection {
    /// The law has no tangent at the point.
    Refused(EvaluationError),
    /// The tangent has no inverse, or none that can be computed.
    Singular(FactorError),
}
