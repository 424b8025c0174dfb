//! The propagator in a Krylov space.

use sinew_core::spectrum::Spectrum;
use sinew_core::vectors::weighted_dot;
use sinew_core::{
    BlockMatrix, Fact, LinearOperators, LoadTime, Needs, SetupError, State, Step, StepError,
    StepReport, Stepped,
};

use super::resolution::{HIGHEST_DEGREE, ID, Resolution};
use crate::StepByHand;
use crate::exponential::Exponential;

/// Columns beyond the Hessenberg matrix: e1 and the chain of the phi functions.
const CHAIN: usize = 3;
/// Number of columns by which the space grows between two error estimates.
const EVERY: usize = 3;
/// Length of a rate below which squares underflow and the motion is negligible.
const NOTHING: f64 = 1e-140;
/// Change between two checks of the solution above which the estimate is not trusted: in a space far too small for the
/// step both the solution and its estimate are meaningless.
const STEADY: f64 = 1e-2;
/// Share of a step below which it is not shortened: the space grows instead.
const SHORTEST: f64 = 0.5;

/// `y' = L y + b` for y = (u, v) over a step: `y+ = y + dt phi_1(dt L) w0 + dt^2 phi_2(dt L) w1` with
/// `w0 = L y + b(t)` and w1 the rate of b, each product taken in the Krylov space of its vector by the
/// Arnoldi process (Saad, SIAM J. Numer. Anal. 29, 1992; Sidje, ACM TOMS 24, 1998). The space grows
/// until Saad's estimate of the error, relative to the change over the step, meets the
/// tolerance.
///
/// Inner products weigh velocities by M and displacements by omega_max^2 M, so that both count alike. The energy weighs
/// displacements by K, so that the error may add energy. A step that adds energy is shortened: `y + theta (y+ - y)` has
/// no more energy than y for the theta of [`Krylov::part_without_gain`].
#[derive(Debug)]
pub struct Krylov {
    resolution: Resolution,
    capacity: usize,
    weight: f64,
    /// Diagonal of K (N/m).
    diagonal: Vec<f64>,
    /// Orthonormal vectors of length 2n: displacement part, then velocity part.
    basis: Vec<Vec<f64>>,
    /// Upper Hessenberg, row-major with `capacity` columns.
    hessenberg: Vec<f64>,
    exponential: Exponential,
    start: Vec<f64>,
    change: Vec<f64>,
    load: Vec<f64>,
    /// Coefficients in the basis at the last estimate.
    before: Vec<f64>,
    /// Coefficients of the change in the basis.
    coefficients: Vec<f64>,
    /// Velocity part of L times the change.
    acceleration_change: Vec<f64>,
    /// Velocity in the middle of the change.
    middle: Vec<f64>,
    largest: usize,
    estimate: f64,
}

impl StepByHand for Krylov {
    fn without_program(&self) -> &'static str {
        "in a Krylov space the coefficients of each step are dot products over all cells, known only when it is taken"
    }

    fn step(&mut self, step: &Step<'_>, state: &mut State) -> Result<Stepped, StepError> {
        let linear = step.system.as_linear().ok_or(Needs::Matrices.lacking(ID))?;
        let work = self.advance(linear.operators(), step, state)?;
        Ok(Stepped::at_same_time(work))
    }

    fn facts(&self) -> Vec<Fact> {
        let fact = |name, value| Fact { name, value };
        vec![
            fact("degree", self.largest as f64),
            fact("left_out", self.estimate),
        ]
    }
}

