//! Reference solutions of force laws, extrapolated to steps of zero length.

use sinew_core::{ElasticLaw, Integrator, Run, State, System};
use sinew_integrators::Method;
use sinew_integrators::explicit::{CentralDifference, Rk4, SymplecticEuler};
#[cfg(feature = "implicit")]
use sinew_integrators::implicit::{GeneralizedAlpha, Newmark};

use super::error_norm::ErrorNorm;
use super::track::{ReferenceError, ReferenceMethod, Sight, Track};
use crate::cpu_time::thread_cpu_time;

/// Largest difference from the second solution for which a reference is accepted.
const ALLOWED: f64 = 1e-2;

/// Number of steps from which the cost of a solution is predicted.
const TRIAL_STEPS: u32 = 2;

/// A method whose error falls as a power of the step, and the halving of its steps.
struct Falling {
    integrator: Box<dyn Integrator>,
    order: i32,
    /// Longest step (s), with which it begins.
    first: f64,
    /// Largest number of halvings of this step.
    halvings: u32,
    /// Relative difference of two solutions in halved steps below which no shorter ones are tried.
    aim: f64,
}

impl Falling {
    /// The method of the solution and that of the check, for a system whose stable step of undamped leapfrog at rest is `critical` (s) and
    /// instants `interval` (s) apart.
    fn pair(system: &dyn System, critical: f64, interval: f64) -> [Self; 2] {
        if system.contact().is_some() {
            return Self::touched((critical / 4.0).min(interval));
        }
        let damping = system.as_elastic().map(ElasticLaw::damping);
        #[cfg(feature = "implicit")]
        if damping.is_some_and(|damping| damping.stiffness > 0.0) {
            return Self::implicit(interval);
        }
        let _ = damping;
        let first = (critical / 4.0).min(interval);
        [
            Self {
                integrator: Rk4.integrator(),
                order: 4,
                first,
                halvings: 6,
                aim: 1e-6,
            },
            Self {
                integrator: CentralDifference.integrator(),
                order: 2,
                first: first / 2.0,
                halvings: 6,
                aim: 1e-5,
            },
        ]
    }

    /// Methods for bodies with tools: contact is exact at the end of each step, but the methods do not know the time
    /// within the step at which a node met its tool. So the check also takes steps of another length, which end at
    /// other times.
    fn touched(first: f64) -> [Self; 2] {
        let falling = |integrator: Box<dyn Integrator>, first: f64| Self {
            integrator,
            order: 1,
            first,
            halvings: 5,
            aim: 1e-4,
        };
        [
            falling(CentralDifference.integrator(), first),
            falling(SymplecticEuler.integrator(), first / 1.5),
        ]
    }

    /// Methods for stiffness damping, under which explicit steps would have to be as short as the square of their
    /// stable length: the average acceleration method, and generalised-alpha as the check. Their errors are similar in
    /// steps of the same length, so that their difference would hide a common part: the check's steps are twice as
    /// long.
    #[cfg(feature = "implicit")]
    fn implicit(interval: f64) -> [Self; 2] {
        let falling = |integrator: Box<dyn Integrator>, first: f64| Self {
            integrator,
            order: 2,
            first,
            halvings: 3,
            aim: 1e-5,
        };
        [
            falling(Newmark::default().integrator(), interval / 2.0),
            falling(
                GeneralizedAlpha::with_spectral_radius(0.8).integrator(),
                interval,
            ),
        ]
    }
}

/// Number of halvings after which most solutions hardly change.
const USUAL_HALVINGS: i32 = 3;

/// CPU time (s) per simulated second of [`by_extrapolation`] with the usual number of halvings, estimated from some
/// first steps; infinite if these fail.
pub(crate) fn cost_of_extrapolation(system: &dyn System, start: &State, interval: f64) -> f64 {
    let pair = Falling::pair(system, critical_step(system), interval);
    let cost = |mut method: Falling| {
        let (mut state, before) = (start.clone(), thread_cpu_time());
        for _ in 0..TRIAL_STEPS {
            if let Err(_refused) = method.integrator.step(system, &mut state, method.first) {
                return f64::INFINITY;
            }
        }
        let step = (thread_cpu_time() - before).as_secs_f64() / f64::from(TRIAL_STEPS);
        (2.0_f64.powi(USUAL_HALVINGS + 1) - 1.0) * step / method.first
    };
    pair.map(cost).iter().sum()
}

