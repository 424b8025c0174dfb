//! Loads on a body at rest.

use sinew_sparse::BlockMatrix;

use crate::evaluation_error::EvaluationError;

/// A load on a body at rest, which may depend on the displacement.
pub trait StaticLoad {
    /// `out = F(u)` (N) at a displacement (m).
    fn force(&self, u: &[f64], out: &mut [f64]);

    /// `out -= factor dF/du` (N/m), the symmetric part; nothing for loads that do not depend on the displacement.
    ///
    /// # Errors
    /// [`EvaluationError`] if `out` has no block for a coupling; its entries are then unspecified.
    fn add_stiffness(
        &self,
        _u: &[f64],
        _factor: f64,
        _out: &mut BlockMatrix,
    ) -> Result<(), EvaluationError> {
        Ok(())
    }

    /// `out = -factor dF/du w` (N), the skew part of the derivative; returns true if there is any.
    fn skew_product(&self, _u: &[f64], _factor: f64, _w: &[f64], _out: &mut [f64]) -> bool {
        false
    }
}

/// A constant force (N).
impl StaticLoad for &[f64] {
    fn force(&self, _u: &[f64], out: &mut [f64]) {
        out.copy_from_slice(self);
    }
}
