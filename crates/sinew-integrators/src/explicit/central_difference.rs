//! `central-difference`: leapfrog with mass damping treated implicitly.

use sinew_core::{
    Acceleration, Accuracy, ChangingLoads, EnergyBehaviour, Fact, Integrator, LoadTime, Needs,
    OptionError, Options, OtherDamping, Prepared, Properties, SetupError, StableStep, State,
    StepError, StepReport, System, VelocityTime,
};

use super::GuardOption;
use super::patches::{self, AutoPatches};
use crate::evaluate::{acceleration, prepare_buffers, synchronise};
use crate::{Method, OptionHelp, limits};

/// `(1 + alpha dt/2) v+ = (1 - alpha dt/2) v- + dt M^-1 (F(t) - K u - D_rest v-)`, then
/// `u += dt v+`, where the velocity stays half a step behind the displacement and D_rest is the
/// damping beside alpha M (Belytschko, Liu and Moran, Nonlinear Finite Elements, section 6.2).
///
/// Started with `v_half = (1 - alpha dt/2) v0 + dt/2 a/(1 + alpha dt/2)`, a being the acceleration
/// without mass damping: to second order in dt this is nearer to the Taylor series of the motion
/// than damping all of it implicitly or none.
///
/// Order 2 with mass damping; other damping lags by half a step, which lowers it to 1. Loads that
/// jump or have kinks enter by their mean about each instant ([`LoadTime::around`]) and cost no order.
///
/// With `patches = "auto"` (feature `implicit`) the few elements that forbid the step are solved
/// as small blocks: stable up to the limit of all others, order 2, the elements named in
/// [`Integrator::remarks`].
#[derive(Debug, Default)]
pub struct CentralDifference {
    prepared: Prepared,
    a: Vec<f64>,
    patches: Option<AutoPatches>,
}

impl Method for CentralDifference {
    const ID: &'static str = "central-difference";
    const SUMMARY: &'static str = "explicit, order 2 with mass damping; stable up to 2/omega_max";
    const OPTIONS: &'static [OptionHelp] = patches::OPTIONS;
    const SUBSTEPS: bool = true;
    const GUARD: GuardOption = GuardOption::Any;

    fn from_options(options: &Options) -> Result<Self, OptionError> {
        Ok(Self {
            patches: AutoPatches::from_options(options, Self::ID)?,
            ..Self::default()
        })
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
            changing_loads: ChangingLoads::order(2),
            other_damping: OtherDamping::order(1),
        }
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        if self.prepared.is_for(system, dt) {
            return Ok(StepReport::default());
        }
        let mut checked = Prepared::default();
        prepare_buffers(&mut checked, Self::ID, system, dt, &mut [&mut self.a])?;
        if let Some(patches) = &mut self.patches {
            self.prepared = Prepared::default();
            patches.prepare(system, Self::ID, dt)?;
        }
        self.prepared = checked;
        Ok(StepReport::default())
    }

    fn stable_step(&self, system: &dyn System) -> Result<StableStep, SetupError> {
        if let Some(patches) = &self.patches {
            return patches.stable_step(system, Self::ID);
        }
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
        let running = state.is_staggered_by(dt);
        if !running {
            work += synchronise(system, state)?;
        }
        let load = LoadTime::around(state.t(), if running { dt } else { 0.0 }, dt);
        work += acceleration(system, state, load, &mut self.a)?;
        // The net force holds alpha M v- already: v+ - v- = dt a/(1 + alpha dt/2).
        let alpha = system.mass_damping();
        let patches = self.patches.as_mut().and_then(AutoPatches::made);
        let patched = patches.is_some();
        if let Some(patches) = patches {
            if running {
                patches.accelerate(&mut self.a);
            } else {
                patches.accelerate_start(&mut self.a, &state.v, alpha, dt);
            }
            work.solves += 1;
            state.a.clone_from(&state.v);
        }
        let implicit = 1.0 / (1.0 + alpha * dt / 2.0);
        for ((u, v), a) in state.u.iter_mut().zip(&mut state.v).zip(&self.a) {
            *v += if running {
                dt * implicit * a
            } else {
                dt / 2.0 * ((a + alpha * *v) * implicit - alpha * *v)
            };
            *u += dt * *v;
        }
        let mut kept = Acceleration::None;
        if patched {
            // Kept so that the velocity at the displacement's time can be had: M^-1 of the force is
            // not the acceleration of a patch.
            let taken = if running { dt } else { dt / 2.0 };
            for (a, v) in state.a.iter_mut().zip(&state.v) {
                *a = (v - *a) / taken;
            }
            kept = Acceleration::Kick;
        }
        state.end_step(dt, VelocityTime::MiddleOfStep, kept);
        system.accept(state);
        Ok(work)
    }

    fn facts(&self) -> Vec<Fact> {
        self.patches
            .as_ref()
            .map_or_else(Vec::new, AutoPatches::facts)
    }

    fn remarks(&self) -> Vec<String> {
        self.patches
            .as_ref()
            .map_or_else(Vec::new, AutoPatches::remarks)
    }
}