impl Krylov {
    pub(super) fn set_up(
        operators: &LinearOperators,
        dt: f64,
        resolution: Resolution,
    ) -> Result<Self, SetupError> {
        let spectrum = Spectrum::of(operators);
        let damping = spectrum.mass_damping + spectrum.damping_max;
        let half = damping / 2.0;
        let fastest = half + (half * half + spectrum.omega_max.powi(2)).sqrt();
        // A space of about omega dt + 6 is enough; capacity for twice that and for tight tolerances.
        let expected = fastest * dt + 6.0;
        let room = (2.0 * expected + 20.0) as usize;
        let n = operators.dofs();
        let capacity = resolution.degree.unwrap_or(room).min(2 * n).max(1);
        if capacity > HIGHEST_DEGREE {
            return Err(SetupError::Unresolved {
                integrator: ID,
                reason: format!(
                    "a step of {dt} s may need a Krylov space of {room} dimensions, more than {HIGHEST_DEGREE}; take a shorter step"
                ),
            });
        }
        let weight = if spectrum.omega_max > 0.0 {
            spectrum.omega_max.powi(2)
        } else {
            1.0 / (dt * dt)
        };
        Ok(Self {
            resolution,
            capacity,
            weight,
            diagonal: diagonal(operators.stiffness()),
            basis: vec![vec![0.0; 2 * n]; capacity + 1],
            hessenberg: vec![0.0; (capacity + 1) * capacity],
            exponential: Exponential::with_capacity(capacity + CHAIN),
            start: vec![0.0; 2 * n],
            change: vec![0.0; 2 * n],
            load: vec![0.0; n],
            before: vec![0.0; capacity],
            coefficients: vec![0.0; capacity],
            acceleration_change: vec![0.0; n],
            middle: vec![0.0; n],
            largest: 0,
            estimate: 0.0,
        })
    }

    fn advance(
        &mut self,
        operators: &LinearOperators,
        step: &Step<'_>,
        state: &mut State,
    ) -> Result<StepReport, StepError> {
        let dt = step.dt;
        let mass = operators.mass();
        let n = mass.len();
        let t = state.t();
        let mut work = StepReport::ONE_FORCE;
        self.change.fill(0.0);

        // w0 = L y + b: velocity and acceleration.
        let (of_u, of_v) = self.start.split_at_mut(n);
        of_u.copy_from_slice(&state.v);
        let start = LoadTime::smooth_in(t, t, dt).under(step.inputs);
        operators.net_force(start, &state.u, &state.v, of_v);
        divide(of_v, mass);
        work.sweeps += self.add_phi(operators, state, dt, 1)?;

        // w1: the rate of the load.
        let end = LoadTime::smooth_in(t + dt, t, dt).under(step.inputs);
        self.load.fill(0.0);
        let mut changes = false;
        for load in operators.loads_between(step.inputs, t, t + dt) {
            let rate = (load.ramp.factor(end) - load.ramp.factor(start)) / dt;
            if rate != 0.0 {
                changes = true;
                for &(dof, force) in &load.entries {
                    if let Some(load) = self.load.get_mut(dof as usize) {
                        *load += rate * force;
                    }
                }
            }
        }
        if changes {
            let (of_u, of_v) = self.start.split_at_mut(n);
            of_u.fill(0.0);
            of_v.copy_from_slice(&self.load);
            divide(of_v, mass);
            work.sweeps += self.add_phi(operators, state, dt, 2)?;
        }
        let (of_u, of_v) = self.change.split_at(n);
        for (u, change) in state.u.iter_mut().zip(of_u) {
            *u += change;
        }
        for (v, change) in state.v.iter_mut().zip(of_v) {
            *v += change;
        }
        Ok(work)
    }

