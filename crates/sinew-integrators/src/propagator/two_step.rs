//! The propagator in two-step form.

use sinew_cnn::{LoadAt, Program, When};
use sinew_core::closed_form::Mode;
use sinew_core::spectrum::Spectrum;
use sinew_core::{Fact, LinearOperators, SetupError};

use super::chebyshev::LARGEST_EIGENVALUE_MARGIN;
use super::first_step::FirstStep;
use super::peaks::{POINTS_PER_DEGREE, largest_value};
use super::quadrature::quadrature;
use super::recurrence::{KickRegisters, Recurrence, mass_damping, net_force};
use super::resolution::{HIGHEST_DEGREE, Resolution};
use super::series::{evaluate, interpolate, nodes, tails};

/// Smallest distance of sin(w dt/2) from 1: its rounding.
const LEAST_ROOM: f64 = 1e-13;

/// Largest distance of sin(w dt/2) from 1.
const MOST_ROOM: f64 = 0.25;

/// The exact displacements of a mass-damped linear system under piecewise constant loads, for half the sweeps of the
/// one-step form: `v+ = e^(-2 eta) v- + G(M^-1 K) M^-1 (F - K u)/dt`, `u+ = u + dt v+`, v being the mean velocity over
/// a step. Any mode `q'' + alpha q' + lambda q = r` moves in this way from one step to the next (Gautschi, Numer. Math.
/// 3, 1961; Hochbruck and Lubich, Numer. Math. 83, 1999, without damping), with
/// `lambda G = (1 - e^-eta)^2 + 4 e^-eta sin^2(w dt/2)`, `w^2 = lambda - alpha^2/4` and `eta = alpha dt/2`.
///
/// Only `S = sin(w dt/2)/(w/2)` is replaced by a polynomial. With its square in G,
/// `lambda G = (1 - e^-eta)^2 + e^-eta w^2 S^2` cannot fall below 0; S is scaled, by less than 5/4 of the tolerance, so
/// that `|w S|` stays a little below 2 between its zeros too, since a mode at 2 itself grows in proportion to the
/// number of steps; and eta follows from `sinh(eta/2) = alpha S(0)/4`, so that the right side is divisible by lambda
/// for any S. Every mode is then stable at any step and for any tolerance, which does not hold for a polynomial for G
/// itself.
///
/// The tolerance bounds the error of `sin(w dt/2) = w S/2` before S is scaled; after it, the error delta is at most 5/2
/// of the tolerance. The phase of an undamped mode then changes by `2 asin` of the inexact sine: its error is about
/// `2 delta/cos(w dt/2)` per step, and up to `2 sqrt(2 delta)` if the sine is near 1. From exact displacements, the
/// displacement after a step has an error of at most 8 delta of the distance from equilibrium, as `w^2 S^2 <= 4` there.
#[derive(Clone, Debug)]
pub(super) struct TwoStep {
    degree: usize,
    left_out: f64,
    /// Largest error of sin(w dt/2).
    sine_error: f64,
    /// Series of S and of (S - S(0))/lambda.
    s: Vec<f64>,
    divided: Vec<f64>,
    s_at_zero: f64,
    alpha: f64,
    recurrence: Recurrence,
}

/// S of one mode.
pub(super) fn half_sine(lambda: f64, alpha: f64, dt: f64) -> f64 {
    // An undamped mode of lambda - alpha^2/4 from 0 with velocity 1 over half a step is sin(w dt/2)/w.
    let mode = Mode {
        lambda: lambda - alpha * alpha / 4.0,
        damping: 0.0,
    };
    2.0 * mode.impulse(dt / 2.0).0
}

impl TwoStep {
    /// Chooses the degree and computes the coefficients.
    pub(super) fn new(
        operators: &LinearOperators,
        dt: f64,
        resolution: Resolution,
    ) -> Result<Self, SetupError> {
        let alpha = mass_damping(operators)?;
        let omega = Spectrum::of(operators).omega_max;
        let interval = omega.powi(2) * (1.0 + LARGEST_EIGENVALUE_MARGIN);
        let count = (48.0 + 0.75 * omega * dt).min(2.0 * HIGHEST_DEGREE as f64) as usize;
        let values: Vec<f64> = nodes(count, interval)
            .into_iter()
            .map(|lambda| half_sine(lambda, alpha, dt))
            .collect();
        let mut s = vec![0.0; count];
        interpolate(&values, &mut s);
        // Relative to S(0), which is about dt, and as much as |w S| may pass 2 by.
        let scale = (1.0 / dt).max(interval.sqrt() / 2.0);
        let left_out: Vec<f64> = tails(&s).into_iter().map(|tail| scale * tail).collect();
        let degree = resolution.degree_for(&left_out, dt, |degree| left_out[degree])?;
        s.truncate(degree + 1);
        let swing = largest_swing(&s, interval, alpha) / 2.0;
        // The first step is off by left_out, and a mode this near to 1 turns that into amplitude by the root of the
        // margin.
        let room = (0.1 * (swing - 1.0)).max(2.0 * left_out[degree].powi(2) + LEAST_ROOM);
        let scale = swing / (1.0 - room.min(MOST_ROOM));
        if scale > 1.0 {
            s.iter_mut().for_each(|coefficient| *coefficient /= scale);
        }

        let sine_error = largest_error(&s, interval, alpha, dt);
        let s_at_zero = evaluate(&s, 0.0, interval);
        let values: Vec<f64> = nodes(degree + 1, interval)
            .into_iter()
            .map(|lambda| (evaluate(&s, lambda, interval) - s_at_zero) / lambda)
            .collect();
        let mut divided = vec![0.0; degree + 1];
        interpolate(&values, &mut divided);
        let root_of_decay = (-2.0 * (alpha * s_at_zero / 4.0).asinh()).exp();
        Ok(Self {
            degree,
            left_out: left_out[degree],
            sine_error,
            s_at_zero,
            alpha,
            recurrence: Recurrence {
                decay: root_of_decay * root_of_decay,
                first_step: FirstStep::new(&s, interval, alpha, dt, root_of_decay),
                of_jump: jump_series(operators, interval, dt, 2 * degree),
                interval,
                dt,
                velocity: Recurrence::velocity_time(omega, dt),
            },
            s,
            divided,
        })
    }

