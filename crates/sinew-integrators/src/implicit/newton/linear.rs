//! Solver of the linear equations of Newton's method.

use sinew_core::{ElasticLaw, Layers, StepReport, TangentKind};

use super::by_factor::{ByFactor, Plan};
use super::by_gradients::ByGradients;
use super::by_products::{Products, Solved};
use super::choice::{Bound, Choice};
use super::counts::{Counts, Reason};
use super::equations::{Equations, Point};
use super::factor_use::FactorUse;
use super::forcing::Forcing;
use super::newton_error::NoDirection;
use super::settings::NewtonSettings;
use crate::implicit::factor::Factor;
use crate::implicit::factor_error::FactorError;

/// Largest number of iterations of conjugate gradients in a step if no factor is available instead.
const MOST: u64 = 20_000;

/// Newton iterations with products after which a factor is tried.
const MOST_BY_PRODUCTS: u64 = 30;

/// Method to compute a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    Products,
    Factor,
}

/// A direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Direction {
    /// A solution.
    Solution,
    /// A descent direction found before a direction along which the tangent is not positive; it has no natural length.
    Beginning,
}

/// Conjugate gradients, or a factor made in each iteration: with both, a solution is a function of its starting point.
pub(super) struct Linear {
    factor_use: FactorUse,
    tolerance: f64,
    plan: Plan,
    by_factor: Option<Box<ByFactor>>,
    by_gradients: Option<Box<ByGradients>>,
    way: Way,
    /// True if the next step begins with a factor.
    insists: bool,
    /// True after memory for a factor was insufficient.
    lacks_memory: bool,
    forcing: Forcing,
    counts: Counts,
}

impl Linear {
    /// Analyses the pattern if a factor is always used, and otherwise tests the derivative at rest, if any.
    pub(super) fn set_up(
        (law, layers): (&dyn ElasticLaw, Layers),
        weights: &[f64],
        settings: NewtonSettings,
        known: Option<Factor>,
        at_rest: Option<&mut dyn Products>,
        work: &mut StepReport,
    ) -> Result<Self, FactorError> {
        let mut plan = Plan::new(law, layers, weights.len(), known);
        let (mut by_factor, mut by_gradients) = (None, None);
        let takes_factor = match settings.factor {
            FactorUse::Always => true,
            FactorUse::Never => false,
            FactorUse::Auto => Choice::is_clear(plan.pattern()),
        };
        if !takes_factor {
            by_gradients = Some(Box::new(ByGradients::new(layers, weights.len())));
        }
        let mut goes_on = by_gradients.is_some();
        if let (Some(by_gradients), Some(at_rest)) = (&mut by_gradients, at_rest) {
            by_gradients.take_rest(at_rest, work);
            if settings.factor == FactorUse::Auto {
                goes_on = by_gradients.are_less_work(at_rest, (weights, plan.pattern()), work);
            }
        }
        let mut lacks_memory = false;
        if !goes_on {
            match ByFactor::new(&mut plan) {
                Ok(made) => (by_factor, by_gradients) = (Some(Box::new(made)), None),
                // Conjugate gradients are what there is, however long they take.
                Err(FactorError::Memory { .. } | FactorError::OutOfMemory) if !takes_factor => {
                    lacks_memory = true;
                }
                Err(error) => return Err(error),
            }
        }
        Ok(Self {
            factor_use: settings.factor,
            tolerance: settings.tolerance,
            forcing: Forcing::new(settings.tolerance, plan.is_symmetric()),
            plan,
            by_factor,
            by_gradients,
            way: Way::Factor,
            insists: false,
            lacks_memory,
            counts: Counts::default(),
        })
    }

    pub(super) fn into_factor(self) -> Option<Factor> {
        match self.by_factor {
            Some(by_factor) => Some(by_factor.into_factor()),
            None => self.plan.into_factor(),
        }
    }

    /// Begins a step.
    pub(super) fn begin(&mut self) {
        self.forcing = Forcing::new(self.tolerance, self.plan.is_symmetric());
        self.counts.steps += 1;
        let insists = std::mem::take(&mut self.insists);
        self.way = match &mut self.by_gradients {
            Some(by_gradients) if !insists => {
                by_gradients.begin();
                Way::Products
            }
            _ => Way::Factor,
        };
    }

    /// Begins an iteration with this residual over the size of the forces.
    pub(super) fn begin_iteration(&mut self, iteration: u64, residual: f64) {
        self.forcing.at(residual);
        if iteration >= MOST_BY_PRODUCTS {
            self.take_factor(Reason::Stuck);
        }
    }

