//! `rk4`: the classical Runge-Kutta method.

use crate::explicit_method::prelude::*;
use crate::limits::within_region_of;

/// The classical fourth-order method (Kutta 1901) on (u, v): four sweeps a step.
///
/// Order 4 also while loads change smoothly. A load that jumps or has a kink inside a step is replaced there by a line
/// of the same impulse and first moment, which lowers the order to 2 at worst.
#[derive(Debug, Default)]
pub struct Rk4;

/// Instant of each stage, as a share of the step, and its weight in sixths.
const STAGES: [(f64, f64); 4] = [(0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)];

impl Explicit for Rk4 {
    const ID: &'static str = "rk4";
    const SUMMARY: &'static str = "explicit, order 4, four sweeps a step";

    fn properties(&self) -> Properties {
        Properties::of_order(4, Needs::Forces, EnergyBehaviour::Falls).with_loads(4, 2)
    }

    /// The limit `2 sqrt 2/w` on the imaginary axis, 2.785../|lambda| on the real one.
    fn stable_step(&self, spectrum: &Spectrum) -> StableStep {
        within_region_of(&[1.0, 1.0, 1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0], spectrum)
    }

    fn program(&self, physics: &Physics, dt: f64) -> Program {
        let mut program = Program::new(VelocityTime::Same);
        let [stage_u, stage_v] = ["stage_u", "stage_v"].map(|name| program.register(name));
        let [sum_u, sum_v] = ["sum_u", "sum_v"].map(|name| program.register(name));
        let (mut from, mut at) = ((U, V), (U, V));
        for (stage, (share, sixths)) in STAGES.into_iter().enumerate() {
            let weight = dt * sixths / 6.0;
            let sweep = program.net_force(physics, at.0, at.1, LoadAt::Within(share));
            let sweep = sweep.then(sum_u.becomes([(from.0, 1.0), (at.1, weight)]));
            let mut sweep = sweep.then(sum_v.becomes([(from.1, 1.0)]).and_q(weight));
            sweep = match STAGES.get(stage + 1) {
                Some((next, _)) => sweep
                    .then(stage_u.becomes([(U, 1.0), (at.1, next * dt)]))
                    .then(stage_v.becomes([(V, 1.0)]).and_q(next * dt)),
                None => sweep
                    .then(U.becomes([(sum_u, 1.0)]))
                    .then(V.becomes([(sum_v, 1.0)])),
            };
            program.step.push(sweep);
            (from, at) = ((sum_u, sum_v), (stage_u, stage_v));
        }
        program
    }
}
