//! The propagator by Chebyshev polynomials.

use sinew_core::spectrum::Spectrum;
use sinew_core::{
    Fact, LinearOperators, LoadOverStep, LoadTime, Ramp, SetupError, State, StepError, StepReport,
};

use super::cut::{Cut, Motion};
use super::mode::{Mode, quadrature};
use super::series::{interpolate, nodes};
use super::vectors::ChebyshevVectors;
use super::{HIGHEST_DEGREE, ID, Resolution, refuse_loads};

/// By how much the largest eigenvalue, which Lanczos finds from below, is raised.
pub(super) const LARGEST_EIGENVALUE_MARGIN: f64 = 1e-3;
/// Largest growth of a Chebyshev vector that rounding can explain. Outside the interval they grow
/// like powers, so a wrong interval shows at once.
const GROWTH: f64 = 1.05;

/// The exact motion of a proportionally damped linear system over a step, its functions of
/// `M^-1 K` expanded in Chebyshev polynomials (Tal-Ezer, Kosloff and Koren, Geophysical Prospecting
/// 35, 1987; Moler and Van Loan, SIAM Review 45, 2003).
///
/// With r = M^-1 (F(t) - K u), `u+ = u + s v + g r` and `v+ = s' v + s r`, where s is a mode's impulse
/// response and g its integral; what the loads change within the step is integrated too, for any
/// ramp, as long as its kinks and jumps fall on steps. Two sweeps per degree and one for r; one more
/// per degree for each load that changes. The polynomials are cut so that under constant loads no step
/// takes the state farther from its equilibrium, in the energy norm, than it was ([`super::cut`]). The
/// degree, about omega_max dt/2 + 5, is the smallest at which the error of a step meets the tolerance.
#[derive(Debug)]
pub(super) struct Chebyshev {
    series: Series,
    r: Vec<f64>,
    vectors: ChebyshevVectors,
    sum_u: Vec<f64>,
    sum_v: Vec<f64>,
}

/// Coefficients for a system and a step.
#[derive(Clone, Debug)]
struct Series {
    interval: f64,
    cut: Cut,
    /// Times of the quadrature over a step (s).
    times: Vec<f64>,
    /// For each node the weighted impulse response and its rate at each of these times.
    kernels: Vec<Vec<(f64, f64)>>,
    values: Vec<(f64, f64)>,
    of_load: Vec<f64>,
    of_load_rate: Vec<f64>,
}

impl Series {
    fn new(
        operators: &LinearOperators,
        dt: f64,
        resolution: Resolution,
    ) -> Result<Self, SetupError> {
        let spectrum = Spectrum::of(operators);
        let interval = spectrum.omega_max.powi(2) * (1.0 + LARGEST_EIGENVALUE_MARGIN);
        let (alpha, beta) = (spectrum.mass_damping, spectrum.stiffness_damping);
        let fastest = spectrum.omega_max + alpha + beta * interval;
        // Enough for coefficients that fall from degree omega dt/2 on; a strongly damped mode falls
        // later.
        let reach = fastest * dt;
        let count = (48.0 + 1.5 * reach).min(4.0 * HIGHEST_DEGREE as f64) as usize;
        let points = quadrature(dt, fastest);
        let modes: Vec<Mode> = nodes(count, interval)
            .into_iter()
            .map(|lambda| Mode {
                lambda,
                damping: alpha + beta * lambda,
            })
            .collect();
        let kernels: Vec<Vec<(f64, f64)>> = modes
            .iter()
            .map(|mode| {
                let weighted = |(t, weight): &(f64, f64)| {
                    let (s, rate) = mode.impulse(dt - t);
                    (weight * s, weight * rate)
                };
                points.iter().map(weighted).collect()
            })
            .collect();
        let coefficients = |values: Vec<f64>| {
            let mut coefficients = vec![0.0; count];
            interpolate(&values, &mut coefficients);
            coefficients
        };
        let s = modes.iter().map(|mode| mode.impulse(dt).0);
        let s_rate = modes.iter().map(|mode| mode.impulse(dt).1);
        let g = kernels
            .iter()
            .map(|kernel| kernel.iter().map(|(s, _)| s).sum());
        let motion = Motion {
            interval,
            dt,
            damping: (alpha, beta),
            s: coefficients(s.collect()),
            s_rate: coefficients(s_rate.collect()),
            g: coefficients(g.collect()),
        };
        let cut = motion.cut(resolution)?;
        let terms = cut.degree() + 1;
        Ok(Self {
            interval,
            cut,
            times: points.into_iter().map(|(t, _)| t).collect(),
            kernels,
            values: vec![(0.0, 0.0); count],
            of_load: vec![0.0; terms],
            of_load_rate: vec![0.0; terms],
        })
    }

