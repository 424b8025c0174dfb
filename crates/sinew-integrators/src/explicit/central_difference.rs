//! `central-difference`: leapfrog with mass damping treated implicitly.

use crate::explicit_method::prelude::*;
use crate::limits::lagged;

/// `(1 + alpha dt/2) v+ = (1 - alpha dt/2) v- + dt M^-1 (F(t) - K u - D_rest v-)`, then
/// `u += dt v+`, where the velocity stays half a step behind the displacement and D_rest is the
/// damping other than alpha M (Belytschko, Liu and Moran, Nonlinear Finite Elements, section 6.2).
///
/// Started with `v_half = (1 - alpha dt/2) v0 + dt/2 a/(1 + alpha dt/2)`, a being the acceleration without mass
/// damping: to second order in dt this is nearer to the Taylor series of the motion than damping that is fully implicit
/// or absent.
///
/// Order 2 with mass damping; other damping lags by half a step, which lowers the order to 1. Loads that jump or have
/// kinks enter by their mean about each instant ([`sinew_core::LoadTime::around`]) and do not lower the order.
#[derive(Debug, Default)]
pub struct CentralDifference;

impl Explicit for CentralDifference {
    const ID: &'static str = "central-difference";
    const SUMMARY: &'static str = "explicit, order 2 with mass damping; stable up to 2/omega_max";
    const CONSERVES: ConservedEnergy = ConservedEnergy::CentralDifference;

    fn properties(&self) -> Properties {
        Properties::of_order(2, Needs::Forces, EnergyBehaviour::Bounded).with_other_damping(1)
    }

    /// The limit `2/w`, also with mass damping, which enters at the middle of the step.
    fn stable_step(&self, spectrum: &Spectrum) -> StableStep {
        StableStep::UpTo(lagged(spectrum.omega_max, spectrum.damping_max))
    }

    fn program(&self, physics: &Physics, dt: f64) -> Program {
        // The net force holds alpha M v- already: v+ - v- = dt q/(1 + alpha dt/2).
        let alpha = physics.mass_damping;
        let implicit = 1.0 / (1.0 + alpha * dt / 2.0);
        let kept = 1.0 + dt / 2.0 * (alpha * implicit - alpha);
        let first = V.becomes([(V, kept)]).and_q(dt / 2.0 * implicit);
        let kick = V.plus_q(dt * implicit);
        let mut program = Program::new(VelocityTime::MiddleOfStep);
        program.inertia = Some(CellInertia::Mass(1.0 + alpha * dt / 2.0));
        let start = program.net_force(physics, U, V, LoadAt::From);
        let force = program.net_force(physics, U, V, LoadAt::Around);
        program.start.push(start.then(first).then(U.plus(dt, V)));
        program.step.push(force.then(kick).then(U.plus(dt, V)));
        program
    }
}
