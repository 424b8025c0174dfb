//! The first step of a fitted two-step form.

use std::f64::consts::PI;

use sinew_core::closed_form::Mode;

use super::amplitude::{ModeRecurrence, exact_from_velocity};
use super::dense::solve;
use super::excitation::ExcitedMode;
use crate::propagator::first_step::FirstStep;
use crate::propagator::peaks::{top_about, tops};
use crate::propagator::series::evaluate;

/// Points per coefficient at which s is fitted.
const POINTS_PER_TERM: usize = 8;

/// |cos theta| of a turning point from which on theta counts as passing through 0 or pi there.
const TURNS: f64 = 0.8;

/// Weight of the error under loads relative to that of amplitudes.
const LOADED: f64 = 1e6;

/// Points per coefficient at which the largest amplitude is sought.
const LOOKS_PER_TERM: usize = 32;

/// x at an angle: 0 at 0, 1 at pi.
fn x_of(angle: f64) -> f64 {
    0.5 - 0.5 * angle.cos()
}

/// The recurrence of a fitted form.
pub(super) struct Fitted<'a> {
    /// Series of `G/dt^2`.
    pub(super) g: &'a [f64],
    /// Lambda (1/s^2).
    pub(super) interval: f64,
    /// alpha (1/s).
    pub(super) alpha: f64,
    /// Step (s).
    pub(super) dt: f64,
    /// Modes that the loads excite.
    pub(super) modes: &'a [ExcitedMode],
}

/// The first step, and all quantities that follow from its s.
pub(super) struct Start {
    pub(super) first_step: FirstStep,
    /// Series of `2 g - G`, the effect of a jump for half the jump; empty without damping.
    pub(super) of_jump: Vec<f64>,
    /// Largest amplitude of any mode, from a velocity or from a displacement alone, over that of the exact motion.
    pub(super) amplitude: f64,
    /// Error, due to s, of the response to a jump of the loads, relative to the response.
    pub(super) error: f64,
}

