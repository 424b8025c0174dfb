//! References of systems by all available methods.

use sinew_core::spectrum::Spectrum;
use sinew_core::vectors::dot;
use sinew_core::{LinearOperators, State, System};

use super::error_norm::ErrorNorm;
use super::extrapolated::by_extrapolation;
use super::spot_checks::SpotChecks;
use super::track::{ReferenceError, ReferenceMethod, Sight, Track};
use super::{Expansion, Taylor};

/// Largest error of an accepted reference.
const ALLOWED: f64 = 1e-6;

/// Ratio of the check's number of steps to that of the solution.
const CHECK: f64 = 1.5;

/// Length of a Taylor series's steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pace {
    /// Short enough to show the peaks of the fastest motion.
    Short,
    /// Four times as long, if short ones cost too much. At |lambda| h = 2 the last term of the series is below 2^24/24!
    /// = 3e-17, still below rounding; amplitudes of the fastest motion are less exact.
    Long,
}

impl Pace {
    /// Number of steps relative to [`Taylor`]'s own: above 1 they are shorter.
    pub(crate) fn refinement(self) -> f64 {
        match self {
            Self::Short => 1.0,
            Self::Long => 0.25,
        }
    }
}

/// A method and its steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Course {
    /// Taylor series.
    Taylor(Pace),
    /// Faber series.
    Faber,
    /// Extrapolation, for force laws and bodies in contact with tools.
    Extrapolated,
}

/// Follows a system from `start` through `times` (s), increasing, and checks the result against a
/// second solution with other steps.
///
/// # Errors
/// [`ReferenceError`] when the system is not linear or the two solutions differ by more than 1e-6.
pub fn follow(system: &dyn System, start: &State, times: &[f64]) -> Result<Track, ReferenceError> {
    follow_by(Course::Taylor(Pace::Short), system, start, times)
}

/// Like [`follow`], with a twentieth of the products: by Faber series in long steps, a fifth of them checked by the
/// Taylor series. The largest displacement is searched at fewer instants.
///
/// # Errors
/// [`ReferenceError`] when the system is not linear or the expected error is above 1e-6.
pub fn follow_affordably(
    system: &dyn System,
    start: &State,
    times: &[f64],
) -> Result<Track, ReferenceError> {
    follow_by(Course::Faber, system, start, times)
}

/// Like [`follow`], by a given method and its steps.
pub(crate) fn follow_by(
    course: Course,
    system: &dyn System,
    start: &State,
    times: &[f64],
) -> Result<Track, ReferenceError> {
    let track = match course {
        _ if system.contact().is_some() => return by_extrapolation(system, start, times),
        Course::Extrapolated => return by_extrapolation(system, start, times),
        Course::Taylor(pace) => {
            let (operators, spectrum) = matrices(system)?;
            let steps = |refinement| Taylor::within(operators, &spectrum, refinement);
            let track = by_taylor(steps(pace.refinement()), start, times);
            let check = by_taylor(steps(CHECK * pace.refinement()), start, times);
            Track {
                error: ErrorNorm::between(&check.displacements, &track.displacements),
                sweeps: track.sweeps + check.sweeps,
                ..track
            }
        }
        Course::Faber => {
            let (operators, spectrum) = matrices(system)?;
            let checks = SpotChecks::new(operators, &spectrum);
            let duration = times.last().map_or(0.0, |end| end - start.t());
            let expansion = Expansion::new(operators, &spectrum, duration);
            by_faber(expansion, checks, start, times)
        }
    };
    if track.error <= ALLOWED {
        return Ok(track);
    }
    Err(ReferenceError::Inaccurate {
        error: track.error,
        allowed: ALLOWED,
    })
}

fn matrices(system: &dyn System) -> Result<(&LinearOperators, Spectrum), ReferenceError> {
    let linear = system.as_linear().ok_or(ReferenceError::NotLinear)?;
    let operators = linear.operators();
    Ok((operators, Spectrum::of(operators)))
}

