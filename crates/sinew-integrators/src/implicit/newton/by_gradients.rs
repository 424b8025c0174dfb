//! Conjugate gradients in a step, with their block preconditioners.

use sinew_core::{EvaluationError, Layers, Pattern, StepReport, TangentKind};

use super::at_rest::are_less_work;
use super::by_products::{Gradients, Products, Solved};
use super::choice::{Bound, Choice};
use super::equations::Point;

/// Iterations in a step with the blocks at rest from which on the blocks at the current state are worth their sweeps.
const BY_BLOCKS_AT_REST: u64 = 30;

/// Conjugate gradients with the blocks at rest, and in steps with many iterations with those at the current state.
/// Blocks of an earlier step are never used: the bits of a step are a function of the state.
pub(super) struct ByGradients {
    gradients: Gradients,
    choice: Choice,
    /// Inverse blocks at rest, if known.
    at_rest: Option<Vec<f64>>,
    /// True while the preconditioner consists of them.
    has_rest: bool,
    in_step: u64,
}

impl ByGradients {
    pub(super) fn new(layers: Layers, dofs: usize) -> Self {
        Self {
            gradients: Gradients::new(layers, dofs),
            choice: Choice::default(),
            at_rest: None,
            has_rest: false,
            in_step: 0,
        }
    }

    /// Computes and stores the blocks at rest, if possible.
    pub(super) fn take_rest(&mut self, at_rest: &mut dyn Products, work: &mut StepReport) {
        work.sweeps += 1;
        self.has_rest = self.gradients.prepare(at_rest).is_ok();
        self.at_rest = self.has_rest.then(|| self.gradients.inverse().to_vec());
    }

    /// True if a factor on this pattern is more work than conjugate gradients, estimated for the body at rest.
    pub(super) fn are_less_work(
        &mut self,
        at_rest: &mut dyn Products,
        (weights, pattern): (&[f64], &Pattern),
        work: &mut StepReport,
    ) -> bool {
        let choice = (&mut self.choice, pattern);
        !self.has_rest || are_less_work(&mut self.gradients, at_rest, weights, choice, work)
    }

    /// Iterations in this step.
    pub(super) fn in_step(&self) -> u64 {
        self.in_step
    }

    /// Iterations after which a step continues with a factor on this pattern.
    pub(super) fn bound_in_step(&mut self, pattern: &Pattern) -> u64 {
        self.choice.bound(Bound::InStep, pattern)
    }

    /// Begins a step.
    pub(super) fn begin(&mut self) {
        self.in_step = 0;
        if let Some(at_rest) = &self.at_rest
            && !self.has_rest
        {
            self.gradients.take_inverse(at_rest);
            self.has_rest = true;
        }
    }

    /// Begins a solution at a point.
    ///
    /// # Errors
    /// Same as [`Products::blocks`].
    pub(super) fn begin_solution(
        &mut self,
        products: &mut dyn Products,
        (point, weights): (&Point, &[f64]),
        direction: &mut [f64],
        work: &mut StepReport,
    ) -> Result<(), EvaluationError> {
        let takes_blocks = match self.has_rest {
            true => self.in_step >= BY_BLOCKS_AT_REST,
            false => self.in_step == 0,
        };
        if takes_blocks {
            work.sweeps += 1;
            self.gradients.prepare(products)?;
            self.has_rest = false;
        }
        self.gradients.begin(&point.residual, weights, direction);
        Ok(())
    }

    /// Continues until a share of the residual is left, or until the step has taken `most` iterations.
    ///
    /// # Errors
    /// Same as [`Products::product`].
    pub(super) fn go_on(
        &mut self,
        products: (&mut dyn Products, TangentKind),
        weights: &[f64],
        (share, most): (f64, u64),
        direction: &mut [f64],
        work: &mut StepReport,
    ) -> Result<Solved, EvaluationError> {
        let nearness = (share, most.saturating_sub(self.in_step));
        let counts = (&mut self.in_step, work);
        self.gradients
            .go_on(products, weights, nearness, direction, counts)
    }
}
