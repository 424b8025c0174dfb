//! The Taylor series of a linear system's motion.

use std::f64::consts::PI;

use sinew_core::spectrum::Spectrum;
use sinew_core::{Clock, LinearOperators, State};

use super::fastest_turn;

/// Largest |lambda| h, lambda being the fastest root of the motion. The series would be accurate beyond a
/// few; shorter steps show the peaks of the motion between them.
const REACH: f64 = 0.5;

/// Terms of the series. At |lambda| h = 1/2 the last is below 2^-24/24!, far below rounding.
const TERMS: usize = 24;

/// Largest |lambda| h of a check: terms up to e^12 leave ten digits of the fastest motion.
const REACH_OF_CHECK: f64 = 12.0;

/// Terms of a check. At |lambda| h = 12 the last is below 12^50/50! = 3e-11.
const TERMS_OF_CHECK: usize = 50;

/// Number of relevant derivatives of a load's factor in a check: the phase of a factor changes by at most pi in a step,
/// and pi^32/32! is 3e-20.
const DERIVATIVES_OF_CHECK: usize = 32;

/// Steps a linear system by the Taylor series of its motion (Moler and Van Loan, SIAM Review 45,
/// 2003, method 1 on steps in which it is safe), load derivatives included.
#[derive(Debug)]
pub struct Taylor<'a> {
    operators: &'a LinearOperators,
    longest_step: f64,
    terms: usize,
    breakpoints: Vec<f64>,
    /// Derivatives of each load's factor; higher ones are 0.
    ramps: Vec<Vec<f64>>,
    displacement: Vec<f64>,
    velocity: Vec<f64>,
    next: Vec<f64>,
    /// Products with the matrices so far.
    pub sweeps: u64,
}

impl<'a> Taylor<'a> {
    /// The series for these matrices. `refinement` above 1 takes shorter steps, for a check by comparison.
    #[must_use]
    pub fn new(operators: &'a LinearOperators, refinement: f64) -> Self {
        Self::within(operators, &Spectrum::of(operators), refinement)
    }

    /// Like [`Taylor::new`], with a known spectrum of the matrices.
    #[must_use]
    pub fn within(operators: &'a LinearOperators, spectrum: &Spectrum, refinement: f64) -> Self {
        let series = Self::with(operators, spectrum, REACH, [TERMS; 2]);
        Self {
            longest_step: series.longest_step / refinement,
            ..series
        }
    }

    /// The series in long steps of many terms, which costs a tenth and is correct to about ten digits.
    pub(crate) fn checking(operators: &'a LinearOperators, spectrum: &Spectrum) -> Self {
        let counts = [TERMS_OF_CHECK, DERIVATIVES_OF_CHECK];
        Self::with(operators, spectrum, REACH_OF_CHECK, counts)
    }

    fn with(
        operators: &'a LinearOperators,
        spectrum: &Spectrum,
        reach: f64,
        [terms, derivatives]: [usize; 2],
    ) -> Self {
        let damping = spectrum.mass_damping + spectrum.damping_max;
        // |lambda|^2 <= d |lambda| + w^2 for every root.
        let half = damping / 2.0;
        let fastest = half + (half * half + spectrum.omega_max.powi(2)).sqrt();
        let dofs = operators.dofs();
        let loads = operators.loads();
        let mut breakpoints: Vec<f64> = loads
            .iter()
            .flat_map(|load| load.ramp.breakpoints())
            .collect();
        breakpoints.sort_by(f64::total_cmp);
        Self {
            operators,
            longest_step: (reach / fastest).min(reach.min(PI) / fastest_turn(operators)),
            terms,
            breakpoints,
            ramps: vec![vec![0.0; derivatives]; loads.len()],
            displacement: vec![0.0; dofs],
            velocity: vec![0.0; dofs],
            next: vec![0.0; dofs],
            sweeps: 0,
        }
    }

    /// The longest step (s) that it takes automatically.
    #[must_use]
    pub fn longest_step(&self) -> f64 {
        self.longest_step
    }

