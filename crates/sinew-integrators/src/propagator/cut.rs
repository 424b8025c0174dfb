//! The series of the exact motion, truncated so that no mode grows.

use sinew_core::SetupError;
use sinew_core::closed_form::Mode;

use super::quadrature::quadrature;
use super::resolution::Resolution;
use super::series::{evaluate, interpolate, nodes, tails};

/// Points per degree at which a step is compared with the exact one. The norms oscillate at most twice per degree, so
/// that a value between two points is larger by half a percent.
const POINTS_PER_DEGREE: usize = 32;
/// Margin for values between the points.
const BETWEEN: f64 = 1.05;
/// Growth of a step that can be due to rounding.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The exact motion over a step as Chebyshev series on 0..`interval`, long enough to be exact.
///
/// A mode of eigenvalue lambda = omega^2, its displacement u counted from its equilibrium, moves by the matrix
/// `E = [[1 - lambda g, omega s], [-omega s, s']]` on `(omega u, v)`, whose length is the square root of twice its
/// energy. |E| <= 1, as no energy is added.
#[derive(Debug)]
pub(super) struct Motion {
    /// Lambda (1/s^2).
    pub(super) interval: f64,
    pub(super) dt: f64,
    /// alpha and beta of D = alpha M + beta K.
    pub(super) damping: (f64, f64),
    /// Impulse response.
    pub(super) s: Vec<f64>,
    /// Its rate.
    pub(super) s_rate: Vec<f64>,
    /// Its integral.
    pub(super) g: Vec<f64>,
}

/// Polynomials for the three functions of a [`Motion`] with which no mode grows.
///
/// Truncated at degree m, the series give a matrix T for E, of norm up to 1 + epsilon: a mode then grows without bound.
/// Three polynomials correct T. With the kernel of Dirichlet `Q = (1 + 2 sum cos(k theta))/(2m + 1)`,
/// `lambda = Lambda (1 - cos(theta))/2`, which is 1 at lambda = 0 and small elsewhere,
///
/// 1. multiples of Q make s, s' and g exact at lambda = 0, where a body moves rigidly;
/// 2. `(1 - eta) T + eta Q diag(1, s'(0))` replaces T. Its norm is at most `(1 - eta) |T| + eta |Q|`, hence at most 1
///    once `eta >= (|T| - 1)/(|T| - |Q|)` at every lambda, which determines eta, the relaxation. It is about epsilon.
///    Near lambda = 0, where Q is 1, slow modes are hardly affected, and `1 - lambda g` stays 1 there, so that
///    equilibria stay exact.
#[derive(Clone, Debug)]
pub(super) struct Cut {
    pub(super) s: Vec<f64>,
    pub(super) s_rate: Vec<f64>,
    pub(super) g: Vec<f64>,
    /// eta.
    pub(super) relaxation: f64,
    /// Largest norm of the difference from E over all lambda, and no less than the relaxation.
    pub(super) error: f64,
}

impl Cut {
    pub(super) fn degree(&self) -> usize {
        self.s.len() - 1
    }
}

/// `[[a, b], [c, d]]`.
type Matrix = [f64; 4];

/// The largest singular value.
fn norm([a, b, c, d]: Matrix) -> f64 {
    0.5 * ((a + d).hypot(b - c) + (a - d).hypot(b + c))
}

/// A mode of eigenvalue lambda at a point of the comparison.
struct Point {
    /// E.
    exact: Matrix,
    /// T.
    cut: Matrix,
    /// Q.
    kernel: f64,
}

impl Motion {
    /// The series truncated at the given degree or at the smallest one that meets the tolerance.
    pub(super) fn cut(&self, resolution: Resolution) -> Result<Cut, SetupError> {
        // What rounding of g, which is of the size of dt^2, does to lambda g.
        let rounding = ROUNDING * self.interval * self.dt * self.dt;
        let degree = resolution.degree_for(&self.left_out(), self.dt, |degree| {
            self.cut_at(degree).error - rounding
        })?;
        Ok(self.cut_at(degree))
    }

    /// An estimate of the error at each degree: the sum of the terms left out of each series, relative to
    /// dt, 1 and dt^2/2.
    fn left_out(&self) -> Vec<f64> {
        let (s, s_rate, g) = (tails(&self.s), tails(&self.s_rate), tails(&self.g));
        let dt = self.dt;
        let degrees = 0..self.s.len();
        degrees
            .map(|k| (s[k] / dt).max(s_rate[k]).max(2.0 * g[k] / (dt * dt)))
            .collect()
    }

