//! Bodies that are carried by moving supports.

use sinew_cnn::equilibrium;
use sinew_core::vectors::add_scaled;
use sinew_core::{LinearOperators, LoadTime, Ramp};

/// Relative residual of forces at which a carried displacement counts as found.
const FOUND: f64 = 1e-12;

/// The quasi-static displacements of a body due to moving supports, without inertia: `K g = -K_p d`. The mass that a
/// stabilising matrix adds must not slow them down.
#[derive(Debug, Default)]
pub(super) struct Carried {
    courses: Vec<Course>,
    /// The change (m/s) of the carried velocity in a step, and the impulse (N s) that it causes by inertia and centred
    /// damping.
    pub(super) change: Vec<f64>,
    pub(super) impulse: Vec<f64>,
}

/// A motion of supports.
#[derive(Debug)]
struct Course {
    ramp: Ramp,
    /// g (m), for a factor of 1.
    carried: Vec<f64>,
    /// K g (N).
    force: Vec<f64>,
}

impl Carried {
    /// True if loads move supports.
    pub(super) fn carries(operators: &LinearOperators) -> bool {
        let mut ramps = operators.loads().iter().map(|load| &load.ramp);
        ramps.any(|ramp| matches!(ramp, Ramp::Position(_)))
    }

    /// Finds the displacements, by conjugate gradients.
    pub(super) fn of(operators: &LinearOperators) -> Self {
        let places = operators.loads().iter();
        let places = places.filter(|load| matches!(load.ramp, Ramp::Position(_)));
        let dofs = operators.dofs();
        let courses: Vec<Course> = places
            .map(|load| {
                let mut force = vec![0.0; dofs];
                for (dof, entry) in &load.entries {
                    force[*dof as usize] += entry;
                }
                Course {
                    ramp: load.ramp.clone(),
                    carried: equilibrium(operators, &force, FOUND).displacement,
                    force,
                }
            })
            .collect();
        let zeros = || vec![0.0; if courses.is_empty() { 0 } else { dofs }];
        Self {
            change: zeros(),
            impulse: zeros(),
            courses,
        }
    }

    /// Finds the change of the carried velocity across the time `t` (s), in steps of `dt` (s), or in the first step
    /// that velocity itself; returns true if it is not zero. `centred` is the share of the damping not proportional to
    /// mass that the stabilising matrix contains.
    pub(super) fn look(
        &mut self,
        operators: &LinearOperators,
        (t, dt, is_first): (f64, f64, bool),
        centred: f64,
    ) -> bool {
        self.change.fill(0.0);
        self.impulse.fill(0.0);
        let damping = operators.damping();
        let mut is_any = false;
        for course in &self.courses {
            let place = |t: f64| course.ramp.place(LoadTime::at(t));
            let after = (place(t + dt) - place(t)) / dt;
            let before = match is_first {
                true => 0.0,
                false => (place(t) - place(t - dt)) / dt,
            };
            let by = after - before;
            if by == 0.0 {
                continue;
            }
            is_any = true;
            add_scaled(by, &course.carried, &mut self.change);
            let of_force = 0.5 * dt * centred * damping.stiffness * by;
            add_scaled(of_force, &course.force, &mut self.impulse);
        }
        if !is_any {
            return false;
        }
        let of_mass = 1.0 + 0.5 * dt * damping.mass;
        let impulses = self.impulse.iter_mut().zip(operators.mass());
        for ((impulse, mass), change) in impulses.zip(&self.change) {
            *impulse += of_mass * mass * change;
        }
        if let Some(extra) = &damping.extra {
            extra.subtract_scaled_product(-0.5 * dt * centred, &self.change, &mut self.impulse);
        }
        true
    }
}