    /// Moves `state`, whose velocity must be at the displacement's time, to time `t` (s). `each_step` receives the
    /// displacement after every internal step.
    pub fn advance(&mut self, state: &mut State, t: f64, mut each_step: impl FnMut(&State)) {
        while state.t() < t {
            let passed = self.breakpoints.partition_point(|time| *time <= state.t());
            let end = self.breakpoints.get(passed).map_or(t, |time| time.min(t));
            let parts = ((end - state.t()) / self.longest_step).ceil().max(1.0);
            let start = state.t();
            for part in 1..=parts as usize {
                // The end itself, not a sum that may miss a breakpoint by rounding.
                let next = if part == parts as usize {
                    end
                } else {
                    start + (end - start) * part as f64 / parts
                };
                self.step(state, next);
                each_step(state);
            }
        }
    }

    /// One series: with c_k = h^k u^(k)/k! and e_k = h^k v^(k)/k!,
    /// c_k+1 = h e_k/(k+1) and e_k+1 = h M^-1 (h^k F^(k)/k! - K c_k - D e_k)/(k+1).
    fn step(&mut self, state: &mut State, end: f64) {
        let h = end - state.t();
        for (load, derivatives) in self.operators.loads().iter().zip(&mut self.ramps) {
            load.ramp.derivatives_after(state.t(), derivatives);
        }
        self.displacement.copy_from_slice(&state.u);
        self.velocity.copy_from_slice(&state.v);
        let mut weight = 1.0;
        for k in 0..self.terms {
            self.next.fill(0.0);
            let mut loaded = false;
            for (load, derivatives) in self.operators.loads().iter().zip(&self.ramps) {
                let rest = derivatives.get(k..).unwrap_or_default();
                let factor = weight * rest.first().unwrap_or(&0.0);
                loaded |= rest.iter().any(|derivative| *derivative != 0.0);
                if factor != 0.0 {
                    for &(dof, force) in &load.entries {
                        self.next[dof as usize] += factor * force;
                    }
                }
            }
            self.operators.subtract_internal_force(
                &self.displacement,
                &self.velocity,
                &mut self.next,
            );
            self.sweeps += 1;
            let share = h / (k as f64 + 1.0);
            weight *= share;
            let mut negligible = !loaded;
            for (i, mass) in self.operators.mass().iter().enumerate() {
                let c = share * self.velocity[i];
                let e = share * self.next[i] / mass;
                self.displacement[i] = c;
                self.velocity[i] = e;
                let (u, v) = (state.u[i] + c, state.v[i] + e);
                negligible &= u == state.u[i] && v == state.v[i];
                state.u[i] = u;
                state.v[i] = v;
            }
            if negligible {
                break;
            }
        }
        // The instant itself, not one computed from steps: breakpoints are met exactly.
        state.clock = Clock::at(end);
    }
}

#[cfg(test)]
mod tests {
    use sinew_core::closed_form::DampedOscillator;
    use sinew_core::{Load, Ramp};

    use super::*;

    #[test]
    fn the_papers_oscillator_to_rounding() {
        for damping in [0.0, 1.0, 6.0, 50.0] {
            let load = Load {
                ramp: Ramp::Step,
                entries: vec![(0, 2.0)],
            };
            let operators = LinearOperators::oscillator(0.1, 100.0, damping)
                .and_then(|operators| operators.with_loads(vec![load]))
                .unwrap();
            let exact = DampedOscillator {
                omega: 1000.0_f64.sqrt(),
                damping: damping / 0.1,
                load: 20.0,
                displacement: 0.01,
                velocity: -5.0,
            };
            let mut state = State::new(vec![0.01], vec![-5.0]);
            let mut taylor = Taylor::new(&operators, 1.0);
            for step in 1..=20 {
                taylor.advance(&mut state, f64::from(step) * 0.05, |_| {});
                let (u, v) = exact.at(state.t());
                assert!(
                    (state.u[0] - u).abs() < 1e-13,
                    "d = {damping}, t = {}",
                    state.t()
                );
                assert!((state.v[0] - v).abs() < 1e-11);
            }
        }
    }

