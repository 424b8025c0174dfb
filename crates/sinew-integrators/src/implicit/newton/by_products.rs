//! Directions of Newton's method by conjugate gradients, without a matrix.

use sinew_core::vectors::{add_scaled, dot, weighted_dot};
use sinew_core::{EvaluationError, Layers, StepReport, TangentKind};

use crate::cell_factors::CellFactors;

/// The derivative of equations at a point, by its products.
pub(super) trait Products {
    /// `out`: the derivative of a kind, without its unsymmetric part, times a change of the unknown.
    ///
    /// # Errors
    /// [`EvaluationError`] when the law is outside its domain at the point.
    fn product(
        &mut self,
        kind: TangentKind,
        change: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError>;

    /// Sweeps that a product takes.
    fn sweeps(&self) -> u64;

    /// `out`: diagonal blocks of the cells of the derivative without inertia, or larger blocks.
    ///
    /// # Errors
    /// Same as [`Products::product`].
    fn blocks(&mut self, out: &mut [f64]) -> Result<(), EvaluationError>;

    /// Contribution of inertia to the diagonal of the blocks.
    fn inertia(&self, dof: usize) -> f64;
}

/// End of conjugate gradients, with the share of the right-hand side that the solution leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Solved {
    /// Converged to the requested share.
    Near(f64),
    /// Stopped at the maximum number of iterations.
    Unfinished(f64),
    /// Stopped at a direction along which A is not positive; `None` if it was the first.
    NotDefinite(Option<f64>),
}

/// Conjugate gradients (Saad, Iterative Methods for Sparse Linear Systems, algorithm 9.1), preconditioned by each
/// cell's diagonal block.
#[derive(Debug)]
pub(super) struct Gradients {
    layers: usize,
    blocks: CellFactors,
    /// Inverse blocks.
    inverse: Vec<f64>,
    residual: Vec<f64>,
    preconditioned: Vec<f64>,
    along: Vec<f64>,
    image: Vec<f64>,
    /// The residual times the preconditioned one.
    steepness: f64,
    /// Size of the right-hand side.
    size: f64,
    /// Share of it that is left.
    left: f64,
    /// True before the first step.
    is_first: bool,
}

impl Gradients {
    pub(super) fn new(layers: Layers, dofs: usize) -> Self {
        let zeros = || vec![0.0; dofs];
        let layers = layers.count();
        Self {
            layers,
            blocks: CellFactors::new(layers, dofs),
            inverse: vec![0.0; layers * dofs],
            residual: zeros(),
            preconditioned: zeros(),
            along: zeros(),
            image: zeros(),
            steepness: 0.0,
            size: 0.0,
            left: 1.0,
            is_first: true,
        }
    }

    /// Inverts diagonal blocks for the preconditioner.
    ///
    /// # Errors
    /// Same as [`Products::blocks`].
    pub(super) fn prepare(&mut self, products: &mut dyn Products) -> Result<(), EvaluationError> {
        products.blocks(self.blocks.entries_mut())?;
        self.blocks.factorise(|dof| products.inertia(dof));
        self.blocks.write_inverse(1.0, &mut self.inverse);
        Ok(())
    }

    /// The inverse blocks.
    pub(super) fn inverse(&self) -> &[f64] {
        &self.inverse
    }

    /// Reuses inverse blocks.
    pub(super) fn take_inverse(&mut self, inverse: &[f64]) {
        self.inverse.copy_from_slice(inverse);
    }

    /// Begins at x = 0 with `A x = -right`; the size of right-hand sides is the norm with these weights.
    pub(super) fn begin(&mut self, right: &[f64], weights: &[f64], x: &mut [f64]) {
        x.fill(0.0);
        for (residual, right) in self.residual.iter_mut().zip(right) {
            *residual = -right;
        }
        self.size = weighted_dot(weights, right, right).sqrt();
        (self.left, self.is_first) = (1.0, true);
        self.precondition();
        self.along.copy_from_slice(&self.preconditioned);
        self.steepness = dot(&self.residual, &self.preconditioned);
    }

    /// Continues until a share of the right-hand side is left, for `most` iterations at most; adds those taken to
    /// `iterations`.
    ///
    /// # Errors
    /// Same as [`Products::product`].
    pub(super) fn go_on(
        &mut self,
        (products, kind): (&mut dyn Products, TangentKind),
        weights: &[f64],
        (share, most): (f64, u64),
        x: &mut [f64],
        (iterations, work): (&mut u64, &mut StepReport),
    ) -> Result<Solved, EvaluationError> {
        for _ in 0..most {
            *iterations += 1;
            work.sweeps += products.sweeps();
            products.product(kind, &self.along, &mut self.image)?;
            let curvature = dot(&self.along, &self.image);
            // False for NaN too.
            if !(curvature > 0.0 && self.steepness > 0.0) {
                return Ok(Solved::NotDefinite((!self.is_first).then_some(self.left)));
            }
            self.is_first = false;
            let step = self.steepness / curvature;
            add_scaled(step, &self.along, x);
            add_scaled(-step, &self.image, &mut self.residual);
            let residual = &self.residual;
            self.left = weighted_dot(weights, residual, residual).sqrt() / self.size;
            if self.left <= share {
                return Ok(Solved::Near(self.left));
            }
            self.precondition();
            let before = self.steepness;
            self.steepness = dot(&self.residual, &self.preconditioned);
            let turn = self.steepness / before;
            for (along, own) in self.along.iter_mut().zip(&self.preconditioned) {
                *along = own + turn * *along;
            }
        }
        Ok(Solved::Unfinished(self.left))
    }

    fn precondition(&mut self) {
        let Self {
            inverse,
            residual,
            preconditioned,
            ..
        } = self;
        if self.layers == 3 {
            let cells = residual.as_chunks::<3>().0.iter();
            let cells = cells.zip(inverse.as_chunks::<9>().0);
            let out = preconditioned.as_chunks_mut::<3>().0.iter_mut();
            for (out, ([x, y, z], b)) in out.zip(cells) {
                // Rows are columns, as the inverse is symmetric.
                *out = [0, 1, 2].map(|k| b[k] * x + b[3 + k] * y + b[6 + k] * z);
            }
        } else {
            let entries = residual.iter().zip(inverse.iter());
            for (out, (residual, inverse)) in preconditioned.iter_mut().zip(entries) {
                *out = inverse * residual;
            }
        }
    }
}
