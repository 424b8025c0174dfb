//! Failures of the search for modes.

use crate::implicit::factor_error::FactorError;

/// Reasons for which there is no basis.
#[derive(Debug)]
pub(super) enum Failure {
    Factorization(FactorError),
    /// Vectors of the loads are requested, but there are no loads.
    NoLoads,
    /// Fewer vectors are requested than there are static responses and rigid motions.
    TooFew {
        needed: usize,
    },
    /// The tolerance needs more modes than allowed.
    TooMany {
        basis: usize,
        dofs: usize,
        estimate: f64,
    },
}