    #[test]
    fn a_smooth_ramp_matches_duhamels_integral() {
        // Undamped, q'' + w^2 q = (1 - cos(r t))/2 with r = pi/rise, from rest.
        let rise = 0.3;
        let load = Load {
            ramp: Ramp::Sin2 { rise },
            entries: vec![(0, 1.0)],
        };
        let operators = LinearOperators::oscillator(1.0, 400.0, 0.0)
            .and_then(|operators| operators.with_loads(vec![load]))
            .unwrap();
        let (w, r) = (20.0_f64, PI / rise);
        let exact = |t: f64| {
            let forced = (1.0 - (w * t).cos()) / (w * w);
            let swinging = ((r * t).cos() - (w * t).cos()) / (w * w - r * r);
            0.5 * (forced - swinging)
        };
        let mut state = State::at_rest(1);
        let mut taylor = Taylor::new(&operators, 1.0);
        for t in [0.07, 0.15, 0.29, 0.3] {
            taylor.advance(&mut state, t, |_| {});
            assert!((state.u[0] - exact(t)).abs() < 1e-15, "at {t}");
        }
    }

    /// The displacement of `q'' + w^2 q = sin(r t + phase)` from rest.
    fn under_a_sine(w: f64, r: f64, phase: f64, t: f64) -> f64 {
        let size = (w * w - r * r).recip();
        let at_start = [phase.sin(), r * phase.cos()].map(|part| size * part);
        size * (r * t + phase).sin() - at_start[0] * (w * t).cos() - at_start[1] / w * (w * t).sin()
    }

    #[test]
    fn a_sine_much_faster_than_the_body_matches_duhamels_integral() {
        for (frequency, phase) in [(1.0, 0.0), (17.0, 0.8), (900.0, -1.3)] {
            let load = Load {
                ramp: Ramp::Sine { frequency, phase },
                entries: vec![(0, 1.0)],
            };
            let operators = LinearOperators::oscillator(1.0, 4.0, 0.0)
                .and_then(|operators| operators.with_loads(vec![load]))
                .unwrap();
            let rate = std::f64::consts::TAU * frequency;
            let spectrum = Spectrum::of(&operators);
            let both = [
                Taylor::new(&operators, 1.0),
                Taylor::checking(&operators, &spectrum),
            ];
            for mut taylor in both {
                let mut state = State::at_rest(1);
                for t in [0.07, 0.5, 3.0] {
                    taylor.advance(&mut state, t, |_| {});
                    let exact = under_a_sine(2.0, rate, phase, t);
                    let off = state.u[0] - exact;
                    assert!(
                        off.abs() < 1e-10,
                        "{frequency} Hz at {t}: {off:e} m of {exact}"
                    );
                }
            }
            let mut series = super::super::Expansion::new(&operators, &spectrum, 3.0);
            let (mut state, times) = (State::at_rest(1), [0.07, 0.5, 3.0]);
            let mut reached = 0;
            while reached < times.len() {
                reached += series.step(&mut state, &times[reached..], |seen, _| {
                    let exact = under_a_sine(2.0, rate, phase, seen.t());
                    let (off, t) = (seen.u[0] - exact, seen.t());
                    assert!(
                        off.abs() < 1e-10,
                        "{frequency} Hz at {t}: {off:e} m of {exact}"
                    );
                });
            }
        }
    }

    #[test]
    fn a_pulse_is_two_steps() {
        let with = |ramps: &[(Ramp, f64)]| {
            let loads = ramps.iter().map(|(ramp, force)| Load {
                ramp: ramp.clone(),
                entries: vec![(0, *force)],
            });
            let operators = LinearOperators::oscillator(1.0, 300.0, 2.0)
                .and_then(|operators| operators.with_loads(loads.collect()))
                .unwrap();
            let mut state = State::at_rest(1);
            Taylor::new(&operators, 1.0).advance(&mut state, 0.5, |_| {});
            state.u[0]
        };
        let pulse = with(&[(
            Ramp::Pulse {
                from: 0.1,
                to: 0.23,
            },
            5.0,
        )]);
        let late = |from: f64| Ramp::Pulse { from, to: 99.0 };
        let difference = with(&[(late(0.1), 5.0), (late(0.23), -5.0)]);
        assert!((pulse - difference).abs() < 1e-15, "{pulse} {difference}");
    }
}
