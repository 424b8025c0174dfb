//! The propagator in two-step form.

use sinew_core::spectrum::Spectrum;
use sinew_core::{
    Acceleration, Fact, LinearOperators, Load, LoadOverStep, LoadTime, SetupError, State,
    StepError, StepReport, VelocityTime,
};

use super::chebyshev::LARGEST_EIGENVALUE_MARGIN;
use super::first_step::FirstStep;
use super::mode::{Mode, quadrature};
use super::series::{evaluate, interpolate, nodes, tails};
use super::vectors::ChebyshevVectors;
use super::{HIGHEST_DEGREE, ID, Resolution, refuse_loads};

/// Points per degree among which the largest value of a polynomial is looked for.
const POINTS_PER_DEGREE: usize = 32;

/// Share of the largest value that a peak has at one of these points: cos(pi/64), rounded down.
const SEEN_OF_A_PEAK: f64 = 0.99;

/// Least by which sin(w dt/2) is kept below 1: rounding of it.
const LEAST_ROOM: f64 = 1e-13;

/// Most by which sin(w dt/2) is kept below 1.
const MOST_ROOM: f64 = 0.25;

/// The exact displacements of a mass-damped linear system under piecewise constant loads, for half
/// the sweeps of the one-step form: `v+ = e^(-2 eta) v- + G(M^-1 K) M^-1 (F - K u)/dt`, `u+ = u + dt v+`, v being
/// the mean velocity over a step. This is what any mode `q'' + alpha q' + lambda q = r` does from one
/// step to the next (Gautschi, Numer. Math. 3, 1961; Hochbruck and Lubich, Numer. Math. 83, 1999,
/// without damping), with `lambda G = (1 - e^-eta)^2 + 4 e^-eta sin^2(w dt/2)`, `w^2 = lambda - alpha^2/4` and
/// `eta = alpha dt/2`.
///
/// Only `S = sin(w dt/2)/(w/2)` is replaced by a polynomial. With its square in G,
/// `lambda G = (1 - e^-eta)^2 + e^-eta w^2 S^2` cannot fall below 0; S is scaled, by less than 5/4 of the
/// tolerance, so that `|w S|` stays a little below 2 between its zeros too, since a mode at 2 itself grows
/// as the number of steps; and eta is taken from `sinh(eta/2) = alpha S(0)/4`, by which lambda divides G
/// whatever S is. Every mode is then stable at any step and for any tolerance, which a polynomial for G
/// itself is not.
///
/// The tolerance bounds the error of `sin(w dt/2) = w S/2` before S is scaled; after it, the error delta is
/// at most 5/2 of the tolerance. An undamped mode then turns by `2 asin` of the wrong sine: its phase is off
/// by about `2 delta/cos(w dt/2)` a step, by up to `2 sqrt(2 delta)` where the sine is near 1. From exact
/// displacements a step leads to one that is off by at most 8 delta of the distance from equilibrium,
/// as `w^2 S^2 <= 4` there.
#[derive(Debug)]
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
    decay: f64,
    /// Series of what a jump of the load adds, for half the jump; empty without damping.
    of_jump: Vec<f64>,
    first_step: FirstStep,
    r: Vec<f64>,
    sum: Vec<f64>,
    other_sum: Vec<f64>,
    vectors: ChebyshevVectors,
}

/// S of one mode.
fn half_sine(lambda: f64, alpha: f64, dt: f64) -> f64 {
    // An undamped mode of lambda - alpha^2/4 from 0 with velocity 1 over half a step is sin(w dt/2)/w.
    let mode = Mode {
        lambda: lambda - alpha * alpha / 4.0,
        damping: 0.0,
    };
    2.0 * mode.impulse(dt / 2.0).0
}