fn critical_step(system: &dyn System) -> f64 {
    let spectrum = system.spectrum(None);
    spectrum.map_or(f64::INFINITY, |spectrum| spectrum.critical_step())
}

/// A solution in halved steps until it hardly changes.
struct Converged<'a> {
    sight: Sight<'a>,
    extrapolated: Vec<Vec<f64>>,
    impulses: Vec<Vec<f64>>,
    /// Relative difference between the extrapolated solution and that in the shortest steps.
    difference: f64,
    sweeps: u64,
}

/// Follows a system from `start` through `times` (s), increasing: by Runge and Kutta's method in steps that are halved
/// until the solution hardly changes, extrapolated by Richardson's rule; and a second time by central difference, which
/// has another order and no formula in common, also extrapolated. Bodies with stiffness damping are followed by
/// implicit methods, bodies in contact with tools by the two methods of order 1.
///
/// # Errors
/// [`ReferenceError`] if neither converges, or the two solutions differ by more than 1 %.
pub(super) fn by_extrapolation<'a>(
    system: &dyn System,
    start: &'a State,
    times: &'a [f64],
) -> Result<Track, ReferenceError> {
    let interval = times.windows(2).map(|pair| pair[1] - pair[0]);
    let interval = interval.fold(f64::INFINITY, f64::min);
    let [method, of_check] = Falling::pair(system, critical_step(system), interval);
    let name = method.integrator.id();
    let solution = converge(method, system, start, times)?;
    let check = converge(of_check, system, start, times)?;
    let between = ErrorNorm::between(&check.extrapolated, &solution.extrapolated);
    if between.is_nan() || between > ALLOWED {
        return Err(ReferenceError::Inaccurate {
            error: between,
            allowed: ALLOWED,
        });
    }
    let sweeps = solution.sweeps + check.sweeps;
    let method = ReferenceMethod::Extrapolated {
        method: name,
        by_rule: solution.difference,
    };
    let mut track = solution.sight.track(method, between, sweeps);
    track.displacements = solution.extrapolated;
    track.impulses = solution.impulses;
    Ok(track)
}

fn converge<'a>(
    mut method: Falling,
    system: &dyn System,
    start: &'a State,
    times: &'a [f64],
) -> Result<Converged<'a>, ReferenceError> {
    let mut sweeps = 0;
    let mut coarse: Option<Sight<'_>> = None;
    let mut best: Option<Converged<'a>> = None;
    for halving in 0..=method.halvings {
        // Steps that a law refuses are too long, as are those between which a solution diverges.
        let Some(fine) = follow(&mut method, system, start, times, halving, &mut sweeps) else {
            coarse = None;
            continue;
        };
        if let Some(coarse) = &coarse {
            let share = (2.0_f64.powi(method.order) - 1.0).recip();
            let extrapolated = extrapolate(&coarse.displacements, &fine.displacements, share);
            let impulses = extrapolate(&coarse.impulses, &fine.impulses, share);
            let difference = ErrorNorm::between(&fine.displacements, &extrapolated);
            best = Some(Converged {
                sight: fine.clone(),
                extrapolated,
                impulses,
                difference,
                sweeps,
            });
            if difference <= method.aim {
                break;
            }
        }
        coarse = Some(fine);
    }
    let method = method.integrator.id();
    best.filter(|best| best.difference.is_finite())
        .ok_or(ReferenceError::NotConverged { method })
}