fn by_taylor(mut taylor: Taylor<'_>, start: &State, times: &[f64]) -> Track {
    let mut state = start.clone();
    let mut sight = Sight::new(start, times);
    for &time in times {
        taylor.advance(&mut state, time, |state| sight.pass(state));
        sight.keep(&state);
    }
    sight.track(ReferenceMethod::Taylor, 0.0, taylor.sweeps)
}

fn by_faber(
    mut expansion: Expansion<'_>,
    mut checks: SpotChecks<'_>,
    start: &State,
    times: &[f64],
) -> Track {
    let mut state = start.clone();
    let mut before = start.clone();
    let mut sight = Sight::new(start, times);
    let mut reached = times.partition_point(|time| *time <= start.t());
    for _ in 0..reached {
        sight.keep(&state);
    }
    while reached < times.len() {
        reached += expansion.step(&mut state, &times[reached..], |state, is_asked_for| {
            sight.pass(state);
            if is_asked_for {
                sight.keep(state);
            }
        });
        checks.see(&before, &state);
        before.clone_from(&state);
    }
    let squares: f64 = sight.displacements.iter().map(|u| dot(u, u)).sum();
    let size = (squares / times.len() as f64).sqrt();
    let sweeps = expansion.sweeps + checks.sweeps();
    sight.track(ReferenceMethod::Faber, checks.error(size), sweeps)
}

#[cfg(test)]
mod tests {
    use sinew_core::closed_form::DampedOscillator;
    use sinew_core::{LinearModel, LinearOperators, Load, Ramp};

    use super::*;

    #[test]
    fn the_peak_of_the_papers_oscillator_is_that_of_the_closed_form() {
        let model = LinearModel::new(LinearOperators::oscillator(0.1, 100.0, 1.0).unwrap());
        let start = State::new(vec![0.0], vec![-5.0]);
        let times: Vec<f64> = (0..=50).map(|j| f64::from(j) * 0.02).collect();
        let track = follow(&model, &start, &times).unwrap();
        // v = 0 first where tan(w t) = 2 w/c, at |u| = 5/omega exp(-c t/2).
        let w = (1000.0_f64 - 25.0).sqrt();
        let t = (2.0 * w / 10.0).atan() / w;
        let peak = 5.0 / 1000.0_f64.sqrt() * (-5.0 * t).exp();
        assert!(
            (track.max_u / peak - 1.0).abs() < 1e-4,
            "{} {peak}",
            track.max_u
        );
        assert!((peak - 0.12612).abs() < 5e-6);
        assert!(track.error < 1e-12);
    }

    fn pulsed_oscillator() -> LinearModel {
        // The pulse of no size cuts steps off the instants.
        let load = |ramp: Ramp, size: f64| Load {
            ramp,
            entries: vec![(0, size)],
        };
        let pulse = Ramp::Pulse {
            from: 0.1234,
            to: 0.2345,
        };
        let loads = vec![load(Ramp::Step, 2.0), load(pulse, 0.0)];
        let operators = LinearOperators::oscillator(0.1, 100.0, 0.2)
            .and_then(|operators| operators.with_loads(loads))
            .unwrap();
        LinearModel::new(operators)
    }

    #[test]
    fn long_steps_lose_nothing_to_the_closed_form_and_save_half_the_work() {
        let model = pulsed_oscillator();
        let start = State::new(vec![0.01], vec![-5.0]);
        let times: Vec<f64> = (0..=10).map(|j| f64::from(j) * 0.5).collect();
        let long = follow_by(Course::Taylor(Pace::Long), &model, &start, &times).unwrap();
        let exact = DampedOscillator {
            omega: 1000.0_f64.sqrt(),
            damping: 2.0,
            load: 20.0,
            displacement: 0.01,
            velocity: -5.0,
        };
        for (t, u) in times.iter().zip(&long.displacements) {
            assert!((u[0] - exact.at(*t).0).abs() < 1e-13, "at {t} s");
        }
        assert!(long.error < 1e-11, "{}", long.error);
        let full = follow(&model, &start, &times).unwrap();
        assert!(
            2 * long.sweeps < full.sweeps,
            "{} {}",
            long.sweeps,
            full.sweeps
        );
        assert!((long.max_u / full.max_u - 1.0).abs() < 0.2);
    }
}
