//! What one-step implicit methods share: an acceleration from a factor of M + d D + k K.

use sinew_core::{
    Acceleration, LinearSystem, LoadTime, Needs, Prepared, SetupError, State, StepError,
    StepReport, System, Trial,
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

    /// The right-hand side, in `a`: the net force at the prediction.
    pub(crate) fn evaluate(
        &mut self,
        system: &dyn System,
        load: LoadTime,
        dt: f64,
    ) -> Result<StepReport, StepError> {
        let trial = Trial {
            load,
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

    /// Gives the state the acceleration at the beginning of a step of `dt` (s): `M^-1` of the net
    /// force, or the one that it keeps from the end of the last step, changed by as much as loads
    /// jump between the two. `ends` gives the loads at both ends of a step from a time (s), `dt` (s) long.
    pub(crate) fn keep_acceleration(
        &mut self,
        system: &dyn System,
        state: &mut State,
        dt: f64,
        ends: impl Fn(f64, f64) -> [LoadTime; 2],
    ) -> Result<StepReport, StepError> {
        let t = state.t();
        let [load, _] = ends(t, dt);
        if state.acceleration != Acceleration::Same {
            let work = acceleration(system, state, load, &mut self.a)?;
            state.a.clone_from(&self.a);
            state.acceleration = Acceleration::Same;
            return Ok(work);
        }
        if let (Some(last), Some(linear)) = (state.clock.last_step(), system.as_linear()) {
            let [_, before] = ends(t - last, last);
            self.a.fill(0.0);
            let operators = linear.operators();
            if operators.add_load_change([before, load], [t - last, t + dt], &mut self.a) {
                for ((a, force), mass) in state.a.iter_mut().zip(&self.a).zip(system.mass()) {
                    *a += force / mass;
                }
            }
        }
        Ok(StepReport::default())
    }
}
