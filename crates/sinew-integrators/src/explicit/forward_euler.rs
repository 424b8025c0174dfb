//! `forward-euler`: both halves from the old state.

use crate::explicit_method::prelude::*;

/// `u += dt v`, `v += dt M^-1 (F(t) - K u - D v)`, both from the old u and v (Euler 1768).
///
/// The "explicit integration" that the cellular network is compared with. Unstable at any step
/// without damping.
#[derive(Debug, Default)]
pub struct ForwardEuler;

impl Explicit for ForwardEuler {
    const ID: &'static str = "forward-euler";
    const SUMMARY: &'static str = "explicit, order 1; what the paper calls explicit integration";

    fn properties(&self) -> Properties {
        Properties::of_order(1, Needs::Forces, EnergyBehaviour::Grows)
    }

    /// The limit `2 zeta/w = beta + alpha/w^2` if the fastest mode oscillates, `2/|lambda|` if it creeps; slow modes
    /// under mass damping creep with roots up to alpha.
    fn stable_step(&self, spectrum: &Spectrum) -> StableStep {
        let (w2, alpha) = (spectrum.omega_max.powi(2), spectrum.mass_damping);
        let d = alpha + spectrum.damping_max;
        let swinging = spectrum.stiffness_damping + alpha / w2;
        let fastest = match (d / 2.0).powi(2) - w2 {
            _ if !spectrum.proportional => swinging.min(2.0 / d),
            creeping if creeping >= 0.0 => 2.0 / (d / 2.0 + creeping.sqrt()),
            _ => swinging,
        };
        match fastest.min(2.0 / alpha) {
            // Dashpots alone may or may not damp every mode; their largest eigenvalue does not tell.
            0.0 if !spectrum.proportional => StableStep::Unknown,
            limit => StableStep::UpTo(limit),
        }
    }

    fn program(&self, physics: &Physics, dt: f64) -> Program {
        let mut program = Program::new(VelocityTime::Same);
        let force = program.net_force(physics, U, V, LoadAt::StartOf);
        program
            .step
            .push(force.then(U.plus(dt, V)).then(V.plus_q(dt)));
        program
    }
}
