//! Conjugate gradients.

use std::sync::Arc;

use sinew_core::BlockMatrix;
use sinew_core::vectors::{add_scaled, dot, norm};

use super::matrices::{Combination, Matrices};
use super::two_grid::TwoGrid;
use crate::implicit::factor_error::FactorError;

/// Largest number of iterations of a solution.
const MOST_ITERATIONS: u32 = 5000;

/// Preconditioned conjugate gradients (Saad, Iterative Methods for Sparse Linear Systems, algorithm 9.1) with a combination of matrices.
#[derive(Debug)]
pub(super) struct Gradients {
    matrix: BlockMatrix,
    preconditioner: TwoGrid,
    /// Residual over the right-hand side at which a solution is done.
    tolerance: f64,
    solution: Vec<f64>,
    direction: Vec<f64>,
    image: Vec<f64>,
    preconditioned: Vec<f64>,
    solves: u64,
    iterations: u64,
}

impl Gradients {
    /// The tolerance of conjugate gradients that replace a factor.
    pub(super) const TOLERANCE: f64 = 1e-12;

    pub(super) fn new(matrices: Matrices<'_>, tolerance: f64) -> Result<Self, FactorError> {
        let (pattern, layers) = matrices.shape();
        let matrix = BlockMatrix::zeros(Arc::clone(pattern), layers);
        let vector = || vec![0.0; matrix.dofs()];
        Ok(Self {
            preconditioner: TwoGrid::new(&matrix)?,
            tolerance,
            solution: vector(),
            direction: vector(),
            image: vector(),
            preconditioned: vector(),
            solves: 0,
            iterations: 0,
            matrix,
        })
    }

    /// Takes a combination of the matrices.
    pub(super) fn prepare(
        &mut self,
        matrices: Matrices<'_>,
        combination: Combination,
    ) -> Result<(), FactorError> {
        let matrix = &mut self.matrix;
        let layers = matrix.layers().count();
        let pattern = |_| FactorError::Pattern;
        matrix.set_to(matrices.stiffness).map_err(pattern)?;
        matrix.scale(combination.stiffness);
        if let Some(extra) = matrices.extra {
            matrix
                .add_scaled(combination.extra, extra)
                .map_err(pattern)?;
        }
        for cell in 0..matrix.pattern().cells() {
            for (other, block) in matrix.row_blocks_mut(cell) {
                if other != cell {
                    continue;
                }
                for (layer, entry) in block.iter_mut().step_by(layers + 1).enumerate() {
                    if combination.mass != 0.0 {
                        *entry += combination.mass * matrices.mass[cell * layers + layer];
                    }
                    if *entry == 0.0 {
                        // A fixed component: no force, no displacement.
                        *entry = 1.0;
                    }
                }
            }
        }
        self.preconditioner.prepare(&self.matrix)
    }

    /// Replaces a right-hand side by the solution.
    pub(super) fn solve(&mut self, residual: &mut [f64]) -> Result<(), FactorError> {
        let Self {
            matrix,
            preconditioner,
            solution,
            direction,
            image,
            preconditioned,
            ..
        } = self;
        self.solves += 1;
        solution.fill(0.0);
        let aim = self.tolerance * norm(residual);
        if aim == 0.0 {
            return Ok(());
        }
        preconditioner.apply(matrix, residual, preconditioned);
        direction.copy_from_slice(preconditioned);
        let mut along = dot(residual, preconditioned);
        for _ in 0..MOST_ITERATIONS {
            self.iterations += 1;
            matrix.multiply(direction, image);
            let curvature = dot(direction, image);
            // False for NaN too.
            if !(curvature > 0.0 && along > 0.0) {
                return Err(FactorError::NotPositiveDefinite);
            }
            let step = along / curvature;
            add_scaled(step, direction, solution);
            add_scaled(-step, image, residual);
            if norm(residual) <= aim {
                residual.copy_from_slice(solution);
                return Ok(());
            }
            preconditioner.apply(matrix, residual, preconditioned);
            let next = dot(residual, preconditioned);
            let share = next / along;
            along = next;
            for (direction, own) in direction.iter_mut().zip(preconditioned.iter()) {
                *direction = own + share * *direction;
            }
        }
        Err(FactorError::NotConverged {
            iterations: MOST_ITERATIONS,
        })
    }

    /// Replaces a residual by the preconditioned one.
    pub(super) fn precondition(&mut self, residual: &mut [f64]) {
        self.preconditioner
            .apply(&self.matrix, residual, &mut self.preconditioned);
        residual.copy_from_slice(&self.preconditioned);
    }

    /// Solutions so far, and the iterations that they took.
    pub(super) fn counts(&self) -> (u64, u64) {
        (self.solves, self.iterations)
    }
}