    /// `change += dt^order phi_order(dt L) start`; returns the sweeps it took. For order 1 the change is
    /// the motion under constant loads, which adds no energy.
    fn add_phi(
        &mut self,
        operators: &LinearOperators,
        state: &State,
        dt: f64,
        order: usize,
    ) -> Result<u64, StepError> {
        let length = self.norm(operators, &self.start);
        if length < NOTHING {
            return Ok(0);
        }
        if !length.is_finite() {
            // A motion that is no number any more is for the caller to see.
            self.change.fill(f64::NAN);
            return Ok(0);
        }
        for (vector, value) in self.basis[0].iter_mut().zip(&self.start) {
            *vector = value / length;
        }
        self.before.fill(0.0);
        let mut sweeps = 0;
        let capacity = self.capacity;
        let fixed = self.resolution.degree.is_some();
        for m in 1..=capacity {
            let next = self.expand(operators, m);
            sweeps += 1;
            let complete = next == 0.0 || m == self.start.len();
            let last = m == capacity;
            let looked_at = if fixed {
                m + EVERY == capacity
            } else {
                m % EVERY == 0
            };
            if !(complete || last || looked_at) {
                continue;
            }
            let scale = dt.powi(order as i32);
            let hessenberg = &self.hessenberg;
            let size = m + CHAIN;
            let functions = self.exponential.of(size, |i, j| {
                if i < m && j < m {
                    dt * hessenberg[i * capacity + j]
                } else if (i == 0 && j == m) || (i >= m && j == i + 1) {
                    1.0
                } else {
                    0.0
                }
            });
            // Column m + k - 1 holds phi_k(dt H) e1.
            let phi = |row: usize, k: usize| functions[row * size + m + k - 1];
            let before = &mut self.before[..m];
            let rows = || (0..m).map(|row| phi(row, order));
            let size_now = rows().map(|now| now * now).sum::<f64>().sqrt();
            let changes = rows()
                .zip(before.iter())
                .map(|(now, before)| (now - before).powi(2));
            let change = changes.sum::<f64>().sqrt() / size_now;
            let estimate = (dt * next * phi(m - 1, order + 1)).abs() / size_now;
            // A space with only one check of it has nothing to compare with.
            let steady = change <= STEADY || capacity <= EVERY;
            let met = complete || (steady && estimate <= self.resolution.tolerance);
            for (row, coefficient) in self.coefficients[..m].iter_mut().enumerate() {
                *coefficient = scale * length * phi(row, order);
            }
            before
                .iter_mut()
                .zip(rows())
                .for_each(|(before, now)| *before = now);
            if !(met || last) {
                continue;
            }
            let inaccurate = |left_out: f64| StepError::Inaccurate {
                integrator: ID,
                t: state.t(),
                reason: format!(
                    "a space of {m} dimensions leaves out {left_out:.1e} of the motion over a step of {dt} s; take a shorter step{}",
                    if fixed { " or a higher degree" } else { "" }
                ),
            };
            if !met {
                return Err(inaccurate(estimate.max(change)));
            }
            self.add_change(m);
            if order == 1 && !complete {
                let theta = self.part_without_gain(operators, state, m, next, &mut sweeps);
                if theta < SHORTEST {
                    if last {
                        return Err(inaccurate(1.0 - theta));
                    }
                    self.change.fill(0.0);
                    continue;
                }
                self.change.iter_mut().for_each(|change| *change *= theta);
            }
            self.largest = self.largest.max(m);
            self.estimate = self.estimate.max(if complete { 0.0 } else { estimate });
            return Ok(sweeps);
        }
        Ok(sweeps)
    }

    fn add_change(&mut self, m: usize) {
        for (factor, vector) in self.coefficients.iter().zip(&self.basis).take(m) {
            for (change, value) in self.change.iter_mut().zip(vector) {
                *change += factor * value;
            }
        }
    }

    /// The factor theta of the change, at most 1, under which it adds no energy under constant loads.
    ///
    /// With `P = v'M v/2 + u'K u/2 - F'u` and a change c, `P(y + theta c) - P(y) = theta p + theta^2 q`, where
    /// `q = dv'M dv/2 + du'K du/2`; for the exact motion `p + q` is minus the dissipation, at most 0. If it is above 0,
    /// theta = -p/q. K du follows from the Arnoldi relation, `-M (L c)_v = K du + D dv`, without a sweep.
    fn part_without_gain(
        &mut self,
        operators: &LinearOperators,
        state: &State,
        m: usize,
        next: f64,
        sweeps: &mut u64,
    ) -> f64 {
        let mass = operators.mass();
        let n = mass.len();
        self.acceleration_change.fill(0.0);
        for row in 0..=m {
            let factor = if row < m {
                let first = row.saturating_sub(1);
                (first..m)
                    .map(|k| self.hessenberg[row * self.capacity + k] * self.coefficients[k])
                    .sum()
            } else {
                next * self.coefficients[m - 1]
            };
            for (sum, value) in self
                .acceleration_change
                .iter_mut()
                .zip(&self.basis[row][n..])
            {
                *sum += factor * value;
            }
        }
        let (du, dv) = self.change.split_at(n);
        let (_, a) = self.start.split_at(n);
        for ((middle, v), dv) in self.middle.iter_mut().zip(&state.v).zip(dv) {
            *middle = v + 0.5 * dv;
        }
        // -D v in the middle, then -D dv.
        let damping = operators.damping();
        let product = u64::from(damping.stiffness != 0.0 || damping.extra.is_some());
        self.load.fill(0.0);
        operators.subtract_damping(&self.middle, &mut self.load);
        *sweeps += product;
        let (mut both, mut square, mut rounding) = (0.0, 0.0, 0.0);
        for i in 0..n {
            let half = 0.5 * self.acceleration_change[i];
            both +=
                mass[i] * (dv[i] * self.middle[i] - du[i] * (a[i] + half)) + du[i] * self.load[i];
            square += mass[i] * (0.5 * dv[i] * dv[i] - du[i] * half);
            // K u and its likes are no better than this.
            let stretched = self.diagonal[i] * (state.u[i].abs() + du[i].abs());
            let moving = mass[i] * (state.v[i].abs() + dv[i].abs());
            rounding += f64::EPSILON * (du[i].abs() * stretched + dv[i].abs() * moving);
        }
        if both <= rounding {
            return 1.0;
        }
        self.load.fill(0.0);
        operators.subtract_damping(dv, &mut self.load);
        *sweeps += product;
        for (du, force) in du.iter().zip(&self.load) {
            square += 0.5 * du * force;
        }
        // No energy in the change itself: no part of it will do.
        if square > 0.0 {
            (1.0 - both / square).max(0.0)
        } else {
            0.0
        }
    }