    fn mode(&self, lambda: f64) -> Mode {
        let (alpha, beta) = self.damping;
        Mode {
            lambda,
            damping: alpha + beta * lambda,
        }
    }

    fn exact(&self, lambda: f64) -> Matrix {
        let mode = self.mode(lambda);
        let (s, s_rate) = mode.impulse(self.dt);
        let off = lambda.sqrt() * s;
        // From s'' + d s' + lambda s = 0, integrated.
        [s_rate + mode.damping * s, off, -off, s_rate]
    }

    fn cut_at(&self, degree: usize) -> Cut {
        let kernel = kernel(degree);
        let rigid = self.mode(0.0);
        let (s_at_zero, rate_at_zero) = rigid.impulse(self.dt);
        let g_at_zero = quadrature(self.dt, rigid.damping)
            .into_iter()
            .map(|(t, weight)| weight * rigid.impulse(self.dt - t).0)
            .sum();
        let mended = |series: &[f64], at_zero: f64| {
            let mut series = series[..=degree].to_vec();
            let missing = at_zero - evaluate(&series, 0.0, self.interval);
            add(&mut series, missing, &kernel);
            series
        };
        let mut s = mended(&self.s, s_at_zero);
        let mut s_rate = mended(&self.s_rate, rate_at_zero);
        let mut g = mended(&self.g, g_at_zero);

        let count = POINTS_PER_DEGREE * (degree + 1);
        let point = |number: usize| {
            let theta = std::f64::consts::PI * number as f64 / count as f64;
            let lambda = self.interval * (theta / 2.0).sin().powi(2);
            let value = |series: &[f64]| evaluate(series, lambda, self.interval);
            let off = lambda.sqrt() * value(&s);
            Point {
                exact: self.exact(lambda),
                cut: [1.0 - lambda * value(&g), off, -off, value(&s_rate)],
                kernel: value(&kernel),
            }
        };
        let points: Vec<Point> = (1..=count).map(point).collect();
        let needed = |point: &Point| {
            let size = norm(point.cut);
            (size - 1.0 - ROUNDING) / (size - point.kernel.abs())
        };
        let growing = points
            .iter()
            .filter(|point| norm(point.cut) > 1.0 + ROUNDING);
        let relaxation = (BETWEEN * growing.map(needed).fold(0.0, f64::max) + ROUNDING).min(1.0);
        let error = |point: &Point| {
            let rest = [point.kernel, 0.0, 0.0, rate_at_zero * point.kernel];
            norm(std::array::from_fn(|i| {
                (1.0 - relaxation) * point.cut[i] + relaxation * rest[i] - point.exact[i]
            }))
        };
        // A rigid motion stores no energy in displacements; its way falls short by the relaxation.
        let error = (BETWEEN * points.iter().map(error).fold(0.0, f64::max)).max(relaxation);

        for series in [&mut s, &mut s_rate, &mut g] {
            for coefficient in series {
                *coefficient *= 1.0 - relaxation;
            }
        }
        add(&mut s_rate, relaxation * rate_at_zero, &kernel);
        let values: Vec<f64> = nodes(degree + 1, self.interval)
            .into_iter()
            .map(|lambda| (1.0 - evaluate(&kernel, lambda, self.interval)) / lambda)
            .collect();
        let mut divided = vec![0.0; degree + 1];
        interpolate(&values, &mut divided);
        add(&mut g, relaxation, &divided);
        Cut {
            s,
            s_rate,
            g,
            relaxation,
            error,
        }
    }
}

/// The series of Q: `cos(k theta) = (-1)^k T_k`.
fn kernel(degree: usize) -> Vec<f64> {
    let share = 1.0 / (2 * degree + 1) as f64;
    (0..=degree)
        .map(|k| match k {
            0 => share,
            _ if k % 2 == 0 => 2.0 * share,
            _ => -2.0 * share,
        })
        .collect()
}

