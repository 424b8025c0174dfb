//! `cnn`: the paper's method, taken literally.

use sinew_cnn::Saturation;
use sinew_core::{
    Accuracy, ChangingLoads, EnergyBehaviour, Integrator, Needs, OptionError, OptionValue, Options,
    OtherDamping, Properties, SetupError, StableStep, State, StepError, StepReport, System,
};

use super::network::{self, Network};
use crate::evaluate::begin;
use crate::explicit::GuardOption;
use crate::{Method, OptionHelp, limits};

/// `y += dt f(x)`, `x += dt (A y - C x + B F(t))`, both from the old x and y, with the component-wise
/// saturation f (Zhang, Zhong, Smith and Gu 2017, Eqs. 5-7).
///
/// Of all orders of the two halves only this one fits what the paper reports. While nothing
/// saturates it is forward Euler to the last bit; beyond forward Euler's stable step the clamp
/// turns the blow-up into a limit cycle of amplitude about (4/pi) Q sqrt(dt m/d) that never settles.
#[derive(Debug)]
pub struct Cnn {
    saturation: Saturation,
    network: Network,
}

impl Cnn {
    /// With this saturation.
    #[must_use]
    pub fn new(saturation: Saturation) -> Self {
        Self {
            saturation,
            network: Network::default(),
        }
    }
}

impl Method for Cnn {
    const ID: &'static str = "cnn";
    const SUMMARY: &'static str = "the paper's cellular network: forward Euler with a clamp";
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

impl Integrator for Cnn {
    fn id(&self) -> &'static str {
        Self::ID
    }

    fn properties(&self) -> Properties {
        Properties {
            accuracy: Accuracy::Order(1),
            needs: Needs::Matrices,
            energy: EnergyBehaviour::Grows,
            changing_loads: ChangingLoads::order(1),
            other_damping: OtherDamping::order(1),
        }
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        self.network.prepare(Self::ID, system, dt)
    }

    /// Forward Euler's: the clamp bounds the motion beyond it without making it right.
    fn stable_step(&self, system: &dyn System) -> Result<StableStep, SetupError> {
        limits::forward_euler(Self::ID, system)
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
            work.saturated += u64::from(f.saturates(*x));
            *y += dt * f.output(*x);
            *x += dt * rate;
        }
        state.advance(dt);
        system.accept(state);
        Ok(work)
    }
}