    /// Coefficients of what a ramp's change since `t` brings by t + dt.
    fn follow(&mut self, ramp: &Ramp, t: f64, dt: f64) {
        let ramp_at = |time: f64| ramp.value_within(t, t + dt, time);
        let start = ramp_at(t);
        for (value, kernel) in self.values.iter_mut().zip(&self.kernels) {
            *value = (0.0, 0.0);
            for (time, (s, rate)) in self.times.iter().zip(kernel) {
                let change = ramp_at(t + time) - start;
                value.0 += s * change;
                value.1 += rate * change;
            }
        }
        let count = self.values.len() as f64;
        for k in 0..self.of_load.len() {
            let (mut u, mut v) = (0.0, 0.0);
            for (j, value) in self.values.iter().enumerate() {
                let angle = std::f64::consts::PI * k as f64 * (j as f64 + 0.5) / count;
                u += value.0 * angle.cos();
                v += value.1 * angle.cos();
            }
            let weight = if k == 0 { 1.0 } else { 2.0 } / count;
            self.of_load[k] = weight * u;
            self.of_load_rate[k] = weight * v;
        }
    }
}

impl Chebyshev {
    /// Adds the two series of the vector that `vectors` were started with to the sums: `sum_u += a(M^-1 K) x` and
    /// `sum_v += b(M^-1 K) x`.
    fn add_series(
        &mut self,
        operators: &LinearOperators,
        pick: fn(&Series) -> (&[f64], &[f64]),
    ) -> Result<u64, Growth> {
        let mass = operators.mass();
        let degree = self.series.cut.degree();
        let start = m_norm(mass, self.vectors.current());
        for k in 0..=degree {
            let (of_u, of_v) = pick(&self.series);
            let (a, b) = (of_u[k], of_v[k]);
            for (i, x) in self.vectors.current().iter().enumerate() {
                self.sum_u[i] += a * x;
                self.sum_v[i] += b * x;
            }
            if k < degree {
                self.vectors.advance(operators);
            }
        }
        let end = m_norm(mass, self.vectors.current());
        // False for NaN too.
        if end <= GROWTH * start {
            Ok(degree as u64)
        } else {
            Err(Growth(end / start))
        }
    }
}

/// By how much a vector grew that must not.
struct Growth(f64);

fn m_norm(mass: &[f64], x: &[f64]) -> f64 {
    let squares = mass.iter().zip(x).map(|(mass, x)| mass * x * x);
    squares.sum::<f64>().sqrt()
}

impl Chebyshev {
    /// Chooses the degree and makes the coefficients.
    pub(super) fn set_up(
        operators: &LinearOperators,
        dt: f64,
        resolution: Resolution,
    ) -> Result<Self, SetupError> {
        if operators.damping().extra.is_some() {
            return Err(SetupError::Lacks {
                integrator: ID,
                needs: "proportional damping (D = alpha M + beta K, no dashpots); kind = \"krylov\" takes any",
            });
        }
        let series = Series::new(operators, dt, resolution)?;
        let buffer = || vec![0.0; operators.dofs()];
        Ok(Self {
            vectors: ChebyshevVectors::new(operators.dofs(), series.interval),
            series,
            r: buffer(),
            sum_u: buffer(),
            sum_v: buffer(),
        })
    }

    /// Moves u and v over a step.
    pub(super) fn step(
        &mut self,
        operators: &LinearOperators,
        state: &mut State,
        dt: f64,
    ) -> Result<StepReport, StepError> {
        let mut work = StepReport::default();
        let t = state.t();
        let remedy = "choose a dt that meets that instant";
        refuse_loads(operators.loads(), LoadOverStep::Smooth, t, dt, remedy)?;
        operators.external_force(LoadTime::smooth_in(t, t, dt), &mut self.r);
        operators
            .stiffness()
            .subtract_product(&state.u, &mut self.r);
        for (r, mass) in self.r.iter_mut().zip(operators.mass()) {
            *r /= mass;
        }
        work.sweeps += 1;
        work.force_evaluations += 1;
        self.sum_u.copy_from_slice(&state.u);
        self.sum_v.fill(0.0);

        let grown = |Growth(factor): Growth| StepError::Inaccurate {
            integrator: ID,
            t,
            reason: format!(
                "the series grew {factor:.2} times where it must not: the largest eigenvalue was underestimated"
            ),
        };
        self.vectors.start().copy_from_slice(&state.v);
        work.sweeps += self
            .add_series(operators, |series| (&series.cut.s, &series.cut.s_rate))
            .map_err(grown)?;
        self.vectors.start().copy_from_slice(&self.r);
        work.sweeps += self
            .add_series(operators, |series| (&series.cut.g, &series.cut.s))
            .map_err(grown)?;
        for load in operators.loads() {
            if load.ramp.is_constant_between(t, t + dt) {
                continue;
            }
            self.series.follow(&load.ramp, t, dt);
            let of_load = self.vectors.start();
            of_load.fill(0.0);
            for &(dof, force) in &load.entries {
                of_load[dof as usize] += force / operators.mass()[dof as usize];
            }
            work.sweeps += self
                .add_series(operators, |series| (&series.of_load, &series.of_load_rate))
                .map_err(grown)?;
        }
        state.u.copy_from_slice(&self.sum_u);
        state.v.copy_from_slice(&self.sum_v);
        Ok(work)
    }

    pub(super) fn facts(&self) -> Vec<Fact> {
        let fact = |name, value| Fact { name, value };
        vec![
            fact("degree", self.series.cut.degree() as f64),
            fact("step_error", self.series.cut.error),
            fact("relaxation", self.series.cut.relaxation),
        ]
    }
}