impl Fitted<'_> {
    fn decay(&self) -> f64 {
        (-self.alpha * self.dt / 2.0).exp()
    }

    /// lambda G at x = lambda/Lambda.
    fn value(&self, x: f64) -> f64 {
        self.interval * self.dt * self.dt * x * self.shape(x)
    }

    /// cos theta; theta is the phase change of a mode in a step of the recurrence.
    fn cosine(&self, x: f64) -> f64 {
        let decay = self.decay();
        (1.0 + decay * decay - self.value(x)) / (2.0 * decay)
    }

    /// sin theta, 0 if theta is not real.
    fn sine(&self, x: f64) -> f64 {
        let (decay, value) = (self.decay(), self.value(x));
        let below = (value - (1.0 - decay).powi(2)).max(0.0);
        let above = ((1.0 + decay).powi(2) - value).max(0.0);
        (below * above).sqrt() / (2.0 * decay)
    }

    fn shape(&self, x: f64) -> f64 {
        evaluate(self.g, x * self.interval, self.interval)
    }

    /// `w dt`, `w^2 = lambda - alpha^2/4`; 0 if a mode creeps.
    fn turn(&self, x: f64) -> f64 {
        let squared = x * self.interval - self.alpha * self.alpha / 4.0;
        squared.max(0.0).sqrt() * self.dt
    }

    /// The largest value of `|e^(-eta n) sin(n theta)|` over `e^-eta`, up to a factor near 1, is
    /// that of `sin theta` over this.
    fn divisor(&self, x: f64) -> f64 {
        self.sine(x).hypot(self.alpha * self.dt / 2.0)
    }

    /// The first step `u+ = u + s v + g r` that fits the recurrence: s is near `e^-eta sin theta/w`, so that the
    /// amplitude of no mode is larger than that, also if the recurrence hardly changes its phase, and
    /// `lambda g = 1 - e^-eta cos theta - alpha s/2` follows from it. With `s = s_0 + lambda s_1`,
    /// `alpha s_0 = 1 - e^(-2 eta)` that is `g = G/2 - alpha s_1/2`.
    pub(super) fn start(&self) -> Start {
        let terms = 2 * (self.g.len() - 1).max(1);
        let at_zero = self.at_zero();
        let slope = self.slope(terms, at_zero);
        // s/dt = s_0 + x h, x = (1 + T_1)/2.
        let mut of_velocity = vec![0.0; terms + 1];
        of_velocity[0] = at_zero;
        for (k, h) in slope.iter().enumerate() {
            of_velocity[k] += 0.5 * h;
            of_velocity[k + 1] += 0.25 * h;
            of_velocity[k.abs_diff(1)] += 0.25 * h;
        }
        let points = LOOKS_PER_TERM * terms;
        let everywhere = (1..=points).map(|point| PI * point as f64 / points as f64);
        // The recurrence is most sensitive close to where theta turns round.
        let towards = |angle: f64| self.cosine(x_of(angle)).abs();
        let close = tops(towards, points).into_iter().flat_map(|top| {
            let offsets = (1..=10).map(|digits| 10.0_f64.powi(-digits));
            offsets.flat_map(move |offset| [top - offset, top, top + offset])
        });
        let amplitudes = everywhere.chain(close).map(|angle| {
            let x = x_of(angle);
            let s = evaluate(&of_velocity, x * self.interval, self.interval);
            self.amplitude(x, s)
        });
        let amplitude = amplitudes.fold(0.0, f64::max);
        let errors = self.modes.iter().map(|mode| {
            let x = mode.lambda / self.interval;
            let s = evaluate(&of_velocity, mode.lambda, self.interval);
            let off = 0.5 * self.alpha * self.dt * (s - self.exact(x)) / self.divisor(x).max(1e-6);
            mode.share * off * off
        });
        let error = errors.sum::<f64>().sqrt();
        of_velocity.iter_mut().for_each(|term| *term *= self.dt);
        let of_slope = -self.alpha * self.dt / self.interval;
        let of_jump: Vec<f64> = match self.alpha {
            0.0 => Vec::new(),
            _ => slope.iter().map(|h| of_slope * h).collect(),
        };
        let mut of_force: Vec<f64> = self.g.iter().map(|g| 0.5 * self.dt * self.dt * g).collect();
        of_force.resize(of_force.len().max(of_jump.len()), 0.0);
        for (force, jump) in of_force.iter_mut().zip(&of_jump) {
            *force += 0.5 * jump;
        }
        Start {
            first_step: FirstStep {
                of_velocity,
                of_force,
            },
            of_jump,
            amplitude,
            error,
        }
    }

    /// The largest amplitude of a mode with this s/dt, from a velocity and from a displacement alone, over that of
    /// the exact motion.
    fn amplitude(&self, x: f64, s: f64) -> f64 {
        let lambda = x * self.interval;
        if lambda == 0.0 {
            return 0.0;
        }
        let decay = self.decay();
        let mean = 0.5 * (1.0 + decay * decay - self.value(x));
        let recurrence = ModeRecurrence { mean, decay };
        let exact = exact_from_velocity(lambda, self.alpha) / self.dt;
        // 1 - lambda g of a first step from a displacement.
        let kept = mean + 0.5 * self.alpha * self.dt * s;
        let from_velocity = recurrence.largest(0.0, s) / exact;
        from_velocity.max(recurrence.largest(1.0, kept))
    }

    /// s/dt of the exact motion.
    fn exact(&self, x: f64) -> f64 {
        let mode = Mode {
            lambda: x * self.interval,
            damping: self.alpha,
        };
        mode.impulse(self.dt).0 / self.dt
    }

    /// s/dt at lambda = 0.
    fn at_zero(&self) -> f64 {
        let twice = self.alpha * self.dt;
        match twice {
            0.0 => 1.0,
            _ => -(-twice).exp_m1() / twice,
        }
    }

    /// The series h in `s/dt = s_0 + x h`, by least squares of the relative error of amplitudes.
    fn slope(&self, terms: usize, at_zero: f64) -> Vec<f64> {
        let mut matrix = vec![0.0; terms * terms];
        let mut slope = vec![0.0; terms];
        // Amplitudes relative to the exact ones, and errors under loads.
        let half = self.alpha * self.dt / 2.0;
        let of_spectrum = self.targets(POINTS_PER_TERM * terms).into_iter();
        let of_spectrum =
            of_spectrum.map(|(x, target)| (x, target, self.turn(x).hypot(half).powi(2)));
        let weight = LOADED * (POINTS_PER_TERM * terms) as f64;
        let of_loads = self.modes.iter().map(|mode| {
            let x = mode.lambda / self.interval;
            (x, self.exact(x), weight * mode.share * half * half)
        });
        for (x, target, weight) in of_spectrum.chain(of_loads) {
            let weight = weight / self.divisor(x).max(1e-6).powi(2);
            let angle = (2.0 * x - 1.0).clamp(-1.0, 1.0).acos();
            let row: Vec<f64> = (0..terms).map(|k| x * (k as f64 * angle).cos()).collect();
            for (i, a) in row.iter().enumerate() {
                slope[i] += weight * a * (target - at_zero);
                for (entry, b) in matrix[i * terms..].iter_mut().zip(&row) {
                    *entry += weight * a * b;
                }
            }
        }
        let trace = (0..terms)
            .map(|i| matrix[i * terms + i])
            .fold(0.0, f64::max);
        for i in 0..terms {
            matrix[i * terms + i] += 1e-14 * trace;
        }
        if !solve(&mut matrix, &mut slope) {
            slope.fill(0.0);
        }
        slope
    }

    /// Points x at which s is fitted, in increasing order, with the value of s/dt: `e^-eta sin theta/(w dt)`, whose
    /// sign changes where theta turns around close to 0 or pi, as if theta passed through it; there the value is 0.
    fn targets(&self, points: usize) -> Vec<(f64, f64)> {
        let width = PI / points as f64;
        let cosine = |point: usize| self.cosine(x_of(point as f64 * width));
        let mut targets = Vec::new();
        let mut sign = 1.0;
        for point in 1..=points {
            let (before, here) = (cosine(point - 1), cosine(point));
            let x = x_of(point as f64 * width);
            let turn = self.turn(x);
            let target = match turn > 0.0 {
                true => sign * self.decay() * self.sine(x) / turn,
                false => self.exact(x),
            };
            targets.push((x, target));
            let turns = point < points && (here - before) * (cosine(point + 1) - here) <= 0.0;
            if turns && here.abs() > TURNS && turn > 0.0 {
                let towards = here.signum();
                let angle = top_about(
                    &|angle| towards * self.cosine(x_of(angle)),
                    point as f64 * width,
                    width,
                );
                sign = -sign;
                let turned = x_of(angle);
                if turned < x {
                    // The point itself lies beyond.
                    if let Some((_, target)) = targets.last_mut() {
                        *target = -*target;
                    }
                }
                targets.push((turned, 0.0));
            }
        }
        targets
    }
}
