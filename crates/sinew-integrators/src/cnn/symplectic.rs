//! `cnn-symplectic`: the paper's network with the state updated first.

use sinew_cnn::Saturation;
use sinew_core::{
    Accuracy, ChangingLoads, EnergyBehaviour, Integrator, Needs, OptionError, OptionValue, Options,
    OtherDamping, Properties, SetupError, StableStep, State, StepError, StepReport, System,
};

use super::network::{self, Network};
use crate::evaluate::begin;
use crate::explicit::GuardOption;
use crate::{Method, OptionHelp, limits};

/// `x += dt (A y - C x + B F(t))`, then `y += dt f(x)` with the new x: symplectic Euler with a clamp
/// on what moves the displacement.
#[derive(Debug)]
pub struct CnnSymplectic {
    saturation: Saturation,
    network: Network,
}

impl CnnSymplectic {
    /// With this saturation.
    #[must_use]
    pub fn new(saturation: Saturation) -> Self {
        Self {
            saturation,
            network: Network::default(),
        }
    }
}

impl Method for CnnSymplectic {
    const ID: &'static str = "cnn-symplectic";
    const SUMMARY: &'static str = "cellular network, state first: symplectic Euler with a clamp";
    const OPTIONS: &'static [OptionHelp] = &[network::SATURATION];
    const SUBSTEPS: bool = true;
    const GUARD: GuardOption = GuardOption::OwnOrAuto;

    fn from_options(options: &Options) -> Result<Self, OptionError> {
        network::saturation(options, Self::ID).map(Self::new)
    }

    fn conformance_options() -> Options {
        Options::new().with(network::SATURATION.key, OptionValue::Text("off".into()))
    }
}

impl Integrator for CnnSymplectic {
    fn id(&self) -> &'static str {
        Self::ID
    }

    fn properties(&self) -> Properties {
        Properties {
            accuracy: Accuracy::Order(1),
            needs: Needs::Matrices,
            energy: EnergyBehaviour::Bounded,
            changing_loads: ChangingLoads::order(1),
            other_damping: OtherDamping::order(1),
        }
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        self.network.prepare(Self::ID, system, dt)
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
        work += self.network.sweep(state, dt);
        let f = self.saturation;
        for ((y, x), rate) in state.u.iter_mut().zip(&mut state.v).zip(&self.network.rate) {
            *x += dt * rate;
            work.saturated += u64::from(f.saturates(*x));
            *y += dt * f.output(*x);
        }
        state.advance(dt);
        system.accept(state);
        Ok(work)
    }
}
