//! Solvers of combinations of M, D and K: sparse Cholesky factors, or conjugate gradients if a factor exceeds the
//! available memory. The only user of faer, with its own files.

mod aggregates;
mod cell_order;
mod cholesky;
mod gradients;
mod matrices;
mod memory;
mod panels;
mod solver;
mod structure;
#[cfg(test)]
mod tests;
mod two_grid;

use std::sync::Arc;

use sinew_core::{Layers, Pattern};
use sinew_sparse::ordering::Elimination;

use self::cell_order::cell_order;
use self::cholesky::Cholesky;
pub use self::cholesky::symmetric_eigen;
pub use self::matrices::{Combination, Matrices};
pub use self::memory::Memory;
pub use self::solver::Solver;
use super::factor_error::FactorError;

/// The sparse Cholesky factor of a [`Combination`], with its analysis and buffers kept for the next one on the same pattern.
///
/// Cells are eliminated by nested dissection or by approximate minimum degree, whichever takes fewer operations.
#[derive(Debug)]
pub struct Factor {
    pattern: Arc<Pattern>,
    layers: Layers,
    cholesky: Cholesky,
}

/// Memory of a factor over that of its blocks: it includes work space, and zeros within panels.
const BESIDE: f64 = 1.3;

impl Factor {
    /// Orders and analyses the pattern of the matrices.
    ///
    /// # Errors
    /// [`FactorError::Memory`] if the factor takes more memory than is available, before it is allocated.
    pub fn analyse<'m>(matrices: impl Into<Matrices<'m>>) -> Result<Self, FactorError> {
        let matrices = matrices.into();
        let elimination = cell_order(matrices.shape().0)?;
        Self::with(matrices, &elimination, Memory::left())
    }

    fn with(
        matrices: Matrices<'_>,
        elimination: &Elimination,
        memory: Memory,
    ) -> Result<Self, FactorError> {
        let (pattern, layers) = matrices.shape();
        memory.check(bytes(elimination, layers))?;
        Ok(Self {
            pattern: Arc::clone(pattern),
            layers,
            cholesky: Cholesky::analyse(matrices, &elimination.order)?,
        })
    }

    /// Approximate memory (bytes) of a factor on this pattern.
    ///
    /// # Errors
    /// [`FactorError`] when there is no memory for the analysis.
    pub fn bytes_on(pattern: &Pattern, layers: Layers) -> Result<u64, FactorError> {
        Ok(bytes(&cell_order(pattern)?, layers))
    }

    /// True if the analysis is valid for these matrices.
    #[must_use]
    pub fn fits<'m>(&self, matrices: impl Into<Matrices<'m>>) -> bool {
        let (pattern, layers) = matrices.into().shape();
        Arc::ptr_eq(&self.pattern, pattern) && self.layers == layers
    }

    /// Number of stored entries of the factor, zeros inside its panels included.
    #[must_use]
    pub fn stored(&self) -> usize {
        self.cholesky.stored()
    }

    /// Factorises a combination of the matrices.
    ///
    /// # Errors
    /// [`FactorError::NotPositiveDefinite`].
    pub fn factorise<'m>(
        &mut self,
        matrices: impl Into<Matrices<'m>>,
        combination: Combination,
    ) -> Result<(), FactorError> {
        self.cholesky.factorise(matrices.into(), combination)
    }

    /// Replaces `right_hand_side` by the solution. Allocates nothing.
    ///
    /// # Panics
    /// If it is shorter than the matrix.
    pub fn solve(&mut self, right_hand_side: &mut [f64]) {
        self.cholesky.solve(right_hand_side);
    }
}

/// Number of products of blocks to factorise a matrix on a pattern, up to a factor common to all patterns.
///
/// # Errors
/// [`FactorError`] when there is no memory for the order of its cells.
pub(super) fn products_of_factor(pattern: &Pattern) -> Result<u64, FactorError> {
    Ok(cell_order(pattern)?.products())
}

/// Memory (bytes) of a factor with this order of elimination.
fn bytes(elimination: &Elimination, layers: Layers) -> u64 {
    let numbers = elimination.blocks() as f64 * layers.block_len() as f64;
    (BESIDE * numbers * size_of::<f64>() as f64) as u64
}
