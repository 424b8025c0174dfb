//! `central-difference`: leapfrog with mass damping treated implicitly.

use sinew_core::{
    Accuracy, EnergyBehaviour, Integrator, Needs, OptionError, Options, Prepared, Properties,
    SetupError, StableStep, State, StepError, StepReport, System,
};

use super::GuardOption;
use crate::Method;
use crate::evaluate::{acceleration, prepare_buffers, synchronise};
use crate::limits;

/// `(1 + alpha dt/2) v+ = (1 - alpha dt/2) v- + dt M^-1 (F(t) - K u - D_rest v-)`, then
/// `u += dt v+`, where the velocity stays half a step behind the displacement and D_rest is the
/// damping beside alpha M (Belytschko, Liu and Moran, Nonlinear Finite Elements, section 6.2).
///
/// Started with `v_half = (1 - alpha dt/2) v0 + dt/2 a/(1 + alpha dt/2)`, a being the acceleration
/// without mass damping: to second order in dt this is nearer to the Taylor series of the motion
/// than damping all of it implicitly or none.
///
/// Order 2 with mass damping; other damping lags by half a step, which lowers it to 1.
#[derive(Debug, Default)]
pub struct CentralDifference {
    prepared: Prepared,
    a: Vec<f64>,
}

impl Method for CentralDifference {
    const ID: &'static str = "central-difference";
    const SUMMARY: &'static str = "explicit, order 2 with mass damping; stable up to 2/omega_max";
    const SUBSTEPS: bool = true;
    const GUARD: GuardOption = GuardOption::Any { runs_away: false };

    fn from_options(_options: &Options) -> Result<Self, OptionError> {
        Ok(Self::default())
    }
}

impl Integrator for CentralDifference {
    fn id(&self) -> &'static str {
        Self::ID
    }

    fn properties(&self) -> Properties {
        Properties {
            accuracy: Accuracy::Order(2),
            needs: Needs::Forces,
            energy: EnergyBehaviour::Bounded,
        }
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        prepare_buffers(&mut self.prepared, Self::ID, system, dt, &mut [&mut self.a])
    }

    fn stable_step(&self, system: &dyn System) -> Result<StableStep, SetupError> {
        limits::central_difference(Self::ID, system)
    }

    fn step(
        &mut self,
        system: &dyn System,
        state: &mut State,
        dt: f64,
    ) -> Result<StepReport, StepError> {
        let mut work = self.prepare(system, dt)?;
        Prepared::check_state(Self::ID, system, state)?;
        // A velocity half a step behind is this method's own at this dt; any other is moved to
        // the displacement's time, from which the method starts with half a step.
        let behind = state.t - state.v_time;
        let running = (behind - dt / 2.0).abs() <= 1e-6 * dt;
        if !running {
            work += synchronise(system, state)?;
        }
        work += acceleration(system, state, state.t, &mut self.a)?;
        // The net force holds alpha M v- already: v+ - v- = dt a/(1 + alpha dt/2).
        let alpha = system.mass_damping();
        let implicit = 1.0 / (1.0 + alpha * dt / 2.0);
        for ((u, v), a) in state.u.iter_mut().zip(&mut state.v).zip(&self.a) {
            *v += if running {
                dt * implicit * a
            } else {
                dt / 2.0 * ((a + alpha * *v) * implicit - alpha * *v)
            };
            *u += dt * *v;
        }
        state.t += dt;
        state.v_time = state.t - dt / 2.0;
        state.a_time = f64::NEG_INFINITY;
        system.accept(state);
        Ok(work)
    }
}
