//! A reference at the instants a comparison needs.

use sinew_core::spectrum::Spectrum;
use sinew_core::vectors::largest;
use sinew_core::{State, System};

use super::Taylor;
use super::error_norm::ErrorNorm;
use super::peak::peak_between;

/// A reference solution at some instants, with what the verdicts need of the whole run.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    /// Instants (s).
    pub times: Vec<f64>,
    /// Displacement (m) at each instant.
    pub displacements: Vec<Vec<f64>>,
    /// Largest |component| (m) over the run.
    pub max_u: f64,
    /// Half the range (m) of the worst degree of freedom over the last fifth of the run.
    pub late_amplitude: f64,
    /// Relative L2 difference from the same solution with steps of two thirds the length: the
    /// reference's own estimate of its error.
    pub error: f64,
    /// Products with the matrices it took, the check included.
    pub sweeps: u64,
}

/// Why there is no reference.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReferenceError {
    /// The system is not linear.
    #[error("a reference solution needs the matrices of a linear system")]
    NotLinear,
    /// Its own check failed.
    #[error(
        "the reference solution differs from its check by {error:.1e}, more than {allowed:.0e}; the scene moves too fast for its duration"
    )]
    Inaccurate {
        /// Relative L2 difference.
        error: f64,
        /// Largest difference allowed.
        allowed: f64,
    },
}

/// Largest error of a reference that is still called one.
const ALLOWED: f64 = 1e-6;

/// Steps of the check against those of the solution.
const CHECK: f64 = 1.5;

/// Length of a reference's steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pace {
    /// Short enough to see the peaks of the fastest motion.
    Short,
    /// Four times as long, where short ones cost too much. At |lambda| h = 2 the last term of the series
    /// is below 2^24/24! = 3e-17, still under rounding; sizes of the fastest motion are less exact.
    Long,
}

impl Pace {
    /// Steps against those of [`Taylor`]: above 1 they are shorter.
    pub(crate) fn refinement(self) -> f64 {
        match self {
            Self::Short => 1.0,
            Self::Long => 0.25,
        }
    }
}

/// Follows a system from `start` through `times` (s), increasing, and checks the result against a
/// second solution with other steps.
///
/// # Errors
/// [`ReferenceError`] when the system is not linear or the two solutions differ by more than 1e-6.
pub fn follow(system: &dyn System, start: &State, times: &[f64]) -> Result<Track, ReferenceError> {
    follow_at(Pace::Short, system, start, times)
}

/// As [`follow`], at a pace.
pub(crate) fn follow_at(
    pace: Pace,
    system: &dyn System,
    start: &State,
    times: &[f64],
) -> Result<Track, ReferenceError> {
    let linear = system.as_linear().ok_or(ReferenceError::NotLinear)?;
    let operators = linear.operators();
    let spectrum = Spectrum::of(operators);
    let steps = |refinement| Taylor::within(operators, &spectrum, refinement);
    let mut track = solve(steps(pace.refinement()), start, times);
    let check = solve(steps(CHECK * pace.refinement()), start, times);
    track.error = ErrorNorm::between(&check.displacements, &track.displacements);
    track.sweeps += check.sweeps;
    if track.error <= ALLOWED {
        return Ok(track);
    }
    Err(ReferenceError::Inaccurate {
        error: track.error,
        allowed: ALLOWED,
    })
}

fn solve(mut taylor: Taylor<'_>, start: &State, times: &[f64]) -> Track {
    let mut state = start.clone();
    let mut late = LateRange::new(start.u.len());
    let duration = times.last().copied().unwrap_or(0.0);
    let mut max_u = largest(&start.u);
    let mut before = start.clone();
    let mut displacements = Vec::with_capacity(times.len());
    for &time in times {
        taylor.advance(&mut state, time, |state| {
            max_u = peak_between(&before, state, max_u.max(largest(&state.u)));
            before.clone_from(state);
            if state.t() > 0.8 * duration {
                late.include(&state.u);
            }
        });
        displacements.push(state.u.clone());
    }
    Track {
        times: times.to_vec(),
        displacements,
        max_u,
        late_amplitude: late.amplitude(),
        error: 0.0,
        sweeps: taylor.sweeps,
    }
}

/// Range of each degree of freedom over some states.
#[derive(Clone, Debug)]
pub(crate) struct LateRange {
    low: Vec<f64>,
    high: Vec<f64>,
}

impl LateRange {
    pub(crate) fn new(dofs: usize) -> Self {
        Self {
            low: vec![f64::INFINITY; dofs],
            high: vec![f64::NEG_INFINITY; dofs],
        }
    }

    pub(crate) fn include(&mut self, u: &[f64]) {
        for ((low, high), u) in self.low.iter_mut().zip(&mut self.high).zip(u) {
            *low = low.min(*u);
            *high = high.max(*u);
        }
    }

    /// Half the range (m) of the worst degree of freedom; 0 before any state.
    pub(crate) fn amplitude(&self) -> f64 {
        let ranges = self
            .low
            .iter()
            .zip(&self.high)
            .map(|(low, high)| high - low);
        ranges.fold(0.0, f64::max) / 2.0
    }
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
        let long = follow_at(Pace::Long, &model, &start, &times).unwrap();
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