/// The motion in a whole number of equal steps between each two instants, halved a given number of times; `None` if it
/// cannot be computed. Each halving has exactly twice as many steps everywhere, because Richardson's rule would
/// otherwise remove a wrong error.
fn follow<'a>(
    method: &mut Falling,
    system: &dyn System,
    start: &State,
    times: &'a [f64],
    halvings: u32,
    sweeps: &mut u64,
) -> Option<Sight<'a>> {
    let mut sight = Sight::new(start, times);
    let mut state = start.clone();
    let (mut before, mut dt) = (state.t(), 0.0);
    for &time in times {
        let span = time - before;
        before = time;
        if span <= 0.0 {
            sight.keep_of(system, &state);
            continue;
        }
        let steps = Run::covering(span, method.first).steps.max(1) << halvings;
        let own = span / steps as f64;
        // Instants at equal distances differ by rounding, which is no reason for another step.
        if f64::abs(own / dt - 1.0) > 1e-9 || dt == 0.0 {
            dt = own;
        }
        for _ in 0..steps {
            *sweeps += method.integrator.step(system, &mut state, dt).ok()?.sweeps;
            if !state.u.iter().all(|u| u.is_finite()) {
                return None;
            }
            sight.pass(&state);
        }
        sight.keep_of(system, &state);
    }
    Some(sight)
}

/// Richardson's rule for values in steps and in half steps: `share` of their difference is added.
fn extrapolate(coarse: &[Vec<f64>], fine: &[Vec<f64>], share: f64) -> Vec<Vec<f64>> {
    let pairs = coarse.iter().zip(fine);
    pairs
        .map(|(coarse, fine)| {
            let pairs = coarse.iter().zip(fine);
            pairs
                .map(|(coarse, fine)| fine + share * (fine - coarse))
                .collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use sinew_core::closed_form::DampedOscillator;
    use sinew_core::{LinearModel, LinearOperators, Load, Ramp};

    use super::*;

    fn oscillator() -> (LinearModel, State, DampedOscillator) {
        let load = Load {
            ramp: Ramp::Step,
            entries: vec![(0, 2.0)],
        };
        let operators = LinearOperators::oscillator(0.1, 100.0, 0.2)
            .and_then(|operators| operators.with_loads(vec![load]))
            .unwrap();
        let exact = DampedOscillator {
            omega: 1000.0_f64.sqrt(),
            damping: 2.0,
            load: 20.0,
            displacement: 0.01,
            velocity: -5.0,
        };
        let start = State::new(vec![0.01], vec![-5.0]);
        (LinearModel::new(operators), start, exact)
    }

    fn motion(exact: &DampedOscillator, times: &[f64]) -> Vec<Vec<f64>> {
        times.iter().map(|t| vec![exact.at(*t).0]).collect()
    }

    /// The rule needs only the forces of a system, so that a linear one shows its accuracy.
    #[test]
    fn it_is_the_closed_form_of_a_loaded_oscillator() {
        let (model, start, exact) = oscillator();
        let times: Vec<f64> = (0..=20).map(|j| f64::from(j) * 0.1).collect();
        let track = by_extrapolation(&model, &start, &times).unwrap();
        let error = ErrorNorm::between(&track.displacements, &motion(&exact, &times));
        assert!(error < 1e-7, "{error}");
        // The difference of both solutions tells the true error but for that of the second.
        assert!(error < 2.0 * track.error, "{error} {}", track.error);
    }

    /// Instants are rounded, so that some intervals differ from the first step in their last digits.
    #[cfg(feature = "implicit")]
    #[test]
    fn implicit_steps_are_halved_between_all_instants_alike() {
        let (model, start, exact) = oscillator();
        let times: Vec<f64> = (0..=50).map(|j| f64::from(j) * 0.5 / 50.0).collect();
        let [newmark, check] = Falling::implicit(0.01 * (1.0 - 1e-15)).map(|method| {
            converge(method, &model, &start, &times)
                .unwrap()
                .extrapolated
        });
        let error = ErrorNorm::between(&newmark, &motion(&exact, &times));
        let stated = ErrorNorm::between(&newmark, &check);
        assert!(error < 1e-4 && error < 2.0 * stated, "{error} {stated}");
    }

    /// Halving between instants that the first step does not divide.
    #[test]
    fn halving_takes_twice_the_steps_where_the_first_does_not_divide_the_interval() {
        let (model, start, _) = oscillator();
        let times = [0.0, 0.1, 0.23];
        let steps = |halvings| {
            let [mut method, _] = Falling::pair(&model, 0.12, 0.1);
            let mut sweeps = 0;
            follow(&mut method, &model, &start, &times, halvings, &mut sweeps).unwrap();
            sweeps
        };
        assert_eq!([steps(1), steps(2)], [2 * steps(0), 4 * steps(0)]);
    }
}
