//! The slowest elastic motion of a system.

use sinew_core::vectors::{add_scaled, dot, noise, scale, weighted_dot};
use sinew_core::{FreePart, LinearOperators};

use crate::blocks::CellBlocks;
use crate::rigid::{RigidMotions, by_diagonal};

/// Largest number of products of its search.
const MOST_PRODUCTS: usize = 400;

/// Number of products between two checks, and the relative change of the squared frequency between them at which it has
/// converged.
const LOOK: usize = 10;
const FOUND: f64 = 1e-4;

/// The slowest motion that strains a body, or one of nearly the same frequency: to some thousandths of its frequency,
/// or a few hundredths in bodies that are much longer than thick.
#[derive(Debug)]
pub(crate) struct SlowestMode {
    /// Its shape.
    pub(crate) shape: Vec<f64>,
    /// The square of its angular frequency (1/s^2).
    pub(crate) omega_squared: f64,
}

impl SlowestMode {
    /// Lowers Rayleigh's quotient of K and M by conjugate gradients (Bradbury and Fletcher, Numer. Math. 9, 1966) with
    /// the diagonal blocks of K as preconditioner and directions of Polak and Ribiere, orthogonal to the rigid motions
    /// of these parts; `None` if there is no strain.
    pub(crate) fn of(operators: &LinearOperators, parts: &[FreePart]) -> Option<Self> {
        let (stiffness, mass) = (operators.stiffness(), operators.mass());
        let mut rigid: Vec<RigidMotions> = parts.iter().cloned().map(RigidMotions::new).collect();
        rigid.retain_mut(|part| part.take(None, by_diagonal(|dof| mass[dof])));
        let project = |x: &mut [f64]| {
            for part in &rigid {
                let sums = part.sums(&part.weighted, x).map(|sum| -sum);
                part.add(&part.motions, &sums, x);
            }
        };
        let mut blocks = CellBlocks::of_mass(stiffness.layers(), mass, 0.0);
        blocks.add_diagonal(stiffness, 1.0);
        let inverse = blocks.inverse();

        let n = operators.dofs();
        let zeros = || vec![0.0; n];
        let (mut x, mut kx, mut direction, mut kd) = (zeros(), zeros(), zeros(), zeros());
        let (mut slope, mut slope_before, mut led) = (zeros(), zeros(), zeros());
        // Components that nothing resists have no part in it.
        inverse.multiply(&noise(n, 7), &mut x);
        project(&mut x);
        stiffness.multiply(&x, &mut kx);
        let (mut before, mut steepness_before) = (f64::INFINITY, 0.0);
        for product in 0..MOST_PRODUCTS {
            let size = weighted_dot(mass, &x, &x).sqrt();
            let is_sound = size > 0.0 && size.is_finite();
            if !is_sound {
                return None;
            }
            scale(&mut x, 1.0 / size);
            scale(&mut kx, 1.0 / size);
            let quotient = dot(&x, &kx);
            if product % LOOK == 0 {
                if before - quotient <= FOUND * quotient {
                    break;
                }
                before = quotient;
            }
            std::mem::swap(&mut slope, &mut slope_before);
            for (slope, ((kx, x), mass)) in slope.iter_mut().zip(kx.iter().zip(&x).zip(mass)) {
                *slope = kx - quotient * mass * x;
            }
            inverse.multiply(&slope, &mut led);
            project(&mut led);
            let steepness = dot(&slope, &led);
            let goes_on = steepness > 0.0;
            if !goes_on {
                break;
            }
            // The last slope and direction were those of a vector `size` times as long.
            let conjugate = match steepness_before > 0.0 {
                true => (size * steepness - dot(&led, &slope_before)) / steepness_before,
                false => 0.0,
            };
            let conjugate = conjugate.max(0.0);
            steepness_before = steepness;
            for (direction, led) in direction.iter_mut().zip(&led) {
                *direction = conjugate * *direction - led;
            }
            stiffness.multiply(&direction, &mut kd);
            // The least over x + t d: the smaller root of det(K - r M) = 0 over the two.
            let [a, b, c] = [quotient, dot(&direction, &kx), dot(&direction, &kd)];
            let e = weighted_dot(mass, &x, &direction);
            let f = weighted_dot(mass, &direction, &direction);
            // (b + t c)(1 + 2 t e + t^2 f) = (a + 2 t b + t^2 c)(e + t f).
            let [second, first, none] = [c * e - b * f, c - a * f, b - a * e];
            let root = (first * first - 4.0 * second * none).max(0.0).sqrt();
            let t = -2.0 * none / (first + root);
            if !t.is_finite() {
                break;
            }
            add_scaled(t, &direction, &mut x);
            add_scaled(t, &kd, &mut kx);
        }
        let omega_squared = dot(&x, &kx) / weighted_dot(mass, &x, &x);
        (omega_squared > 0.0).then_some(Self {
            shape: x,
            omega_squared,
        })
    }
}
