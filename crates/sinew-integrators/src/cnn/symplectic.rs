//! `cnn-symplectic`: the paper's network with the state updated first.

use sinew_cnn::Saturation;

use super::network;
use crate::OptionHelp;
use crate::explicit::{GuardOption, SymplecticEuler};
use crate::explicit_method::prelude::*;

/// `x += dt (A y - C x + B F(t))`, then `y += dt f(x)` with the new x: symplectic Euler with a clamp
/// on the velocity that moves the displacement.
#[derive(Debug, Default)]
pub struct CnnSymplectic(pub Saturation);

impl Explicit for CnnSymplectic {
    const ID: &'static str = "cnn-symplectic";
    const SUMMARY: &'static str = "cellular network, state first: symplectic Euler with a clamp";
    const OPTIONS: &'static [OptionHelp] = &[network::SATURATION];
    const GUARD: GuardOption = GuardOption::OwnOrAuto;

    fn from_options(options: &Options) -> Result<Self, OptionError> {
        network::saturation(options, Self::ID).map(Self)
    }

    fn conformance_options() -> Options {
        network::unsaturated()
    }

    fn properties(&self) -> Properties {
        Properties::of_order(1, Needs::Forces, EnergyBehaviour::Bounded)
    }

    fn stable_step(&self, spectrum: &Spectrum) -> StableStep {
        SymplecticEuler.stable_step(spectrum)
    }

    fn program(&self, physics: &Physics, dt: f64) -> Program {
        let mut program = Program::new(VelocityTime::Same);
        program.inertia = Some(CellInertia::Mass(1.0));
        let mut sweep = program.net_force(physics, U, V, LoadAt::StartOf);
        sweep.updates = vec![V.plus_q(dt)];
        sweep
            .updates
            .extend(network::output(&mut program, self.0, dt));
        program.step.push(sweep);
        program
    }
}
