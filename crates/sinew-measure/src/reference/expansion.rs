//! The motion of a linear system by Faber series of its exponential.

use std::f64::consts::PI;

use sinew_core::spectrum::Spectrum;
use sinew_core::vectors::add_scaled;
use sinew_core::{Clock, LinearOperators, State};

use super::faber::Ellipse;
use super::fastest_turn;

/// Number of relevant derivatives of a load's factor: the phase of a factor changes by at most pi in a step, and
/// pi^32/32! is 3e-20.
const DERIVATIVES: usize = 32;

/// Share by which the ellipse is larger than the spectrum, whose ends are approached from inside.
const MARGIN: f64 = 0.01;

/// Largest capacity times step. A longer step needs fewer products per second, but more observations.
const REACH: f64 = 32.0;

/// Minimum number of steps of a run, so that a check has some to choose from; steps are not shortened below the least
/// reach for this.
const STEPS: f64 = 5.0;
const LEAST_REACH: f64 = 10.0;

/// Largest capacity times the time between two observations of the motion.
const GAP: f64 = 4.0;

/// Largest number of observations of the motion in a step, its end included.
const LOOKS: usize = 16;

/// Numbers that are updated together, small enough for a cache.
const CHUNK: usize = 2048;

/// Steps a linear system by the Faber series of `exp(t A)`, A being the matrix of its equation of order 1 (Novati,
/// Numerical Linear Algebra with Applications 10, 2003), with loads as additional variables whose derivatives are one
/// another (as in Al-Mohy and Higham, SIAM Journal on Scientific Computing 33, 2011).
///
/// In the norm of energy the numerical range of A lies within `-damping..0` by `-omega..omega`, for any damping. The
/// state at any instant of a step is a sum of the same vectors.
#[derive(Debug)]
pub(crate) struct Expansion<'a> {
    operators: &'a LinearOperators,
    ellipse: Ellipse,
    /// The longest step (s) it takes.
    longest_step: f64,
    breakpoints: Vec<f64>,
    /// Derivatives of each load's factor, times powers of the step, under the last two polynomials.
    factors: [Vec<[f64; DERIVATIVES]>; 2],
    /// Displacements and velocities under the last two polynomials.
    now: State,
    before: State,
    force: Vec<f64>,
    /// The state at each observation.
    looks: Vec<State>,
    /// Products with the matrices so far.
    pub(crate) sweeps: u64,
}

impl<'a> Expansion<'a> {
    /// The series for these matrices and a run of some duration (s).
    pub(crate) fn new(operators: &'a LinearOperators, spectrum: &Spectrum, duration: f64) -> Self {
        let damping = spectrum.mass_damping + spectrum.damping_max;
        let factors = vec![[0.0; DERIVATIVES]; operators.loads().len()];
        let at_rest = State::at_rest(operators.dofs());
        let breakpoints = operators.loads().iter();
        let mut breakpoints: Vec<f64> = breakpoints
            .flat_map(|load| load.ramp.breakpoints())
            .collect();
        breakpoints.sort_by(f64::total_cmp);
        let raised = |rate: f64| (1.0 + MARGIN) * rate;
        // A load's factor is a motion of the system too, and may be the fastest.
        let fastest = spectrum.omega_max.max(fastest_turn(operators));
        // Where nothing turns or decays, any ellipse will do.
        let omega = match fastest + damping > 0.0 {
            true => raised(fastest),
            false => 1.0,
        };
        let ellipse = Ellipse::round(omega, raised(damping));
        let reach = (ellipse.capacity * duration / STEPS).clamp(LEAST_REACH, REACH);
        Self {
            operators,
            ellipse,
            longest_step: (reach / ellipse.capacity).min(PI / fastest_turn(operators)),
            breakpoints,
            factors: [factors.clone(), factors],
            now: at_rest.clone(),
            before: at_rest.clone(),
            force: vec![0.0; operators.dofs()],
            looks: Vec::new(),
            sweeps: 0,
        }
    }

    /// The longest step (s) it takes.
    pub(crate) fn longest_step(&self) -> f64 {
        self.longest_step
    }

    /// Takes a step from `state`, whose velocity must be at the displacement's time, towards the last of `times` (s),
    /// increasing and all later; returns the number of times that it has reached. `look` receives the motion at these
    /// times, with its second argument true, and at instants between them.
    pub(crate) fn step(
        &mut self,
        state: &mut State,
        times: &[f64],
        mut look: impl FnMut(&State, bool),
    ) -> usize {
        let instants = self.instants(state.t(), times);
        self.expand(state, &instants);
        let mut reached = 0;
        for seen in &self.looks[..instants.len()] {
            let is_asked_for = times.get(reached) == Some(&seen.t());
            reached += usize::from(is_asked_for);
            look(seen, is_asked_for);
            state.clone_from(seen);
        }
        reached
    }

