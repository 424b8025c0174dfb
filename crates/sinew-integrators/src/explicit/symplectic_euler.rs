//! `symplectic-euler`: velocity first, then displacement from the new velocity.

use sinew_core::{
    Accuracy, ChangingLoads, EnergyBehaviour, Integrator, LoadTime, Needs, OptionError, Options,
    OtherDamping, Prepared, Properties, SetupError, StableStep, State, StepError, StepReport,
    System,
};

use super::GuardOption;
use crate::Method;
use crate::evaluate::{acceleration, begin, prepare_buffers};
use crate::limits;

/// `v += dt M^-1 (F(t) - K u - D v)`, then `u += dt v` (Hairer, Lubich and Wanner, Geometric
/// Numerical Integration, section I.1).
#[derive(Debug, Default)]
pub struct SymplecticEuler {
    prepared: Prepared,
    a: Vec<f64>,
}

impl Method for SymplecticEuler {
    const ID: &'static str = "symplectic-euler";
    const SUMMARY: &'static str = "explicit, order 1, keeps the energy of undamped motion bounded";
    const SUBSTEPS: bool = true;
    const GUARD: GuardOption = GuardOption::Any;

    fn from_options(_options: &Options) -> Result<Self, OptionError> {
        Ok(Self::default())
    }
}

impl Integrator for SymplecticEuler {
    fn id(&self) -> &'static str {
        Self::ID
    }

    fn properties(&self) -> Properties {
        Properties {
            accuracy: Accuracy::Order(1),
            needs: Needs::Forces,
            energy: EnergyBehaviour::Bounded,
            changing_loads: ChangingLoads::order(1),
            other_damping: OtherDamping::order(1),
        }
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        prepare_buffers(&mut self.prepared, Self::ID, system, dt, &mut [&mut self.a])
    }

    fn stable_step(&self, system: &dyn System) -> Result<StableStep, SetupError> {
        limits::symplectic_euler(Self::ID, system)
    }

    fn step(
        &mut self,
        system: &dyn System,
        state: &mut State,
        dt: f64,
    ) -> Result<StepReport, StepError> {
        let mut work = begin(self, system, state, dt)?;
        work += acceleration(
            system,
            state,
            LoadTime::start_of(state.t(), dt),
            &mut self.a,
        )?;
        for ((u, v), a) in state.u.iter_mut().zip(&mut state.v).zip(&self.a) {
            *v += dt * a;
            *u += dt * *v;
        }
        state.advance(dt);
        system.accept(state);
        Ok(work)
    }
}