    /// Continues this step with a factor, if there is a choice and memory for one; returns true if it did not use one
    /// before.
    pub(super) fn take_factor(&mut self, reason: Reason) -> bool {
        if self.way == Way::Factor || self.factor_use == FactorUse::Never || self.lacks_memory {
            return false;
        }
        if self.by_factor.is_none() {
            match ByFactor::new(&mut self.plan) {
                Ok(by_factor) => self.by_factor = Some(Box::new(by_factor)),
                // Conjugate gradients are all there is.
                Err(_) => {
                    self.lacks_memory = true;
                    return false;
                }
            }
        }
        self.way = Way::Factor;
        self.counts.went_on(reason);
        true
    }

    /// Uses only a factor for the restarted step; returns false if there is none, or if it was used already.
    pub(super) fn insist_on_factor(&mut self) -> bool {
        if self.by_gradients.is_some() {
            self.take_factor(Reason::Stuck);
            self.insists = self.way == Way::Factor && self.by_factor.is_some();
        }
        self.insists
    }

    /// Computes the direction at a point with a kind of tangent.
    pub(super) fn direct(
        &mut self,
        equations: &mut impl Equations,
        kind: TangentKind,
        (point, weights): (&Point, &[f64]),
        direction: &mut [f64],
        work: &mut StepReport,
    ) -> Result<Direction, NoDirection> {
        if self.way == Way::Products {
            let solved = self.by_products(equations, kind, (point, weights), direction, work)?;
            match solved {
                Some(Solved::Near(left) | Solved::Unfinished(left)) => {
                    self.forcing.left(left);
                    return Ok(Direction::Solution);
                }
                Some(Solved::NotDefinite(Some(left))) => {
                    self.forcing.left(left);
                    return Ok(Direction::Beginning);
                }
                Some(Solved::NotDefinite(None)) => {
                    let none = NoDirection::Singular(FactorError::NotPositiveDefinite);
                    return Err(none);
                }
                None => {}
            }
        }
        let Some(by_factor) = &mut self.by_factor else {
            return Err(NoDirection::Singular(FactorError::NotPositiveDefinite));
        };
        self.forcing.left(0.0);
        let at = (&*point.x, &*point.residual);
        by_factor.direct(equations, kind, at, direction, work)?;
        Ok(Direction::Solution)
    }

    /// Solves with products; `None` if it changed to a factor instead.
    fn by_products(
        &mut self,
        equations: &mut impl Equations,
        kind: TangentKind,
        (point, weights): (&Point, &[f64]),
        direction: &mut [f64],
        work: &mut StepReport,
    ) -> Result<Option<Solved>, NoDirection> {
        // Projections are made in plain numbers: for a factor too, but once.
        if kind != TangentKind::Exact && self.take_factor(Reason::Indefinite) {
            return Ok(None);
        }
        self.counts.solutions += 1;
        let mut most = match self.factor_use {
            FactorUse::Never => MOST,
            FactorUse::Auto | FactorUse::Always => Bound::InStep.least(),
        };
        let mut is_begun = false;
        loop {
            let products = equations.products_at(&point.x);
            let (Some(by_gradients), Some(products)) = (&mut self.by_gradients, products) else {
                return Err(NoDirection::Singular(FactorError::NotPositiveDefinite));
            };
            let before = by_gradients.in_step();
            let begun = match is_begun {
                true => Ok(()),
                false => by_gradients.begin_solution(products, (point, weights), direction, work),
            };
            is_begun = true;
            let nearness = (self.forcing.share(), most);
            let solved = begun.and_then(|()| {
                by_gradients.go_on((products, kind), weights, nearness, direction, work)
            });
            self.counts.iterations += by_gradients.in_step() - before;
            let solved = solved.map_err(NoDirection::Refused)?;
            if !matches!(solved, Solved::Unfinished(_)) || most >= MOST {
                return Ok(Some(solved));
            }
            let bound = by_gradients.bound_in_step(self.plan.pattern());
            if by_gradients.in_step() < bound {
                most = bound;
            } else if self.take_factor(Reason::Work) {
                return Ok(None);
            } else {
                most = MOST;
            }
        }
    }

    /// Sets the share of the direction that was taken.
    pub(super) fn gone(&mut self, share: f64) {
        self.forcing.gone(share);
    }

    /// Mean iterations of conjugate gradients for a solution, if they were used.
    pub(super) fn iterations_a_solution(&self) -> Option<f64> {
        self.counts.iterations_a_solution()
    }

    /// A sentence on how equations are solved, if there was a choice.
    pub(super) fn remark(&self) -> Option<String> {
        let is_choice = self.factor_use != FactorUse::Always;
        let is_choice = is_choice && !Choice::is_clear(self.plan.pattern());
        is_choice.then(|| self.counts.in_words())
    }
}