    /// The step as a program.
    pub(super) fn program(&self) -> Program {
        // y = S r - alpha^2/4 (S - S0)/lambda r, then G r = e^-eta (S y - alpha^2/4 S0 (S - S0)/lambda r).
        let quarter = self.alpha * self.alpha / 4.0;
        let damped = quarter != 0.0;
        let of_sum = self.recurrence.decay.sqrt();
        self.recurrence.program(of_sum, ["y"], |program, with| {
            let KickRegisters {
                r, sum, vectors, ..
            } = with;
            let (r, sum, [y]) = (*r, *sum, with.own);
            let divided = program.named("divided");
            let add = |k: usize, x| {
                let mut updates = vec![match k {
                    0 => y.becomes([(x, self.s[0])]),
                    _ => y.plus(self.s[k], x),
                }];
                if damped {
                    updates.push(match k {
                        0 => divided.becomes([(x, self.divided[0])]),
                        _ => divided.plus(self.divided[k], x),
                    });
                }
                updates
            };
            let mut sweeps = vec![net_force(LoadAt::Around, r)];
            sweeps[0].updates.extend(add(0, r));
            sweeps.extend(vectors.sweeps(r, self.s.len(), When::Always, add));
            let s_0 = self.s[0];
            if let Some(last) = sweeps.last_mut() {
                if damped {
                    last.updates.push(y.plus(-quarter, divided));
                    let of_divided = -quarter * self.s_at_zero;
                    last.updates
                        .push(sum.becomes([(divided, of_divided), (y, s_0)]));
                } else {
                    last.updates.push(sum.becomes([(y, s_0)]));
                }
            }
            let add = |k: usize, x| vec![sum.plus(self.s[k], x)];
            sweeps.extend(vectors.sweeps(y, self.s.len(), When::Always, add));
            sweeps
        })
    }

    pub(super) fn facts(&self) -> Vec<Fact> {
        let fact = |name, value| Fact { name, value };
        vec![
            fact("degree", self.degree as f64),
            fact("left_out", self.left_out),
            fact("sine_error", self.sine_error),
        ]
    }
}

/// Series of `integral over a step of (1 - e^(-alpha t)) s(dt - t) dt`, s being a mode's impulse response:
/// the effect of half a jump at the beginning of a step beyond that of the same half at its end.
fn jump_series(operators: &LinearOperators, interval: f64, dt: f64, degree: usize) -> Vec<f64> {
    let alpha = operators.damping().mass;
    if alpha == 0.0 {
        return Vec::new();
    }
    let points = quadrature(dt, interval.sqrt() + alpha);
    let values: Vec<f64> = nodes(2 * degree + 48, interval)
        .into_iter()
        .map(|lambda| {
            let mode = Mode {
                lambda,
                damping: alpha,
            };
            let part =
                |(t, weight): &(f64, f64)| weight * -(-alpha * t).exp_m1() * mode.impulse(dt - t).0;
            points.iter().map(part).sum()
        })
        .collect();
    let mut series = vec![0.0; degree + 1];
    interpolate(&values, &mut series);
    series
}

/// The largest error of `w S/2`, `w^2 = lambda - alpha^2/4 > 0`, over the interval.
fn largest_error(s: &[f64], interval: f64, alpha: f64, dt: f64) -> f64 {
    let points = POINTS_PER_DEGREE * (s.len() + 1);
    let errors = (0..=points).map(|point| {
        let angle = std::f64::consts::PI * point as f64 / points as f64;
        let lambda = 0.5 * interval * (1.0 + angle.cos());
        let square = lambda - alpha * alpha / 4.0;
        let error = evaluate(s, lambda, interval) - half_sine(lambda, alpha, dt);
        0.5 * square.max(0.0).sqrt() * error.abs()
    });
    errors.fold(0.0, f64::max)
}

/// The largest `|w S|`, `w^2 = lambda - alpha^2/4 > 0`, over the interval.
fn largest_swing(s: &[f64], interval: f64, alpha: f64) -> f64 {
    let swing = |angle: f64| {
        let lambda = 0.5 * interval * (1.0 + angle.cos());
        let square = lambda - alpha * alpha / 4.0;
        square.max(0.0).sqrt() * evaluate(s, lambda, interval).abs()
    };
    largest_value(swing, POINTS_PER_DEGREE * (s.len() + 1))
}