fn add(series: &mut [f64], factor: f64, other: &[f64]) {
    for (coefficient, other) in series.iter_mut().zip(other) {
        *coefficient += factor * other;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion(reach: f64, alpha: f64, beta: f64) -> Motion {
        let dt = 0.02;
        let interval = (reach / dt).powi(2);
        let damping = (alpha / dt, beta * dt);
        let count = (60.0 + 2.0 * reach) as usize;
        let mode = |lambda: f64| Mode {
            lambda,
            damping: damping.0 + damping.1 * lambda,
        };
        let series = |function: &dyn Fn(Mode) -> f64| {
            let values: Vec<f64> = nodes(count, interval)
                .into_iter()
                .map(|lambda| function(mode(lambda)))
                .collect();
            let mut coefficients = vec![0.0; count];
            interpolate(&values, &mut coefficients);
            coefficients
        };
        Motion {
            interval,
            dt,
            damping,
            s: series(&|mode| mode.impulse(dt).0),
            s_rate: series(&|mode| mode.impulse(dt).1),
            g: series(&|mode| {
                let (s, rate) = mode.impulse(dt);
                (1.0 - rate - mode.damping * s) / mode.lambda
            }),
        }
    }

    /// The step of one mode by the polynomials in use.
    fn step(motion: &Motion, cut: &Cut, lambda: f64) -> Matrix {
        let value = |series: &[f64]| evaluate(series, lambda, motion.interval);
        let off = lambda.sqrt() * value(&cut.s);
        [1.0 - lambda * value(&cut.g), off, -off, value(&cut.s_rate)]
    }

    /// Checks 20 times as many points as were used to find the relaxation, points between those included.
    #[test]
    fn no_mode_grows_and_none_is_off_by_more_than_is_said() {
        for (reach, alpha, beta) in [
            (0.1, 0.0, 0.0),
            (5.0, 0.0, 0.0),
            (20.0, 0.0, 0.0),
            (20.0, 0.01, 0.0),
            (20.0, 2.0, 0.0),
            (20.0, 0.0, 1e-4),
            (20.0, 0.1, 0.05),
            (150.0, 0.0, 0.0),
        ] {
            let motion = motion(reach, alpha, beta);
            let rounding = 1e-15 * (1.0 + reach * reach);
            for tolerance in [0.9, 1e-1, 1e-2, 1e-4, 1e-10] {
                let resolution = Resolution {
                    tolerance,
                    degree: None,
                };
                let cut = motion.cut(resolution).unwrap();
                let what = format!("{reach} {alpha} {beta} {tolerance:e}");
                assert!(cut.error <= tolerance + 4.0 * rounding, "{what}");
                let count = 640 * (cut.degree() + 1) + 7;
                let (mut size, mut error) = (0.0_f64, 0.0_f64);
                for number in 0..=count {
                    let theta = std::f64::consts::PI * number as f64 / count as f64;
                    let lambda = motion.interval * (theta / 2.0).sin().powi(2);
                    let step = step(&motion, &cut, lambda);
                    let exact = motion.exact(lambda);
                    size = size.max(norm(step));
                    error = error.max(norm(std::array::from_fn(|i| step[i] - exact[i])));
                }
                assert!(size <= 1.0 + rounding, "{what}: {:e}", size - 1.0);
                assert!(
                    error <= cut.error + rounding,
                    "{what}: {error:e} {:e}",
                    cut.error
                );
                assert!(
                    error.max(cut.relaxation) >= 0.9 * cut.error - 4.0 * rounding,
                    "{what}: {error:e}"
                );
            }
        }
    }

    #[test]
    fn a_rigid_body_keeps_its_velocity_and_no_less_than_the_rest_of_its_way() {
        for (alpha, tolerance) in [(0.0, 1e-2), (0.0, 1e-6), (0.5, 1e-2)] {
            let motion = motion(20.0, alpha, 0.0);
            let resolution = Resolution {
                tolerance,
                degree: None,
            };
            let cut = motion.cut(resolution).unwrap();
            let (s, rate) = motion.mode(0.0).impulse(motion.dt);
            assert!((evaluate(&cut.s_rate, 0.0, motion.interval) - rate).abs() <= 1e-14);
            let short = 1.0 - evaluate(&cut.s, 0.0, motion.interval) / s;
            assert!((short - cut.relaxation).abs() <= 1e-13, "{short:e}");
        }
    }

    #[test]
    fn the_norm_is_the_largest_stretch() {
        let [a, b, c, d] = [0.3, -1.2, 0.7, 0.4];
        let stretch = |angle: f64| {
            let (x, y) = (angle.cos(), angle.sin());
            (a * x + b * y).hypot(c * x + d * y)
        };
        let largest = (0..100_000)
            .map(|i| stretch(f64::from(i) * 1e-4))
            .fold(0.0, f64::max);
        assert!((norm([a, b, c, d]) - largest).abs() <= 1e-8);
    }
}
