//! Failures of the search for modes.

use crate::implicit::factor_error::FactorError;

/// Reasons for which there is no basis.
#[derive(Debug)]
pub(super) enum Failure {
    Factorization(FactorError),
    /// The tolerance needs more modes than may be taken.
    TooMany {
        basis: usize,
        dofs: usize,
        estimate: f64,
    },
}
