//! Directions of Newton's method computed with a factor.

use std::sync::Arc;

use sinew_core::{BlockMatrix, ElasticLaw, Layers, Pattern, StepReport, TangentKind};

use super::equations::Equations;
use super::newton_error::NoDirection;
use super::unsymmetric::Unsymmetric;
use crate::implicit::factor::{Factor, Matrices};
use crate::implicit::factor_error::FactorError;

/// Inputs of a factorisation that is made when it is needed.
#[derive(Debug)]
pub(super) struct Plan {
    pattern: Arc<Pattern>,
    layers: Layers,
    /// Damping that is proportional to neither masses nor tangent.
    extra: Option<Arc<BlockMatrix>>,
    dofs: usize,
    /// True if a part of the derivative is not symmetric.
    is_unsymmetric: bool,
    /// A factor made earlier, whose analysis may be reused.
    known: Option<Factor>,
}

impl Plan {
    pub(super) fn new(
        law: &dyn ElasticLaw,
        layers: Layers,
        dofs: usize,
        known: Option<Factor>,
    ) -> Self {
        Self {
            pattern: Arc::clone(law.pattern()),
            layers,
            extra: law.damping().extra.clone(),
            dofs,
            is_unsymmetric: law.damping().stiffness != 0.0 || law.loads_follow(),
            known,
        }
    }

    pub(super) fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    /// True if the derivative is symmetric.
    pub(super) fn is_symmetric(&self) -> bool {
        !self.is_unsymmetric
    }

    pub(super) fn into_factor(self) -> Option<Factor> {
        self.known
    }
}

/// A tangent and its factor, made in each iteration, so that a solution is a function of its starting point.
#[derive(Debug)]
pub(super) struct ByFactor {
    factor: Factor,
    tangent: BlockMatrix,
    /// Damping that is proportional to neither masses nor tangent, on the tangent's pattern.
    extra: Option<BlockMatrix>,
    unsymmetric: Unsymmetric,
}

impl ByFactor {
    /// Analyses the pattern, or reuses the analysis of a suitable factor; allocates all that iterations need.
    pub(super) fn new(plan: &mut Plan) -> Result<Self, FactorError> {
        let zeros = || BlockMatrix::zeros(Arc::clone(&plan.pattern), plan.layers);
        let tangent = zeros();
        let extra = plan.extra.as_deref().map(|extra| {
            let mut own = zeros();
            own.set_to(extra).map(|()| own)
        });
        let extra = extra.transpose().map_err(|_| FactorError::Pattern)?;
        let matrices = Matrices {
            mass: &[],
            stiffness: &tangent,
            extra: None,
        };
        let factor = match plan.known.take().filter(|factor| factor.fits(matrices)) {
            Some(factor) => factor,
            None => Factor::analyse(matrices)?,
        };
        let mut unsymmetric = Unsymmetric::default();
        if plan.is_unsymmetric {
            unsymmetric.reserve(plan.dofs);
        }
        Ok(Self {
            factor,
            tangent,
            extra,
            unsymmetric,
        })
    }

    pub(super) fn into_factor(self) -> Factor {
        self.factor
    }

    /// Computes the direction at `x` with a kind of tangent.
    pub(super) fn direct(
        &mut self,
        equations: &mut impl Equations,
        kind: TangentKind,
        (x, residual): (&[f64], &[f64]),
        direction: &mut [f64],
        work: &mut StepReport,
    ) -> Result<(), NoDirection> {
        let tangent = equations.tangent(x, kind, &mut self.tangent);
        tangent.map_err(NoDirection::Refused)?;
        work.sweeps += 1 + 2 * equations.viscous_sweeps();
        work.factorizations += 1;
        let (mass, combination) = equations.derivative();
        let matrices = Matrices {
            mass,
            stiffness: &self.tangent,
            extra: self.extra.as_ref(),
        };
        let factorised = self.factor.factorise(matrices, combination);
        factorised.map_err(NoDirection::Singular)?;
        for (direction, residual) in direction.iter_mut().zip(residual) {
            *direction = -residual;
        }
        self.factor.solve(direction);
        work.solves += 1;
        if kind == TangentKind::Exact {
            let skew = |change: &[f64], out: &mut [f64]| equations.skew_product(x, change, out);
            let solves = self.unsymmetric.solve(&mut self.factor, skew, direction);
            work.solves += solves;
            work.sweeps += (solves + 1) * equations.viscous_sweeps();
        }
        Ok(())
    }
}
