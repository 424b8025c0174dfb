//! `cnn`: the paper's method, taken literally.

use sinew_cnn::Saturation;

use super::network;
use crate::OptionHelp;
use crate::explicit::{ForwardEuler, GuardOption};
use crate::explicit_method::prelude::*;

/// `y += dt f(x)`, `x += dt (A y - C x + B F(t))`, both from the old x and y, with the component-wise
/// saturation f (Zhang, Zhong, Smith and Gu 2017, Eqs. 5-7).
///
/// This order of the two halves is the only one that fits the paper's results. While nothing saturates it is forward
/// Euler to the last bit; beyond forward Euler's stable step the clamp turns the divergence into a limit cycle of
/// amplitude about (4/pi) Q sqrt(dt m/d) that never settles.
#[derive(Debug, Default)]
pub struct Cnn(pub Saturation);

impl Explicit for Cnn {
    const ID: &'static str = "cnn";
    const SUMMARY: &'static str = "the paper's cellular network: forward Euler with a clamp";
    const OPTIONS: &'static [OptionHelp] = &[network::SATURATION];
    const GUARD: GuardOption = GuardOption::OwnOrAuto;

    fn from_options(options: &Options) -> Result<Self, OptionError> {
        network::saturation(options, Self::ID).map(Self)
    }

    fn conformance_options() -> Options {
        network::unsaturated()
    }

    fn properties(&self) -> Properties {
        Properties::of_order(1, Needs::Forces, EnergyBehaviour::Grows)
    }

    /// Forward Euler's stable step: the clamp bounds the motion beyond it without making it accurate.
    fn stable_step(&self, spectrum: &Spectrum) -> StableStep {
        ForwardEuler.stable_step(spectrum)
    }

    fn program(&self, physics: &Physics, dt: f64) -> Program {
        let mut program = Program::new(VelocityTime::Same);
        let mut sweep = program.net_force(physics, U, V, LoadAt::StartOf);
        sweep.updates = network::output(&mut program, self.0, dt);
        sweep.updates.push(V.plus_q(dt));
        program.step.push(sweep);
        program
    }
}
