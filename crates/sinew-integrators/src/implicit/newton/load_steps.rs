//! Static equilibrium of a nonlinear law, followed in increments of the load.

use sinew_core::vectors::{add_scaled, dot, largest, weighted_dot};
use sinew_core::{
    BlockMatrix, ElasticLaw, EvaluationError, LoadTime, StaticLoad, StepReport, System,
    TangentKind, Trial,
};

use super::equations::{Equations, Point};
use super::factor_use::FactorUse;
use super::follow::{ByShare, Unreached, follow};
use super::newton_error::NewtonError;
use super::settings::NewtonSettings;
use super::solver::Newton;
use crate::implicit::factor::Combination;

/// Newton's method in a load increment.
const SETTINGS: NewtonSettings = NewtonSettings {
    tolerance: 1e-8,
    most_iterations: 25,
    factor: FactorUse::Always,
};

/// Change of positions, as a share of body and displacement, that has no effect.
const ROUNDING: f64 = 1e-12;

/// `dW/du = share F(u)`.
struct StaticEquations<'s> {
    system: &'s dyn System,
    law: &'s dyn ElasticLaw,
    load: &'s dyn StaticLoad,
    /// The part of the load that acts.
    share: f64,
    /// F (N) at the point evaluated.
    force: Vec<f64>,
    v: Vec<f64>,
    internal: Vec<f64>,
    extent: f64,
}

impl<'s> StaticEquations<'s> {
    /// A point after full relaxation.
    fn trial<'t>(&'t self, u: &'t [f64]) -> Trial<'t> {
        Trial {
            load: LoadTime::at(0.0),
            dt: f64::INFINITY,
            u,
            v: &self.v,
            internal: &self.internal,
        }
    }
}

impl Equations for StaticEquations<'_> {
    fn evaluate(
        &mut self,
        point: &mut Point,
        work: &mut StepReport,
    ) -> Result<(), EvaluationError> {
        work.sweeps += 1;
        let trial = self.trial(&point.x);
        point.energy = self.law.elastic_force(&trial, &mut point.elastic)?.energy;
        point.residual.copy_from_slice(&point.elastic);
        self.load.force(&point.x, &mut self.force);
        add_scaled(-self.share, &self.force, &mut point.residual);
        Ok(())
    }

    fn tangent(
        &mut self,
        x: &[f64],
        kind: TangentKind,
        out: &mut BlockMatrix,
    ) -> Result<(), EvaluationError> {
        self.law.tangent(&self.trial(x), kind, out)?;
        if kind == TangentKind::Exact {
            self.load.add_stiffness(x, self.share, out)?;
        }
        Ok(())
    }

    fn skew_product(&mut self, x: &[f64], change: &[f64], out: &mut [f64]) -> bool {
        self.load.skew_product(x, self.share, change, out)
    }

    fn derivative(&self) -> (&[f64], Combination) {
        (self.system.mass(), Combination::STATIC)
    }

    fn forces(&self, point: &Point, weights: &[f64]) -> f64 {
        let elastic = weighted_dot(weights, &point.elastic, &point.elastic).sqrt();
        elastic.max(self.share * dot(&self.force, &self.force).sqrt())
    }

    fn is_rounding(&self, point: &Point, change: &[f64]) -> bool {
        largest(change) <= ROUNDING * self.extent.max(largest(&point.x))
    }
}

impl ByShare for StaticEquations<'_> {
    fn take_share(&mut self, share: f64) {
        self.share = share;
    }
}

/// The displacement in equilibrium with a load, followed from the undeformed body.
pub(in crate::implicit) fn follow_load(
    system: &dyn System,
    law: &dyn ElasticLaw,
    load: &dyn StaticLoad,
) -> Result<Vec<f64>, Unreached> {
    let at_start = |error| Unreached { share: 0.0, error };
    let dofs = system.dofs();
    let (of, weights) = ((law, system.layers()), vec![1.0; dofs]);
    let mut work = StepReport::default();
    let mut newton = Newton::set_up(of, weights, SETTINGS, None, None, &mut work)
        .map_err(|error| at_start(NewtonError::Singular(error)))?;
    let mut equations = StaticEquations {
        system,
        law,
        load,
        share: 0.0,
        force: vec![0.0; dofs],
        v: vec![0.0; dofs],
        internal: vec![0.0; system.internal_variables()],
        extent: system.extent().unwrap_or(0.0),
    };
    follow(&mut newton, &mut equations, &mut work)?;
    Ok(newton.point.x)
}
