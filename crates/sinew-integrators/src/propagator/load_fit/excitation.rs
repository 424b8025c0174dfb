//! The motion that loads excite, and the error of a two-step polynomial in it.

use sinew_core::LinearOperators;
use sinew_core::gauss_points;
use sinew_core::spectrum::spectral_measure;

use super::super::two_step::half_sine;
use crate::load_case::LoadCase;

/// Smallest eigenvalue that counts as a vibration, relative to the largest.
const RIGID: f64 = 1e-6;

/// Share of a load's measure on rigid motions above which it counts as moving the body as a whole.
const RIGID_SHARE: f64 = 1e-9;

/// Periods of the load's mean frequency over which errors are taken.
const PERIODS: f64 = 8.0;

/// Time constants of a creeping body over which errors are taken.
const TIME_CONSTANTS: f64 = 4.0;

/// Panels of the quadrature over the horizon.
const PANELS: usize = 8;

/// Phase (rad) beyond which a larger phase error makes no difference.
const LOST_PHASE: f64 = 60.0;

/// Modes that loads excite when they are suddenly applied and kept, with the share of each mode in the squared
/// response.
#[derive(Clone, Debug)]
pub(super) struct Excitation {
    pub(super) modes: Vec<ExcitedMode>,
    /// True if loads excite a rigid motion, so that the body drifts away.
    pub(super) drifts: bool,
    /// Number of products with K that were needed to find them.
    pub(super) products: usize,
    alpha: f64,
    dt: f64,
    /// Instants (s) of the horizon with their weights, which add up to 1.
    instants: Vec<(f64, f64)>,
}

/// A mode, or a Gauss point that represents several modes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ExcitedMode {
    /// lambda (1/s^2).
    pub(super) lambda: f64,
    /// Squared static displacement over the sum of squared responses of all modes.
    pub(super) share: f64,
}

impl Excitation {
    /// The motion under the loads of a system with mass damping, eigenvalues up to `interval` (1/s^2), in
    /// steps of `dt` (s); `None` without loads.
    pub(super) fn of(operators: &LinearOperators, interval: f64, dt: f64) -> Option<Self> {
        let floor = RIGID * interval;
        let (mut modes, mut drifts, mut products) = (Vec::new(), false, 0);
        for case in LoadCase::of(operators) {
            let measure = spectral_measure(operators, &case.force, floor);
            products += measure.len();
            let whole: f64 = measure.iter().map(|point| point.weight).sum();
            let rigid = measure.iter().filter(|point| point.eigenvalue <= floor);
            let rigid: f64 = rigid.map(|point| point.weight).sum();
            drifts |= rigid > RIGID_SHARE * whole;
            let elastic = measure.iter().filter(|point| point.eigenvalue > floor);
            modes.extend(elastic.map(|point| ExcitedMode {
                lambda: point.eigenvalue,
                share: (case.peak() / point.eigenvalue).powi(2) * point.weight,
            }));
        }
        if modes.is_empty() && !drifts {
            return None;
        }
        let alpha = operators.damping().mass;
        let size: f64 = modes.iter().map(|mode| mode.share).sum();
        let stiffness: f64 = modes.iter().map(|mode| mode.share * mode.lambda).sum();
        // Rayleigh's quotient of the static displacement.
        let mean = if size > 0.0 {
            stiffness / size
        } else {
            interval
        };
        let periods = PERIODS * std::f64::consts::TAU / mean.sqrt();
        let horizon = periods.max(TIME_CONSTANTS * alpha / mean).max(dt);
        let edge = |panel: usize| horizon * panel as f64 / PANELS as f64;
        let points = (0..PANELS).flat_map(|panel| gauss_points(edge(panel), edge(panel + 1)));
        let instants = points.map(|(t, weight)| (t, weight / horizon)).collect();
        let mut excitation = Self {
            modes,
            drifts,
            products,
            alpha,
            dt,
            instants,
        };
        let response = |mode: &ExcitedMode| mode.share * excitation.response(mode.lambda);
        let whole: f64 = excitation.modes.iter().map(response).sum();
        for mode in &mut excitation.modes {
            mode.share /= whole;
        }
        Some(excitation)
    }

