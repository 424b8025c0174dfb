//! Errors of factors and of dense eigenproblems.

use sinew_core::SetupError;

/// Reasons for which a matrix cannot be factorised, or a dense eigenproblem cannot be solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FactorError {
    /// The matrix has an eigenvalue at or below zero, up to rounding.
    #[error("it is not positive definite")]
    NotPositiveDefinite,
    /// The factor or its work space does not fit into memory.
    #[error("not enough memory")]
    OutOfMemory,
    /// A factor that takes more memory than is left.
    #[error(
        "it takes about {needed} MB and {left} MB of memory are left; a coarser mesh or an explicit method takes less, and memory = {needed} in [run] tries it"
    )]
    Memory {
        /// Memory that the factor takes (MB).
        needed: u64,
        /// Memory that is left (MB).
        left: u64,
    },
    /// Conjugate gradients that did not converge.
    #[error("conjugate gradients did not come to a solution in {iterations} iterations")]
    NotConverged {
        /// Iterations taken.
        iterations: u32,
    },
    /// The factor has more entries than can be counted.
    #[error("it is too large")]
    TooLarge,
    /// Cells that are coupled by damping and not by stiffness.
    #[error("its damping couples cells that its stiffness does not")]
    Pattern,
    /// The iteration for the eigenvalues of a dense matrix did not converge.
    #[error("a dense eigenproblem did not converge")]
    Eigenproblem,
}

impl FactorError {
    /// The error of a method's set-up.
    pub(crate) fn at_set_up(self, integrator: &'static str) -> SetupError {
        SetupError::Factorization {
            integrator,
            reason: self.to_string(),
        }
    }
}
