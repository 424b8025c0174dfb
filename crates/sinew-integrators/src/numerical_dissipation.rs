//! Numerical dissipation: energy that a method removes from the motion.

use sinew_core::vectors::{dot, weighted_dot};
use sinew_core::{LinearOperators, LoadTime};

/// The closed form of the energy that a method dissipates numerically in a step of a linear system: in addition to
/// the work of loads, `du' (F + F+)/2`, and the energy `du' D du/dt` that damping dissipates.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum NumericalDissipation {
    /// Newmark's displacements and velocities, with the equation of motion at `a_m` of the acceleration and `a_f` of all
    /// else at the start of the step (Newmark's method: both 0).
    ///
    /// Multiplied by `du`, that equation gives (as Hughes, The Finite Element Method, section 9.2, for Newmark's
    /// method), with the means v and a of both ends and s for the shift of loads,
    ///
    /// ```text
    /// du' ((a_f - 1/2) (dF - K du - D dv) + (1/2 - a_m) M da - s dF) + dt (1/2 - gamma) v' M da
    ///     + dt^2 (beta - gamma/2) da' M a - dt (beta - gamma/2) du' D da
    /// ```
    Newmark {
        /// Share of the new acceleration in the displacement, twice.
        beta: f64,
        /// Share of the new acceleration in the velocity.
        gamma: f64,
        /// Share of the old acceleration in the equation of motion.
        of_mass: f64,
        /// Share of the old forces in the equation of motion.
        of_forces: f64,
        /// Offset, in steps, of the times at which loads are taken from the ends of the step: their change times this
        /// offset is no loss.
        load_shift: f64,
    },
    /// The implicit Euler method under the mean of the loads in a step: `(dv' M dv + du' K du)/2`, its equation of motion
    /// times `du`.
    ImplicitEuler,
}

/// The motion at an end of a step.
#[derive(Debug, Clone, Copy)]
pub struct StepEnd<'a> {
    /// Displacement (m).
    pub u: &'a [f64],
    /// Velocity (m/s).
    pub v: &'a [f64],
    /// Acceleration (m/s^2) as the method keeps it.
    pub a: &'a [f64],
    /// Loads (N), as [`NumericalDissipation::loads_at_ends`].
    pub load: &'a [f64],
}

impl NumericalDissipation {
    /// The loads that the method takes at both ends of a step from `t` (s), `dt` (s) long: those of [`StepEnd::load`].
    #[must_use]
    pub fn loads_at_ends(&self, t: f64, dt: f64) -> [LoadTime<'static>; 2] {
        let load_shift = match *self {
            Self::Newmark { load_shift, .. } => load_shift,
            Self::ImplicitEuler => 0.0,
        };
        LoadTime::at_both_ends(t, dt, 0.5 - load_shift)
    }

    /// The energy (J) that is removed in a step of `dt` (s) between these ends.
    #[must_use]
    pub fn taken(
        &self,
        operators: &LinearOperators,
        dt: f64,
        [before, after]: [StepEnd<'_>; 2],
    ) -> f64 {
        let mass = operators.mass();
        let change = |before: &[f64], after: &[f64]| -> Vec<f64> {
            after
                .iter()
                .zip(before)
                .map(|(new, old)| new - old)
                .collect()
        };
        let (du, dv) = (change(before.u, after.u), change(before.v, after.v));
        match *self {
            Self::ImplicitEuler => {
                let (still, mut force) = (vec![0.0; dv.len()], vec![0.0; dv.len()]);
                operators.subtract_internal_force(&du, &still, &mut force);
                0.5 * (weighted_dot(mass, &dv, &dv) - dot(&du, &force))
            }
            Self::Newmark {
                beta,
                gamma,
                of_mass,
                of_forces,
                load_shift,
            } => {
                let da = change(before.a, after.a);
                let mean = |before: &[f64], after: &[f64]| -> Vec<f64> {
                    after
                        .iter()
                        .zip(before)
                        .map(|(new, old)| 0.5 * (new + old))
                        .collect()
                };
                let load_change = change(before.load, after.load);
                let mut force = load_change.clone();
                operators.subtract_internal_force(&du, &dv, &mut force);
                let excess = beta - 0.5 * gamma;
                let mut damped = vec![0.0; da.len()];
                operators.subtract_damping(&da, &mut damped);
                (of_forces - 0.5) * dot(&du, &force) - load_shift * dot(&du, &load_change)
                    + (0.5 - of_mass) * weighted_dot(mass, &du, &da)
                    + dt * (0.5 - gamma) * weighted_dot(mass, &mean(before.v, after.v), &da)
                    + dt * dt * excess * weighted_dot(mass, &da, &mean(before.a, after.a))
                    + dt * excess * dot(&du, &damped)
            }
        }
    }
}
