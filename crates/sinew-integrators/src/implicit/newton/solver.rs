//! Newton's method with a line search, and projection on demand.

use sinew_core::vectors::{add_scaled, dot, weighted_dot};
use sinew_core::{ElasticLaw, EvaluationError, Layers, StepReport, TangentKind};

use super::by_products::Products;
use super::counts::Reason;
use super::equations::{Equations, Point};
use super::linear::{Direction, Linear};
use super::newton_error::{NewtonError, NoDirection};
use super::settings::NewtonSettings;
use crate::implicit::factor::Factor;
use crate::implicit::factor_error::FactorError;

/// Halvings of a step along the exact tangent's direction before the projected one is tried.
const HALVINGS_OF_EXACT: u32 = 4;

/// Halvings of a step along a [`Direction::Beginning`], which a nearly indefinite tangent makes long, before the
/// projected tangent is tried.
const HALVINGS_OF_BEGINNING: u32 = 12;

/// Halvings of a step along the projected tangent's direction before the search is given up.
const MOST_HALVINGS: u32 = 30;

/// Doublings of a step along the projected tangent's direction.
const MOST_DOUBLINGS: u32 = 30;

/// The share of the descent predicted by the slope that a step must achieve (Armijo).
const ARMIJO: f64 = 1e-4;

/// Share of the energies below which their change is not trusted, and slopes decide (Hager and Zhang, SIAM J. Optim.
/// 16, 2005): in a body strained by 1e-6 the rounding of positions removes ten digits of the energy, and four of the
/// forces.
const DOUBTFUL: f64 = 1e-6;

/// The share of a slope that may be left, with the opposite sign, if slopes decide.
const OVERSHOT: f64 = 0.5;

/// Change of the potential from one point to another at a distance of a share of `along`, and the size of its terms.
/// Forces without an energy count with the mean of both ends, which is exact if they are linear, as inertia, loads and
/// viscous damping are.
fn change(from: &Point, to: &Point, along: &[f64], share: f64) -> (f64, f64) {
    let [before, after] = [from, to].map(|point| share * point.other_slope(along));
    let others = 0.5 * (before + after);
    let size = from.energy.abs() + to.energy.abs() + before.abs() + after.abs();
    (to.energy - from.energy + others, size)
}

/// Outcome of an iteration.
enum Iterated {
    Moved,
    /// The next change is lost in rounding.
    AtRounding,
    Stuck,
}

/// Newton's method with a line search, and projection if the exact tangent gives no descent (Longva et al.,
/// arXiv 2311.14526, 2023).
pub(super) struct Newton {
    settings: NewtonSettings,
    pub(super) linear: Linear,
    /// Weights of the squares in the norm of forces.
    weights: Vec<f64>,
    direction: Vec<f64>,
    /// The best point so far, at which the iteration begins.
    pub(super) point: Point,
    /// The next trial.
    pub(super) trial: Point,
    /// The last refusal, and the iterations before it.
    refusal: Option<(u64, EvaluationError)>,
    /// Iterations taken.
    iterations: u64,
    singular: Option<FactorError>,
}

impl Newton {
    /// Allocates all that iterations need, except a factor that may not be needed; `at_rest` is the derivative at rest,
    /// for conjugate gradients.
    pub(super) fn set_up(
        (law, layers): (&dyn ElasticLaw, Layers),
        weights: Vec<f64>,
        settings: NewtonSettings,
        known: Option<Factor>,
        at_rest: Option<&mut dyn Products>,
        work: &mut StepReport,
    ) -> Result<Self, FactorError> {
        let linear = Linear::set_up((law, layers), &weights, settings, known, at_rest, work)?;
        let dofs = weights.len();
        Ok(Self {
            settings,
            linear,
            weights,
            direction: vec![0.0; dofs],
            point: Point::new(dofs),
            trial: Point::new(dofs),
            refusal: None,
            iterations: 0,
            singular: None,
        })
    }

    /// Replaces the point by the trial if only the trial is defined, or if the trial has the lower potential.
    ///
    /// # Errors
    /// The refusal of the point if neither is defined.
    pub(super) fn take_better(
        &mut self,
        point: Result<(), EvaluationError>,
        trial: &Result<(), EvaluationError>,
    ) -> Result<(), EvaluationError> {
        match (point, trial) {
            (Ok(()), Ok(())) => self.take_lower(),
            (Ok(()), Err(_)) => {}
            (Err(_), Ok(())) => self.take_trial(),
            (Err(refusal), Err(_)) => return Err(refusal),
        }
        Ok(())
    }

    /// Replaces the point by the trial if the trial has the lower potential.
    pub(super) fn take_lower(&mut self) {
        self.direction.copy_from_slice(&self.trial.x);
        add_scaled(-1.0, &self.point.x, &mut self.direction);
        let (change, _) = change(&self.point, &self.trial, &self.direction, 1.0);
        if change < 0.0 {
            self.take_trial();
        }
    }

    /// Replaces the point by the trial.
    pub(super) fn take_trial(&mut self) {
        std::mem::swap(&mut self.point, &mut self.trial);
    }

