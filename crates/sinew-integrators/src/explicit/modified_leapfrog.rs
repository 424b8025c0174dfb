//! `modified-leapfrog`: leapfrog with the modified equation's correction.

use crate::explicit_method::prelude::*;
use crate::limits::lagged;

/// Central difference with `a = M^-1 (F(t) - K u)` replaced by `a - dt^2/12 M^-1 K a`, which cancels
/// its leading error (Shubin and Bell, SIAM J. Sci. Stat. Comput. 8, 1987; Dablain, Geophysics 51,
/// 1986): two sweeps a step, order 4, stable up to 3.46/omega_max. Mass damping enters at the
/// middle of the step and lowers the order to 2 with a small constant; other damping lags.
///
/// The correction assumes constant loads, so that changing loads lower the order to 2.
///
/// Started from the Taylor series: `v_half = v0 + dt/2 a0 + dt^2/6 j0 + dt^3/24 q0` with
/// `a0 = M^-1 (F - K u0 - D v0)`, `j0 = M^-1 (F' - K v0 - D a0)`, `q0 = -M^-1 K a0`.
#[derive(Debug, Default)]
pub struct ModifiedLeapfrog;

impl Explicit for ModifiedLeapfrog {
    const ID: &'static str = "modified-leapfrog";
    const SUMMARY: &'static str = "explicit, order 4 where damping is small, two sweeps a step";

    fn properties(&self) -> Properties {
        let plain = Properties::of_order(2, Needs::Matrices, EnergyBehaviour::Bounded);
        plain.with_orders(4, 2).with_other_damping(1)
    }

    /// `sqrt 12/w` undamped: `dt^2 w^2 (1 - dt^2 w^2/12)` reaches its largest value, 3, at `dt^2 w^2 = 6` and returns
    /// to 0 at 12. Lagging damping d reduces the margin below 4 that is left at 6, and beyond that the step: stable
    /// while `2 d dt` and that value together stay below 4.
    fn stable_step(&self, spectrum: &Spectrum) -> StableStep {
        let (w, d) = (spectrum.omega_max, spectrum.damping_max);
        let with_damping = (1.0 / (2.0 * d)).max(lagged(w, d));
        StableStep::UpTo((12.0_f64.sqrt() / w).min(with_damping))
    }

    fn program(&self, physics: &Physics, dt: f64) -> Program {
        let (alpha, beta) = (physics.mass_damping, physics.stiffness_damping);
        let mut program = Program::new(VelocityTime::MiddleOfStep);
        let [a, w] = ["acceleration", "w"].map(|name| program.register(name));
        let sweep = |loads, dashpots_on| physics.sweep(1.0, w, loads, dashpots_on);
        let damped = |loads, on| sweep(loads, Some(on)).with_own(on, 0.0, -alpha);

        // What a step multiplies K by: the correction sees damping too, by cells and by supports in motion alike.
        let damped_u = if beta == 0.0 { U } else { w };

        // The rate of the loads, by a difference.
        let change = |factor, share| Loads::All {
            factor,
            at: LoadAt::Within(share),
        };
        let slope = [a.becomes_q(), w.becomes([(V, 1.0), (a, beta)])];
        let push = V.plus(dt / 2.0, a).and_q(dt * dt / 6.0);
        let jerk = [push, w.becomes([(a, 1.0)])];
        program.start = vec![
            Sweep::local().then(w.becomes([(U, 1.0), (V, beta)])),
            damped(Loads::at(LoadAt::Within(0.0)), V).doing(slope),
            damped(change(3.0 / dt, 1.0 / 3.0), a).doing(jerk),
            Sweep::of_stiffness(0.0, U, change(-3.0 / dt, 0.0))
                .without_neighbours()
                .then(V.plus_q(dt * dt / 6.0)),
            sweep(Loads::None, None).doing([V.plus_q(dt.powi(3) / 24.0), U.plus(dt, V)]),
        ];
        let plain = physics.sweep(1.0, damped_u, Loads::at(LoadAt::Around), Some(V));
        let correction = w.becomes([(a, dt * dt / 12.0)]);
        // v+ - v- = h (a - alpha v-).
        let h = dt / (1.0 + alpha * dt / 2.0);
        let kick = V.becomes([(V, 1.0 - alpha * h), (a, h)]).and_q(h);
        let corrected = sweep(Loads::None, None).doing([kick, U.plus(dt, V)]);
        if beta != 0.0 {
            program.step = vec![Sweep::local().then(w.becomes([(U, 1.0), (V, beta)]))];
        }
        let plain = plain.doing([a.becomes_q(), correction]);
        program.step.extend([plain, corrected]);
        program
    }
}
