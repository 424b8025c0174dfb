//! `symplectic-euler`: velocity first, then displacement from the new velocity.

use crate::explicit_method::prelude::*;
use crate::limits::lagged;

/// `v += dt M^-1 (F(t) - K u - D v)`, then `u += dt v` (Hairer, Lubich and Wanner, Geometric
/// Numerical Integration, section I.1).
#[derive(Debug, Default)]
pub struct SymplecticEuler;

impl Explicit for SymplecticEuler {
    const ID: &'static str = "symplectic-euler";
    const SUMMARY: &'static str = "explicit, order 1, keeps the energy of undamped motion bounded";

    fn properties(&self) -> Properties {
        Properties::of_order(1, Needs::Forces, EnergyBehaviour::Bounded)
    }

    fn stable_step(&self, spectrum: &Spectrum) -> StableStep {
        let d = spectrum.mass_damping + spectrum.damping_max;
        StableStep::UpTo(lagged(spectrum.omega_max, d))
    }

    fn program(&self, physics: &Physics, dt: f64) -> Program {
        let mut program = Program::new(VelocityTime::Same);
        program.inertia = Some(CellInertia::Mass(1.0));
        let force = program.net_force(physics, U, V, LoadAt::StartOf);
        program
            .step
            .push(force.then(V.plus_q(dt)).then(U.plus(dt, V)));
        program
    }
}
