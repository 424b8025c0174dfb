//! What one-step implicit methods share: an acceleration from a factor of M + d D + k K.

use sinew_core::{
    LinearSystem, Needs, Prepared, SetupError, State, StepError, StepReport, System, Trial,
};

use super::factor::{Combination, Factor};
use crate::evaluate::net_force;

/// Solves `(M + d D + k K) a = F(t) - K u* - D v*`, keeping the factor while the system and the
/// coefficients stay.
#[derive(Debug, Default)]
pub(crate) struct Engine {
    prepared: Prepared,
    factor: Option<Factor>,
    /// Predicted displacement u*.
    pub(crate) u: Vec<f64>,
    /// Predicted velocity v*.
    pub(crate) v: Vec<f64>,
    /// The acceleration, once solved.
    pub(crate) a: Vec<f64>,
}

impl Engine {
    /// Sets up for a system and a step; `coefficients` are (d, k).
    pub(crate) fn prepare(
        &mut self,
        integrator: &'static str,
        system: &dyn System,
        dt: f64,
        coefficients: (f64, f64),
    ) -> Result<StepReport, SetupError> {
        if self.prepared.is_for(system, dt) {
            return Ok(StepReport::default());
        }
        let operators =
            system
                .as_linear()
                .map(LinearSystem::operators)
                .ok_or(SetupError::Lacks {
                    integrator,
                    needs: Needs::Matrices.describe(),
                })?;
        let mut checked = Prepared::default();
        checked.check(integrator, system, dt)?;
        self.prepared = Prepared::default();
        let failed = |reason| SetupError::Factorization { integrator, reason };
        let mut factor = match self.factor.take().filter(|factor| factor.fits(operators)) {
            Some(factor) => factor,
            None => Factor::analyse(operators).map_err(failed)?,
        };
        let (d, k) = coefficients;
        factor
            .factorise(operators, Combination::of_step(operators, d, k))
            .map_err(failed)?;
        self.factor = Some(factor);
        for buffer in [&mut self.u, &mut self.v, &mut self.a] {
            buffer.resize(system.dofs(), 0.0);
        }
        self.prepared = checked;
        Ok(StepReport {
            factorizations: 1,
            ..StepReport::default()
        })
    }

    /// `a` from `u`, `v` and the load at time `t`.
    pub(crate) fn solve(
        &mut self,
        system: &dyn System,
        t: f64,
        dt: f64,
    ) -> Result<StepReport, StepError> {
        let trial = Trial {
            t,
            dt,
            u: &self.u,
            v: &self.v,
        };
        let mut work = net_force(system, &trial, &mut self.a)?;
        if let Some(factor) = &mut self.factor {
            factor.solve(&mut self.a);
            work.solves = 1;
        }
        Ok(work)
    }

    /// M^-1 of the net force in `state`, in `a`.
    pub(crate) fn consistent_acceleration(
        &mut self,
        system: &dyn System,
        state: &State,
    ) -> Result<StepReport, StepError> {
        crate::evaluate::acceleration(system, state, state.t, &mut self.a)
    }
}