impl TwoStep {
    /// Chooses the degree and makes the coefficients.
    pub(super) fn set_up(
        operators: &LinearOperators,
        dt: f64,
        resolution: Resolution,
    ) -> Result<Self, SetupError> {
        let damping = operators.damping();
        if damping.extra.is_some() || damping.stiffness != 0.0 {
            return Err(SetupError::Lacks {
                integrator: ID,
                needs: "mass damping at most for kind = \"two-step\"; \"chebyshev\" takes \
                        proportional damping, \"krylov\" any",
            });
        }
        let alpha = damping.mass;
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
        // The first step is off by left_out, and a mode this near to 1 turns that into amplitude by the
        // root of the room.
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
        let buffer = || vec![0.0; operators.dofs()];
        let root_of_decay = (-2.0 * (alpha * s_at_zero / 4.0).asinh()).exp();
        Ok(Self {
            degree,
            left_out: left_out[degree],
            sine_error,
            s_at_zero,
            alpha,
            decay: root_of_decay * root_of_decay,
            first_step: FirstStep::new(&s, interval, alpha, dt, root_of_decay),
            of_jump: jump_series(operators, interval, dt, 2 * degree),
            s,
            divided,
            r: buffer(),
            sum: buffer(),
            other_sum: buffer(),
            vectors: ChebyshevVectors::new(operators.dofs(), interval),
        })
    }

    /// Moves u and v over a step, times included.
    pub(super) fn step(
        &mut self,
        operators: &LinearOperators,
        state: &mut State,
        dt: f64,
    ) -> Result<StepReport, StepError> {
        let running = state.is_staggered_by(dt);
        let refuse = |from: f64| {
            let remedy =
                "choose a dt that meets the instants at which loads jump, or kind = \"chebyshev\"";
            refuse_loads(operators.loads(), LoadOverStep::Constant, from, dt, remedy)
        };
        refuse(state.t())?;
        if running {
            refuse(state.t() - dt)?;
        }
        state.a.resize(state.u.len(), 0.0);
        let work = if running {
            self.go_on(operators, state, dt)
        } else {
            self.start(operators, state, dt)
        };
        state.end_step(dt, VelocityTime::MiddleOfStep, Acceleration::Kick);
        Ok(work)
    }

    /// The first step, from a velocity that holds at the displacement's time.
    fn start(&mut self, operators: &LinearOperators, state: &mut State, dt: f64) -> StepReport {
        let load = LoadTime::smooth_in(state.t(), state.t(), dt);
        operators.external_force(load, &mut self.r);
        operators
            .stiffness()
            .subtract_product(&state.u, &mut self.r);
        for (r, mass) in self.r.iter_mut().zip(operators.mass()) {
            *r /= mass;
        }
        let mut work = StepReport::ONE_FORCE;
        self.sum.fill(0.0);
        self.vectors.start().copy_from_slice(&state.v);
        work.sweeps += self.add_series(operators, Which::FirstOfVelocity);
        self.vectors.start().copy_from_slice(&self.r);
        work.sweeps += self.add_series(operators, Which::FirstOfForce);
        for (i, u) in state.u.iter_mut().enumerate() {
            let v = self.sum[i] / dt;
            state.a[i] = 2.0 * (v - state.v[i]) / dt;
            state.v[i] = v;
            *u += dt * v;
        }
        work
    }