    /// Moves the point, which is evaluated, until its forces balance.
    pub(super) fn solve(
        &mut self,
        equations: &mut impl Equations,
        work: &mut StepReport,
    ) -> Result<(), NewtonError> {
        (self.refusal, self.singular, self.iterations) = (None, None, 0);
        self.linear.begin();
        loop {
            let residual = self.residual(equations);
            if residual <= self.settings.tolerance {
                return Ok(());
            }
            let iterations = self.iterations;
            let failure = |reason| NewtonError::Unbalanced {
                iterations,
                residual,
                reason,
            };
            if iterations >= u64::from(self.settings.most_iterations) {
                let taken = "the most iterations allowed were taken";
                return Err(match self.refusal.take() {
                    Some((at, refusal)) if at + 1 >= iterations => NewtonError::Refused(refusal),
                    Some((_, refusal)) => {
                        failure(format!("{taken}, and one of them led where {refusal}"))
                    }
                    None => failure(taken.to_owned()),
                });
            }
            work.newton_iterations += 1;
            self.linear.begin_iteration(iterations, residual);
            let mut iterated = self.iterate(equations, work);
            if matches!(iterated, Iterated::Stuck) && self.linear.take_factor(Reason::Stuck) {
                iterated = self.iterate(equations, work);
            }
            if self
                .refusal
                .as_ref()
                .is_some_and(|(at, _)| *at == iterations)
            {
                // Near the end of a law directions have to be exact.
                self.linear.take_factor(Reason::Stuck);
            }
            match iterated {
                Iterated::Moved => self.iterations += 1,
                Iterated::AtRounding => return Ok(()),
                Iterated::Stuck => {
                    let refusal = self.refusal.take().filter(|(at, _)| *at == iterations);
                    return Err(match (refusal, self.singular.take()) {
                        (Some((_, refusal)), _) => NewtonError::Refused(refusal),
                        (None, Some(error)) => NewtonError::Singular(error),
                        (None, None) => failure("no step along the tangent leads down".to_owned()),
                    });
                }
            }
        }
    }

    /// Residual over the size of the forces.
    fn residual(&self, equations: &impl Equations) -> f64 {
        let residual = &self.point.residual;
        let residual = weighted_dot(&self.weights, residual, residual).sqrt();
        if residual == 0.0 {
            return 0.0;
        }
        residual / equations.forces(&self.point, &self.weights)
    }

    fn iterate(&mut self, equations: &mut impl Equations, work: &mut StepReport) -> Iterated {
        self.singular = None;
        for (kind, halvings) in [
            (TangentKind::Exact, HALVINGS_OF_EXACT),
            (TangentKind::Frozen, MOST_HALVINGS),
        ] {
            let Some(direction) = self.direct(equations, kind, work) else {
                continue;
            };
            if equations.is_rounding(&self.point, &self.direction) {
                return Iterated::AtRounding;
            }
            let slope = dot(&self.point.residual, &self.direction);
            let halvings = match direction {
                Direction::Solution => halvings,
                Direction::Beginning => halvings.max(HALVINGS_OF_BEGINNING),
            };
            if slope < 0.0
                && let Some(share) = self.search(equations, slope, halvings, work)
            {
                self.linear.gone(share);
                let is_whole = kind == TangentKind::Exact && direction == Direction::Solution;
                if !is_whole && share == 1.0 {
                    self.lengthen(equations, slope, work);
                }
                return Iterated::Moved;
            }
        }
        Iterated::Stuck
    }

    /// Computes the direction with a kind of tangent, if this tangent gives one.
    fn direct(
        &mut self,
        equations: &mut impl Equations,
        kind: TangentKind,
        work: &mut StepReport,
    ) -> Option<Direction> {
        let at = (&self.point, &*self.weights);
        let found = self
            .linear
            .direct(equations, kind, at, &mut self.direction, work);
        self.singular = None;
        match found {
            Ok(direction) => {
                work.projected_solves += u64::from(kind != TangentKind::Exact);
                return Some(direction);
            }
            Err(NoDirection::Refused(refusal)) => self.refusal = Some((self.iterations, refusal)),
            Err(NoDirection::Singular(error)) => self.singular = Some(error),
        }
        None
    }

    /// Halves the step until the potential decreases sufficiently (Armijo's condition); returns the share of the step
    /// taken.
    fn search(
        &mut self,
        equations: &mut impl Equations,
        slope: f64,
        halvings: u32,
        work: &mut StepReport,
    ) -> Option<f64> {
        let mut share = 1.0;
        for _ in 0..=halvings {
            self.trial.x.copy_from_slice(&self.point.x);
            add_scaled(share, &self.direction, &mut self.trial.x);
            match equations.evaluate(&mut self.trial, work) {
                Err(refusal) => self.refusal = Some((self.iterations, refusal)),
                Ok(()) if self.trial.is_finite() => {
                    let (rise, size) = change(&self.point, &self.trial, &self.direction, share);
                    let left = dot(&self.trial.residual, &self.direction);
                    let by_slopes = rise <= DOUBTFUL * size && left <= OVERSHOT * -slope;
                    if rise <= ARMIJO * share * slope || by_slopes {
                        self.take_trial();
                        return Some(share);
                    }
                }
                Ok(()) => {}
            }
            work.backtracks += 1;
            share *= 0.5;
        }
        None
    }

    /// Continues along the direction, each time twice as far, as long as the potential decreases: a projected tangent,
    /// stiffer than the law or without any stiffness, gives no reliable length.
    fn lengthen(&mut self, equations: &mut impl Equations, slope: f64, work: &mut StepReport) {
        let mut share = 1.0;
        for _ in 0..MOST_DOUBLINGS {
            self.trial.x.copy_from_slice(&self.point.x);
            add_scaled(share, &self.direction, &mut self.trial.x);
            if equations.evaluate(&mut self.trial, work).is_err() || !self.trial.is_finite() {
                return;
            }
            let (rise, _) = change(&self.point, &self.trial, &self.direction, share);
            // A comparison that is false for NaN too.
            if rise <= ARMIJO * share * slope {
                self.take_trial();
                share *= 2.0;
            } else {
                return;
            }
        }
    }
}