    /// The m-th column of the Hessenberg matrix and the next basis vector by modified Gram-Schmidt;
    /// returns the entry below the diagonal, 0 if the space is complete.
    fn expand(&mut self, operators: &LinearOperators, m: usize) -> f64 {
        let mass = operators.mass();
        let n = mass.len();
        let (known, new) = self.basis.split_at_mut(m);
        let (current, next) = (&known[m - 1], &mut new[0]);
        let (u, v) = current.split_at(n);
        let (next_u, next_v) = next.split_at_mut(n);
        next_u.copy_from_slice(v);
        next_v.fill(0.0);
        operators.subtract_internal_force(u, v, next_v);
        divide(next_v, mass);
        let before = norm(self.weight, mass, next);
        for row in 0..m {
            self.hessenberg[row * self.capacity + m - 1] = 0.0;
        }
        let mut length = before;
        // Again where much was taken away: what is left must be orthogonal to rounding of its own
        // size (Parlett, The Symmetric Eigenvalue Problem, section 6.9, "twice is enough").
        for _ in 0..2 {
            let taken_from = length;
            for (row, vector) in known.iter().enumerate() {
                let overlap = dot(self.weight, mass, next, vector);
                self.hessenberg[row * self.capacity + m - 1] += overlap;
                for (next, value) in next.iter_mut().zip(vector) {
                    *next -= overlap * value;
                }
            }
            length = norm(self.weight, mass, next);
            if length > 0.7 * taken_from {
                break;
            }
        }
        // What remains is rounding.
        if length <= 1e-13 * before {
            return 0.0;
        }
        if m < self.capacity {
            self.hessenberg[m * self.capacity + m - 1] = length;
        }
        next.iter_mut().for_each(|value| *value /= length);
        length
    }

    fn norm(&self, operators: &LinearOperators, y: &[f64]) -> f64 {
        norm(self.weight, operators.mass(), y)
    }
}

fn diagonal(stiffness: &BlockMatrix) -> Vec<f64> {
    let layers = stiffness.layers().count();
    let entry = |dof: usize| {
        let (cell, layer) = (dof / layers, dof % layers);
        let block = stiffness.block(cell, cell);
        block.map_or(0.0, |block| block[layer * (layers + 1)])
    };
    (0..stiffness.dofs()).map(entry).collect()
}

fn divide(values: &mut [f64], mass: &[f64]) {
    for (value, mass) in values.iter_mut().zip(mass) {
        *value /= mass;
    }
}

fn dot(weight: f64, mass: &[f64], a: &[f64], b: &[f64]) -> f64 {
    let ((a_u, a_v), (b_u, b_v)) = (a.split_at(mass.len()), b.split_at(mass.len()));
    weight * weighted_dot(mass, a_u, b_u) + weighted_dot(mass, a_v, b_v)
}

fn norm(weight: f64, mass: &[f64], y: &[f64]) -> f64 {
    dot(weight, mass, y, y).sqrt()
}