    fn go_on(&mut self, operators: &LinearOperators, state: &mut State, dt: f64) -> StepReport {
        let mass = operators.mass();
        // The mean of both loads where they jump at this instant.
        self.r.fill(0.0);
        let mut jumps = false;
        for Load { ramp, entries } in operators.loads() {
            let [before, after] = [-0.5, 0.5].map(|part| ramp.value(state.t() + part * dt));
            jumps |= before != after;
            for &(dof, force) in entries {
                self.r[dof as usize] += 0.5 * (before + after) * force;
            }
        }
        operators
            .stiffness()
            .subtract_product(&state.u, &mut self.r);
        for (r, mass) in self.r.iter_mut().zip(mass) {
            *r /= mass;
        }
        let mut work = StepReport::ONE_FORCE;

        // y = S r - alpha^2/4 (S - S0)/lambda r, then G r = e^-eta (S y - alpha^2/4 S0 (S - S0)/lambda r).
        let quarter = self.alpha * self.alpha / 4.0;
        self.vectors.start().copy_from_slice(&self.r);
        self.sum.fill(0.0);
        self.other_sum.fill(0.0);
        work.sweeps += self.add_series(operators, Which::Both);
        let y = self.vectors.start();
        for ((y, sum), divided) in y.iter_mut().zip(&mut self.sum).zip(&self.other_sum) {
            *y = *sum - quarter * divided;
            *sum = -quarter * self.s_at_zero * divided;
        }
        work.sweeps += self.add_series(operators, Which::S);
        let root = self.decay.sqrt();
        self.sum.iter_mut().for_each(|sum| *sum *= root);

        if jumps && !self.of_jump.is_empty() {
            let jump = self.vectors.start();
            jump.fill(0.0);
            for Load { ramp, entries } in operators.loads() {
                let [before, after] = [-0.5, 0.5].map(|part| ramp.value(state.t() + part * dt));
                for &(dof, force) in entries {
                    let dof = dof as usize;
                    jump[dof] += 0.5 * (after - before) * force / mass[dof];
                }
            }
            work.sweeps += self.add_series(operators, Which::Jump);
        }
        for (i, u) in state.u.iter_mut().enumerate() {
            let v = self.decay * state.v[i] + self.sum[i] / dt;
            state.a[i] = (v - state.v[i]) / dt;
            state.v[i] = v;
            *u += dt * v;
        }
        work
    }

    /// Adds series of the vector that `vectors` were started with to the sums.
    fn add_series(&mut self, operators: &LinearOperators, which: Which) -> u64 {
        let series = match which {
            Which::Both | Which::S => &self.s,
            Which::Jump => &self.of_jump,
            Which::FirstOfVelocity => &self.first_step.of_velocity,
            Which::FirstOfForce => &self.first_step.of_force,
        };
        for (k, coefficient) in series.iter().enumerate() {
            if k > 0 {
                self.vectors.advance(operators);
            }
            for (sum, x) in self.sum.iter_mut().zip(self.vectors.current()) {
                *sum += coefficient * x;
            }
            if which == Which::Both {
                for (sum, x) in self.other_sum.iter_mut().zip(self.vectors.current()) {
                    *sum += self.divided[k] * x;
                }
            }
        }
        series.len() as u64 - 1
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

/// Which series are added.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Which {
    /// S to the one sum, its divided difference to the other.
    Both,
    S,
    Jump,
    FirstOfVelocity,
    FirstOfForce,
}

/// Series of `integral over a step of (1 - e^(-alpha t)) s(dt - t) dt`, s being a mode's impulse response:
/// by how much half a jump at the beginning of a step does more than the same half at its end.
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
    let points = POINTS_PER_DEGREE * (s.len() + 1);
    let width = std::f64::consts::PI / points as f64;
    let seen: Vec<f64> = (0..=points)
        .map(|point| swing(point as f64 * width))
        .collect();
    let largest = seen.iter().copied().fold(0.0, f64::max);
    // Peaks of nearly the same height: the highest of them may be seen less well than another.
    let near = (0..=points).filter(|point| seen[*point] >= SEEN_OF_A_PEAK * largest);
    let peaks = near.map(|point| peak_about(&swing, point as f64 * width, width));
    // Rounding of a value.
    peaks.fold(largest, f64::max) * (1.0 + 1e-14)
}

/// The largest value of a function within `width` of a point, by golden section.
fn peak_about(function: &impl Fn(f64) -> f64, centre: f64, width: f64) -> f64 {
    let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
    let (mut low, mut high) = (centre - width, centre + width);
    // Where a maximum is found to the square root of rounding, its value is to rounding.
    for _ in 0..40 {
        let (left, right) = (high - golden * (high - low), low + golden * (high - low));
        if function(left) >= function(right) {
            high = right;
        } else {
            low = left;
        }
    }
    function(0.5 * (low + high))
}
