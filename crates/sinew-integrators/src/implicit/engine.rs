//! What one-step implicit methods share: an acceleration from a factor of M + d D + k K.

use sinew_core::{
    LinearSystem, Needs, Prepared, SetupError, State, StepError, StepReport, System, Trial,
};

use super::factor::{Combination, Factor};
use crate::evaluate::{acceleration, net_force};

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

    /// The right-hand side, in `a`: the net force at the prediction under the load at time `t`.
    pub(crate) fn evaluate(
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
        net_force(system, &trial, &mut self.a)
    }

    /// Replaces the right-hand side in `a` by the acceleration.
    pub(crate) fn solve(&mut self) -> StepReport {
        let mut work = StepReport::default();
        if let Some(factor) = &mut self.factor {
            factor.solve(&mut self.a);
            work.solves = 1;
        }
        work
    }

    /// Gives the state the acceleration at its time, `M^-1` of the net force, unless it keeps one.
    pub(crate) fn keep_acceleration(
        &mut self,
        system: &dyn System,
        state: &mut State,
    ) -> Result<StepReport, StepError> {
        if state.a_time == state.t && state.a.len() == state.u.len() {
            return Ok(StepReport::default());
        }
        let work = acceleration(system, state, state.t, &mut self.a)?;
        state.a.clone_from(&self.a);
        state.a_time = state.t;
        Ok(work)
    }
}
