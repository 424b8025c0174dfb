//! A factor if there is memory for it, or else conjugate gradients.

use super::cell_order::cell_order;
use super::gradients::Gradients;
use super::matrices::{Combination, Matrices};
use super::memory::Memory;
use super::{Factor, bytes};
use crate::implicit::factor_error::FactorError;

/// A solver of equations with a [`Combination`] that is symmetric and positive definite: by its factor, or by conjugate
/// gradients if a factor takes more memory than is available.
#[derive(Debug)]
pub struct Solver(Kind);

#[derive(Debug)]
enum Kind {
    Factor(Box<Factor>),
    Gradients {
        gradients: Box<Gradients>,
        /// Bytes of the factor that they replace; 0 if none was considered.
        instead_of: u64,
    },
}

impl From<Factor> for Solver {
    fn from(factor: Factor) -> Self {
        Self(Kind::Factor(Box::new(factor)))
    }
}

impl Solver {
    /// Orders and analyses the pattern of the matrices.
    ///
    /// # Errors
    /// [`FactorError`] when there is no memory for either.
    pub fn analyse<'m>(matrices: impl Into<Matrices<'m>>) -> Result<Self, FactorError> {
        Self::analyse_within(matrices, Memory::left())
    }

    /// [`Solver::analyse`] for a factor within this memory limit.
    ///
    /// # Errors
    /// Same as [`Solver::analyse`].
    pub(crate) fn analyse_within<'m>(
        matrices: impl Into<Matrices<'m>>,
        memory: Memory,
    ) -> Result<Self, FactorError> {
        let matrices = matrices.into();
        let (pattern, layers) = matrices.shape();
        let elimination = cell_order(pattern)?;
        match Factor::with(matrices, &elimination, memory) {
            Ok(factor) => Ok(factor.into()),
            Err(FactorError::Memory { .. } | FactorError::OutOfMemory) => {
                Ok(Self(Kind::Gradients {
                    gradients: Box::new(Gradients::new(matrices, Gradients::TOLERANCE)?),
                    instead_of: bytes(&elimination, layers),
                }))
            }
            Err(error) => Err(error),
        }
    }

    /// Conjugate gradients, without an analysis, for a residual of this share of the right-hand side.
    ///
    /// # Errors
    /// [`FactorError`] when there is no memory for them.
    pub(crate) fn without_factor<'m>(
        matrices: impl Into<Matrices<'m>>,
        tolerance: f64,
    ) -> Result<Self, FactorError> {
        let gradients = Box::new(Gradients::new(matrices.into(), tolerance)?);
        Ok(Self(Kind::Gradients {
            gradients,
            instead_of: 0,
        }))
    }

    /// The factor, if it is one.
    #[must_use]
    pub(crate) fn into_factor(self) -> Option<Factor> {
        match self.0 {
            Kind::Factor(factor) => Some(*factor),
            Kind::Gradients { .. } => None,
        }
    }

    /// Factorises a combination of the matrices, or prepares conjugate gradients for it.
    ///
    /// # Errors
    /// [`FactorError::NotPositiveDefinite`].
    pub fn prepare<'m>(
        &mut self,
        matrices: impl Into<Matrices<'m>>,
        combination: Combination,
    ) -> Result<(), FactorError> {
        match &mut self.0 {
            Kind::Factor(factor) => factor.factorise(matrices, combination),
            Kind::Gradients { gradients, .. } => gradients.prepare(matrices.into(), combination),
        }
    }

    /// Replaces `right_hand_side` by the solution. Allocates nothing.
    ///
    /// # Errors
    /// [`FactorError::NotConverged`] and [`FactorError::NotPositiveDefinite`] of conjugate gradients.
    ///
    /// # Panics
    /// If it is shorter than the matrix.
    pub fn solve(&mut self, right_hand_side: &mut [f64]) -> Result<(), FactorError> {
        match &mut self.0 {
            Kind::Factor(factor) => {
                factor.solve(right_hand_side);
                Ok(())
            }
            Kind::Gradients { gradients, .. } => gradients.solve(right_hand_side),
        }
    }

    /// Replaces `residual` by an approximate solution: the exact one of a factor, or a cycle of the preconditioner of conjugate
    /// gradients. Allocates nothing.
    ///
    /// # Errors
    /// Same as [`Solver::solve`].
    ///
    /// # Panics
    /// If it is shorter than the matrix.
    pub fn precondition(&mut self, residual: &mut [f64]) -> Result<(), FactorError> {
        match &mut self.0 {
            Kind::Factor(_) => self.solve(residual),
            Kind::Gradients { gradients, .. } => {
                gradients.precondition(residual);
                Ok(())
            }
        }
    }

    /// A sentence on how equations are solved, if not with a factor.
    #[must_use]
    pub fn remark(&self) -> Option<String> {
        let Kind::Gradients {
            gradients,
            instead_of,
        } = &self.0
        else {
            return None;
        };
        let (solves, iterations) = gradients.counts();
        let mean = iterations as f64 / solves.max(1) as f64;
        let megabytes = (*instead_of as f64 / 1e6).ceil();
        Some(format!(
            "equations were solved by conjugate gradients, in {mean:.0} iterations on average: a factor would take about {megabytes:.0} MB, more than there is"
        ))
    }
}
