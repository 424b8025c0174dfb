//! `implicit-euler`: both halves from the new state.

use sinew_core::{
    Accuracy, ChangingLoads, EnergyBehaviour, Integrator, LoadTime, Needs, OptionError, Options,
    OtherDamping, Properties, SetupError, StableStep, State, StepError, StepReport, System,
};

use super::engine::Engine;
use crate::Method;
use crate::evaluate::begin;

/// `v+ = v + dt a+`, `u+ = u + dt v+` with `(M + dt D + dt^2 K) a+ = F(t + dt) - K (u + dt v) - D v`
/// (Baraff and Witkin, Large steps in cloth simulation, 1998, for a linear system). Stable at any
/// step and strongly damped by it.
#[derive(Debug, Default)]
pub struct ImplicitEuler {
    engine: Engine,
}

impl Method for ImplicitEuler {
    const ID: &'static str = "implicit-euler";
    const SUMMARY: &'static str = "implicit, order 1, one sparse solve a step; damps what it moves";

    fn from_options(_options: &Options) -> Result<Self, OptionError> {
        Ok(Self::default())
    }
}

impl Integrator for ImplicitEuler {
    fn id(&self) -> &'static str {
        Self::ID
    }

    fn properties(&self) -> Properties {
        Properties {
            accuracy: Accuracy::Order(1),
            needs: Needs::Matrices,
            changing_loads: ChangingLoads::order(1),
            energy: EnergyBehaviour::Falls,
            other_damping: OtherDamping::order(1),
        }
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        self.engine.prepare(Self::ID, system, dt, (dt, dt * dt))
    }

    fn stable_step(&self, _system: &dyn System) -> Result<StableStep, SetupError> {
        Ok(StableStep::Any)
    }

    fn step(
        &mut self,
        system: &dyn System,
        state: &mut State,
        dt: f64,
    ) -> Result<StepReport, StepError> {
        let mut work = begin(self, system, state, dt)?;
        for (predicted, (u, v)) in self.engine.u.iter_mut().zip(state.u.iter().zip(&state.v)) {
            *predicted = u + dt * v;
        }
        self.engine.v.copy_from_slice(&state.v);
        let load = LoadTime::end_of(state.t(), dt);
        work += self.engine.evaluate(system, load, dt)?;
        work += self.engine.solve();
        for ((u, v), a) in state.u.iter_mut().zip(&mut state.v).zip(&self.engine.a) {
            *v += dt * a;
            *u += dt * *v;
        }
        state.advance(dt);
        system.accept(state);
        Ok(work)
    }
}
