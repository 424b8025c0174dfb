//! The propagator by Chebyshev polynomials.

use std::f64::consts::PI;
use std::sync::Arc;

use sinew_cnn::{LoadAt, Loads, Moments, Program, Register, Sweep, Term, Update, Weight, When};
use sinew_core::closed_form::Mode;
use sinew_core::spectrum::Spectrum;
use sinew_core::{Fact, LinearOperators, Ramp, SetupError, VelocityTime};

use super::cut::{Cut, Motion};
use super::quadrature::quadrature;
use super::resolution::{HIGHEST_DEGREE, ID, Resolution};
use super::series::{interpolate, nodes};
use super::sweeps::ChebyshevVectors;

/// Margin added to the largest eigenvalue, which Lanczos approaches from below.
pub(super) const LARGEST_EIGENVALUE_MARGIN: f64 = 1e-3;

/// The exact motion of a proportionally damped linear system over a step, its functions of
/// `M^-1 K` expanded in Chebyshev polynomials (Tal-Ezer, Kosloff and Koren, Geophysical Prospecting
/// 35, 1987; Moler and Van Loan, SIAM Review 45, 2003).
///
/// With r = M^-1 (F(t) - K u), `u+ = u + s v + g r` and `v+ = s' v + s r`, where s is a mode's impulse response and g
/// its integral; the change of the loads within the step is integrated too, for any ramp, as long as its kinks and
/// jumps fall on steps. Two sweeps per degree and one for r; one more per degree for each load that changes. The
/// polynomials are truncated so that under constant loads no step moves the state farther from its equilibrium in the
/// energy norm (`cut.rs`). The degree, about omega_max dt/2 + 5, is the smallest at which the error of a step meets the
/// tolerance.
#[derive(Clone, Debug)]
pub(super) struct Chebyshev {
    interval: f64,
    cut: Cut,
    /// Times of the quadrature over a step (s).
    times: Vec<f64>,
    /// Weighted impulse response and its rate at each of these times, for each node.
    kernels: Vec<Vec<(f64, f64)>>,
}

impl Chebyshev {
    /// Chooses the degree and computes the coefficients.
    pub(super) fn new(
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
        let spectrum = Spectrum::of(operators);
        let interval = spectrum.omega_max.powi(2) * (1.0 + LARGEST_EIGENVALUE_MARGIN);
        let (alpha, beta) = (spectrum.mass_damping, spectrum.stiffness_damping);
        let fastest = spectrum.omega_max + alpha + beta * interval;
        // Enough for coefficients that fall from degree omega dt/2 on; a strongly damped mode falls
        // later.
        let reach = fastest * dt;
        let count = (48.0 + 1.5 * reach).min(4.0 * HIGHEST_DEGREE as f64) as usize;
        let swings = operators.loads().iter();
        let swings = swings.filter_map(|load| load.ramp.angular_frequency());
        let points = quadrature(dt, swings.fold(fastest, f64::max));
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
        Ok(Self {
            interval,
            cut: motion.cut(resolution)?,
            times: points.into_iter().map(|(t, _)| t).collect(),
            kernels,
        })
    }

    /// The step as a program; `ramps` are those of the loads, by their numbers.
    pub(super) fn program<'a>(&self, ramps: impl Iterator<Item = &'a Ramp>) -> Program {
        let (u, v) = (Register::U, Register::V);
        let mut program = Program::new(VelocityTime::Same);
        let [r, sum_u, sum_v] = ["r", "sum_u", "sum_v"].map(|name| program.register(name));
        let room = ["c", "d"].map(|name| program.register(name));
        let vectors = ChebyshevVectors {
            interval: self.interval,
            room,
        };
        let Cut { s, s_rate, g, .. } = &self.cut;
        let terms = self.cut.degree() + 1;
        let first = Sweep::of_stiffness(1.0, u, Loads::at(LoadAt::Smooth)).then(r.becomes_q());
        let first = first.then(sum_u.becomes([(u, 1.0), (v, s[0]), (r, g[0])]));
        let first = first.then(sum_v.becomes([(v, s_rate[0]), (r, s[0])]));
        program.step.push(first);
        for (start, of_u, of_v) in [(v, s, s_rate), (r, g, s)] {
            let add = |k: usize, x| vec![sum_u.plus(of_u[k], x), sum_v.plus(of_v[k], x)];
            let sweeps = vectors.sweeps(start, terms, When::Always, add);
            program.step.extend(sweeps);
        }
        let changing = ramps.enumerate().filter(|(_, ramp)| may_change(ramp));
        for (load, _) in changing {
            let load = load as u32;
            let when = When::LoadChanges(load);
            let start = program.named("f");
            let add = |k: usize, x| {
                let moment = 2 * k as u32;
                vec![
                    plus_moment(sum_u, x, load, moment),
                    plus_moment(sum_v, x, load, moment + 1),
                ]
            };
            let mut of_load = Sweep::of_stiffness(0.0, u, Loads::One(load)).without_neighbours();
            of_load = of_load.when(when).then(start.becomes_q());
            of_load.updates.extend(add(0, start));
            program.step.push(of_load);
            program.step.extend(vectors.sweeps(start, terms, when, add));
            program
                .moments
                .get_or_insert_with(|| Arc::new(self.moments(terms)));
        }
        let last = Sweep::local().then(u.becomes([(sum_u, 1.0)]));
        program.step.push(last.then(v.becomes([(sum_v, 1.0)])));
        program
    }

    /// The coefficients of the effect of a ramp's change over a step, for u and v in turn.
    fn moments(&self, terms: usize) -> Moments {
        let count = self.kernels.len();
        // cos(pi k (j + 1/2)/count) for every product k (2 j + 1).
        let cosine = |turns: usize| (PI * turns as f64 / (2 * count) as f64).cos();
        let cosines: Vec<f64> = (0..4 * count).map(cosine).collect();
        let mut weights = Vec::with_capacity(2 * terms);
        for k in 0..terms {
            let factor = if k == 0 { 1.0 } else { 2.0 } / count as f64;
            let (mut of_u, mut of_v) = (vec![0.0; self.times.len()], vec![0.0; self.times.len()]);
            for (j, kernel) in self.kernels.iter().enumerate() {
                let share = factor * cosines[k * (2 * j + 1) % (4 * count)];
                for ((u, v), (s, rate)) in of_u.iter_mut().zip(&mut of_v).zip(kernel) {
                    *u += share * s;
                    *v += share * rate;
                }
            }
            weights.extend([of_u, of_v]);
        }
        Moments {
            times: self.times.clone(),
            weights,
        }
    }

    pub(super) fn facts(&self) -> Vec<Fact> {
        let fact = |name, value| Fact { name, value };
        vec![
            fact("degree", self.cut.degree() as f64),
            fact("step_error", self.cut.error),
            fact("relaxation", self.cut.relaxation),
        ]
    }
}

/// True if a ramp may change within a step when its jumps and kinks coincide with ends of steps.
fn may_change(ramp: &Ramp) -> bool {
    !matches!(
        ramp.course(),
        Ramp::Step | Ramp::Pulse { .. } | Ramp::Hold { .. }
    )
}

/// The update `target += moment x`.
fn plus_moment(target: Register, x: Register, load: u32, moment: u32) -> Update {
    let mut update = target.becomes([(target, 1.0)]);
    update.terms.push(Term {
        register: x,
        weight: Weight::OfLoad { load, moment },
    });
    update
}