    /// The instants (s) at which a step from `start` observes the motion.
    fn instants(&self, start: f64, times: &[f64]) -> Vec<f64> {
        let passed = self.breakpoints.partition_point(|time| *time <= start);
        let stop = self.breakpoints.get(passed).copied();
        let stop = stop.unwrap_or(f64::INFINITY);
        let gap = (GAP / self.ellipse.capacity).min(self.longest_step);
        let farthest = start + self.longest_step * (1.0 + 1e-9);
        let mut instants = Vec::with_capacity(LOOKS);
        let mut last = start;
        for &time in times {
            let target = time.min(stop);
            let parts = ((target - last) / gap).ceil().max(1.0);
            let from = last;
            for part in 1..=parts as usize {
                // The target itself, not a sum that may miss it by rounding.
                let instant = match part as f64 == parts {
                    true => target,
                    false => from + (target - from) * part as f64 / parts,
                };
                if instants.len() == LOOKS || instant > farthest {
                    return instants;
                }
                instants.push(instant);
                last = instant;
            }
            if target == stop {
                break;
            }
        }
        instants
    }

    /// Sums the series for each instant (s) into `looks`.
    fn expand(&mut self, state: &State, instants: &[f64]) {
        let start = state.t();
        let series: Vec<Vec<f64>> = instants
            .iter()
            .map(|instant| self.ellipse.exponential(instant - start))
            .collect();
        let terms = series.iter().map(Vec::len).max().unwrap_or(0);
        let whole = instants.last().map_or(0.0, |end| end - start);
        let [factors, factors_before] = &mut self.factors;
        for (load, factors) in self.operators.loads().iter().zip(&mut *factors) {
            load.ramp.derivatives_after(start, factors);
            let mut power = 1.0;
            for factor in factors {
                *factor *= power;
                power *= whole;
            }
        }
        factors_before.iter_mut().for_each(|of| of.fill(0.0));
        self.now.u.copy_from_slice(&state.u);
        self.now.v.copy_from_slice(&state.v);
        self.before.u.fill(0.0);
        self.before.v.fill(0.0);
        self.looks
            .resize_with(instants.len().max(self.looks.len()), || {
                State::at_rest(state.u.len())
            });
        for (seen, instant) in self.looks.iter_mut().zip(instants) {
            seen.u.fill(0.0);
            seen.v.fill(0.0);
            seen.clock = Clock::at(*instant);
        }
        for n in 0..terms {
            let shares: Vec<(usize, f64)> = series
                .iter()
                .enumerate()
                .filter_map(|(at, series)| Some((at, *series.get(n)?)))
                .collect();
            let is_last = n + 1 == terms;
            if !is_last {
                self.net_force();
            }
            self.advance(n, &shares, is_last, whole);
        }
    }

    /// `force = f F - K u - D v` of the current polynomial.
    fn net_force(&mut self) {
        self.force.fill(0.0);
        for (load, factors) in self.operators.loads().iter().zip(&self.factors[0]) {
            if factors[0] != 0.0 {
                for &(dof, force) in &load.entries {
                    self.force[dof as usize] += factors[0] * force;
                }
            }
        }
        self.operators
            .subtract_internal_force(&self.now.u, &self.now.v, &mut self.force);
        self.sweeps += 1;
    }

    /// Adds a term to the observed states and computes the next one.
    fn advance(&mut self, n: usize, shares: &[(usize, f64)], is_last: bool, whole: f64) {
        let (first, second) = self.ellipse.recurrence(n);
        let shift = -self.ellipse.centre;
        let mass = self.operators.mass();
        let dofs = mass.len();
        for begin in (0..dofs).step_by(CHUNK) {
            let part = begin..(begin + CHUNK).min(dofs);
            for &(at, share) in shares {
                let seen = &mut self.looks[at];
                add_scaled(share, &self.now.u[part.clone()], &mut seen.u[part.clone()]);
                add_scaled(share, &self.now.v[part.clone()], &mut seen.v[part.clone()]);
            }
            if is_last {
                continue;
            }
            for i in part {
                let (u, v) = (self.now.u[i], self.now.v[i]);
                let a = self.force[i] / mass[i];
                self.before.u[i] = first * (v + shift * u) - second * self.before.u[i];
                self.before.v[i] = first * (a + shift * v) - second * self.before.v[i];
            }
        }
        std::mem::swap(&mut self.now, &mut self.before);
        let [now, before] = &mut self.factors;
        for (now, before) in now.iter().zip(&mut *before) {
            for order in 0..DERIVATIVES {
                let next = now.get(order + 1).map_or(0.0, |next| next / whole);
                before[order] = first * (next + shift * now[order]) - second * before[order];
            }
        }
        self.factors.swap(0, 1);
    }
}
