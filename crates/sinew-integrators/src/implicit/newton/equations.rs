//! The equations that Newton's method solves, and points at which they are evaluated.

use sinew_core::vectors::dot;
use sinew_core::{BlockMatrix, EvaluationError, StepReport, TangentKind};

use super::by_products::Products;
use crate::implicit::factor::Combination;

/// Equations `g(x) = 0`, the elastic part of which is the gradient of an energy.
pub(super) trait Equations {
    /// Evaluates the point at its `x`.
    ///
    /// # Errors
    /// [`EvaluationError`] when the law is outside its domain there.
    fn evaluate(&mut self, point: &mut Point, work: &mut StepReport)
    -> Result<(), EvaluationError>;

    /// `out`: the part of dg/dx at `x` that is combined with masses and other damping, of a kind.
    ///
    /// # Errors
    /// Same as [`Equations::evaluate`].
    fn tangent(
        &mut self,
        x: &[f64],
        kind: TangentKind,
        out: &mut BlockMatrix,
    ) -> Result<(), EvaluationError>;

    /// The masses (kg), and the derivative of g as a combination of them, the tangent and the other damping.
    fn derivative(&self) -> (&[f64], Combination);

    /// Writes the skew part of the derivative at `x`, which is not in the tangent, times a change of x; returns true
    /// if there is any.
    fn skew_product(&mut self, _x: &[f64], _change: &[f64], _out: &mut [f64]) -> bool {
        false
    }

    /// Sweeps for stiffness damping that a tangent takes, and a product of the unsymmetric part.
    fn viscous_sweeps(&self) -> u64 {
        0
    }

    /// The derivative at `x` by its products, if available.
    fn products_at(&mut self, _x: &[f64]) -> Option<&mut dyn Products> {
        None
    }

    /// Size of the forces that balance each other at a point, in the norm with these weights.
    fn forces(&self, point: &Point, weights: &[f64]) -> f64;

    /// True if a change of x at a point is lost in the rounding of positions.
    fn is_rounding(&self, point: &Point, change: &[f64]) -> bool;
}

/// A point at which equations are evaluated.
#[derive(Debug, Default)]
pub(super) struct Point {
    /// The unknown.
    pub(super) x: Vec<f64>,
    /// g(x).
    pub(super) residual: Vec<f64>,
    /// The elastic part of g(x).
    pub(super) elastic: Vec<f64>,
    /// The energy whose gradient in x is the elastic part.
    pub(super) energy: f64,
}

impl Point {
    pub(super) fn new(dofs: usize) -> Self {
        let zeros = || vec![0.0; dofs];
        Self {
            x: zeros(),
            residual: zeros(),
            elastic: zeros(),
            energy: 0.0,
        }
    }

    pub(super) fn is_finite(&self) -> bool {
        self.energy.is_finite() && dot(&self.residual, &self.residual).is_finite()
    }

    /// The power of all forces except the elastic ones along a direction.
    pub(super) fn other_slope(&self, along: &[f64]) -> f64 {
        dot(&self.residual, along) - dot(&self.elastic, along)
    }
}
