//! Response of a body to moving supports outside the modes.

use sinew_cnn::equilibrium;
use sinew_core::vectors::{add_scaled, dot};
use sinew_core::{Clock, LinearOperators, Ramp};

use super::basis::Basis;
use crate::load_case::LoadCase;

/// Relative residual of forces at which a displacement counts as found.
const FOUND: f64 = 1e-12;

/// Share of a displacement, squared and weighted by mass, that counts as zero.
const NONE: f64 = 1e-20;

/// The response of a body to slowly moving supports, without its part in the modes: `u = g d - h (d'' + alpha d')`, d
/// being the factor of the motion. `K g = -K_p` is the displacement by the supports without inertia, and `K h = M g`
/// that by the inertia of this motion. The shapes of modes alone end in a jump at the supports, so that no strain field
/// of them gives the supports' forces. This is static correction (Dickens, Nakagawa and Wittbrodt, Computers &
/// Structures 62, 1997) with two terms of the series by derivatives of loads (Camarda, Haftka and Riley, Computers &
/// Structures 26, 1987).
#[derive(Debug, Default)]
pub(super) struct Carried {
    courses: Vec<Course>,
    /// alpha (1/s).
    damping: f64,
    /// A mass-orthonormal basis of the displacements (kg^-1/2), one vector after the other.
    directions: Vec<f64>,
}

/// A motion of supports.
#[derive(Debug)]
struct Course {
    ramp: Ramp,
    /// Part of g outside the modes (m), for a factor of 1.
    by_place: Vec<f64>,
    /// Part of h outside the modes (m s^2).
    by_acceleration: Vec<f64>,
}

impl Carried {
    pub(super) fn of(operators: &LinearOperators, basis: &Basis) -> Self {
        let mut carried = Self {
            damping: operators.damping().mass,
            ..Self::default()
        };
        if basis.complete {
            return carried;
        }
        let mass = operators.mass();
        for LoadCase { ramp, force } in LoadCase::of_places(operators) {
            let place = equilibrium(operators, &force, FOUND).displacement;
            let mut inertia: Vec<f64> = place.iter().zip(mass).map(|(x, m)| m * x).collect();
            for (shape, _) in basis.modes().filter(|(_, omega)| *omega == 0.0) {
                let part = dot(shape, &inertia);
                let moved = inertia.iter_mut().zip(shape).zip(mass);
                moved.for_each(|((force, shape), mass)| *force -= part * mass * shape);
            }
            let bent = equilibrium(operators, &inertia, FOUND).displacement;
            let course = Course {
                ramp,
                by_place: outside(basis, mass, place),
                by_acceleration: outside(basis, mass, bent),
            };
            carried.add_direction(mass, course.by_place.clone());
            carried.add_direction(mass, course.by_acceleration.clone());
            carried.courses.push(course);
        }
        carried
    }

    fn add_direction(&mut self, mass: &[f64], mut direction: Vec<f64>) {
        let whole = by_mass(mass, &direction);
        // Twice is enough.
        self.remove(mass, &mut direction);
        self.remove(mass, &mut direction);
        let left = by_mass(mass, &direction);
        if left > NONE * whole {
            let size = left.sqrt();
            let unit = direction.iter().map(|value| value / size);
            self.directions.extend(unit);
        }
    }

    /// Adds `times` times this part at the time `t` (s), after the events at that time, to displacements (m) and
    /// velocities (m/s).
    pub(super) fn add(&self, times: f64, t: f64, u: &mut [f64], v: &mut [f64]) {
        let after = t + Clock::ROUNDING * t.abs();
        for course in &self.courses {
            let mut d = [0.0; 4];
            course.ramp.derivatives_after(after, &mut d);
            let inertia = [2, 3].map(|order| -times * (d[order] + self.damping * d[order - 1]));
            add_scaled(times * d[0], &course.by_place, u);
            add_scaled(inertia[0], &course.by_acceleration, u);
            add_scaled(times * d[1], &course.by_place, v);
            add_scaled(inertia[1], &course.by_acceleration, v);
        }
    }

    /// Removes from x all components along these displacements.
    pub(super) fn remove(&self, mass: &[f64], x: &mut [f64]) {
        remove(mass, &self.directions, x);
    }
}

/// The part of a displacement outside the modes; the part inside follows from the forces on the modes.
fn outside(basis: &Basis, mass: &[f64], mut displacement: Vec<f64>) -> Vec<f64> {
    remove(mass, &basis.shapes, &mut displacement);
    remove(mass, &basis.shapes, &mut displacement);
    displacement
}

/// Removes from x the components along mass-orthonormal columns.
fn remove(mass: &[f64], columns: &[f64], x: &mut [f64]) {
    for column in columns.chunks_exact(x.len().max(1)) {
        let parts = x.iter().zip(mass).zip(column);
        let part = parts
            .map(|((x, mass), along)| mass * x * along)
            .sum::<f64>();
        add_scaled(-part, column, x);
    }
}

/// `x' M x`.
pub(super) fn by_mass(mass: &[f64], x: &[f64]) -> f64 {
    let squares = x.iter().zip(mass).map(|(x, mass)| mass * x * x);
    squares.sum()
}