    fn mean(&self, of: impl Fn(f64) -> f64) -> f64 {
        let terms = self.instants.iter();
        terms.map(|(t, weight)| weight * of(*t)).sum()
    }

    fn decay(&self) -> f64 {
        (-self.alpha * self.dt / 2.0).exp()
    }

    /// The exact value of `lambda G` (dimensionless).
    pub(super) fn exact(&self, lambda: f64) -> f64 {
        let decay = self.decay();
        let squared = lambda - self.alpha * self.alpha / 4.0;
        let s = half_sine(lambda, self.alpha, self.dt);
        (1.0 - decay).powi(2) + decay * squared * s * s
    }

    /// The exact value of G at lambda = 0 (s^2).
    pub(super) fn exact_at_zero(&self) -> f64 {
        let eta = self.alpha * self.dt / 2.0;
        let shape = match eta {
            0.0 => 1.0,
            _ => -(-2.0 * eta).exp_m1() / (2.0 * eta),
        };
        self.dt * self.dt * shape
    }

    /// Mean square of a mode's response to a load applied suddenly, over the square of its static one.
    fn response(&self, lambda: f64) -> f64 {
        match self.motion(self.exact(lambda)) {
            Motion::Swings(_) => 1.0 + 0.5 * self.mean(|t| (-self.alpha * t).exp()),
            Motion::Creeps(rate) => self.mean(|t| (-rate * t).exp_m1().powi(2)),
        }
    }

    /// The motion of a mode with this value of `lambda G`, whose phase changes by theta in a step:
    /// `lambda G = 1 + e^(-2 eta) - 2 e^-eta cos theta`.
    fn motion(&self, value: f64) -> Motion {
        let decay = self.decay();
        let cosine = (1.0 + decay * decay - value) / (2.0 * decay);
        if cosine <= 1.0 {
            return Motion::Swings(cosine.max(-1.0).acos() / self.dt);
        }
        let growth = cosine.acosh() / self.dt;
        Motion::Creeps((self.alpha / 2.0 - growth).max(0.0))
    }

    /// Mean square over the horizon of the error of a mode whose `lambda G` has this value, over the square of
    /// its static displacement.
    pub(super) fn error(&self, lambda: f64, value: f64) -> f64 {
        match (self.motion(self.exact(lambda)), self.motion(value)) {
            // (cos a - cos b)^2 = 4 sin^2((a + b)/2) sin^2((a - b)/2), the former sine taken by its mean.
            (Motion::Swings(exact), Motion::Swings(found)) => {
                let horizon = self.instants.iter().map(|(t, _)| *t).fold(0.0, f64::max);
                let off = (exact - found).abs().min(LOST_PHASE / horizon);
                self.mean(|t| 2.0 * (-self.alpha * t).exp() * (off * t / 2.0).sin().powi(2))
            }
            (exact, found) => {
                let (exact, found) = (exact.rate(self.alpha), found.rate(self.alpha));
                self.mean(|t| ((-exact * t).exp() - (-found * t).exp()).powi(2))
            }
        }
    }

    /// Estimated error of a run from rest under these loads, relative to its size, both as mean squares over the
    /// horizon, for a polynomial `lambda G` and its relative error at lambda = 0.
    pub(super) fn estimate(&self, value: impl Fn(f64) -> f64, off_at_zero: f64) -> f64 {
        let modes = self.modes.iter();
        let squares: f64 = modes
            .map(|mode| mode.share * self.error(mode.lambda, value(mode.lambda)))
            .sum();
        let drift = if self.drifts { off_at_zero } else { 0.0 };
        squares.sqrt().max(drift.abs())
    }
}

/// Motion of a mode from rest.
enum Motion {
    /// Angular frequency (rad/s), up to pi/dt.
    Swings(f64),
    /// Rate (1/s) of the slower of two exponentials.
    Creeps(f64),
}

impl Motion {
    fn rate(self, alpha: f64) -> f64 {
        match self {
            Self::Swings(_) => alpha / 2.0,
            Self::Creeps(rate) => rate,
        }
    }
}
