//! A reference at the instants a comparison needs.

use sinew_core::spectrum::Spectrum;
use sinew_core::vectors::{dot, largest};
use sinew_core::{State, System};

use super::error_norm::ErrorNorm;
use super::peak::peak_between;
use super::spot_checks::SpotChecks;
use super::{Expansion, Taylor};

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
    /// The reference's own estimate of its relative L2 error; see [`ReferenceMethod`].
    pub error: f64,
    /// Products with the matrices it took, the check included.
    pub sweeps: u64,
    /// The method by which it was solved.
    pub method: ReferenceMethod,
}

impl Track {
    /// Smallest relative error of a run that the reference measures as a number: of a smaller one it says
    /// only that it is below. 0 for a reference to rounding.
    #[must_use]
    pub fn least_error(&self) -> f64 {
        match self.method {
            ReferenceMethod::Taylor => 0.0,
            ReferenceMethod::Faber => TOLD_APART * self.error,
        }
    }
}

/// The method of a reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReferenceMethod {
    /// The Taylor series of the motion in time, to rounding; its error is the difference from the same with
    /// steps of two thirds the length.
    Taylor,
    /// Faber series of the exponential function in long steps; its error is the difference from the Taylor
    /// series over a fifth of the time, as if the rest were like it.
    Faber,
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

/// Smallest error of a run over the reference's own: even a tenth of it is then ten times larger.
pub(crate) const TOLD_APART: f64 = 100.0;

/// Length of a Taylor series's steps.
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

/// A method with its steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Course {
    /// By the Taylor series.
    Taylor(Pace),
    /// By Faber series.
    Faber,
}

/// Follows a system from `start` through `times` (s), increasing, and checks the result against a
/// second solution with other steps.
///
/// # Errors
/// [`ReferenceError`] when the system is not linear or the two solutions differ by more than 1e-6.
pub fn follow(system: &dyn System, start: &State, times: &[f64]) -> Result<Track, ReferenceError> {
    follow_by(Course::Taylor(Pace::Short), system, start, times)
}

/// As [`follow`], in a twentieth of the products: by Faber series in long steps, a fifth of them checked
/// by the Taylor series. The largest displacement is looked for at fewer instants.
///
/// # Errors
/// [`ReferenceError`] when the system is not linear or the error to expect is above 1e-6.
pub fn follow_affordably(
    system: &dyn System,
    start: &State,
    times: &[f64],
) -> Result<Track, ReferenceError> {
    follow_by(Course::Faber, system, start, times)
}

/// As [`follow`], by a method and its steps.
pub(crate) fn follow_by(
    course: Course,
    system: &dyn System,
    start: &State,
    times: &[f64],
) -> Result<Track, ReferenceError> {
    let linear = system.as_linear().ok_or(ReferenceError::NotLinear)?;
    let operators = linear.operators();
    let spectrum = Spectrum::of(operators);
    let track = match course {
        Course::Taylor(pace) => {
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

/// A motion as it is seen in passing.
struct Sight<'a> {
    times: &'a [f64],
    displacements: Vec<Vec<f64>>,
    before: State,
    max_u: f64,
    late: LateRange,
    late_from: f64,
}

impl<'a> Sight<'a> {
    fn new(start: &State, times: &'a [f64]) -> Self {
        Self {
            times,
            displacements: Vec::with_capacity(times.len()),
            before: start.clone(),
            max_u: largest(&start.u),
            late: LateRange::new(start.u.len()),
            late_from: 0.8 * times.last().copied().unwrap_or(0.0),
        }
    }

    /// Looks at the motion since the last look.
    fn pass(&mut self, state: &State) {
        let most = self.max_u.max(largest(&state.u));
        self.max_u = peak_between(&self.before, state, most);
        self.before.clone_from(state);
        if state.t() > self.late_from {
            self.late.include(&state.u);
        }
    }

    /// Keeps the displacement at the next of the instants.
    fn keep(&mut self, state: &State) {
        self.displacements.push(state.u.clone());
    }

    fn track(self, method: ReferenceMethod, error: f64, sweeps: u64) -> Track {
        Track {
            times: self.times.to_vec(),
            displacements: self.displacements,
            max_u: self.max_u,
            late_amplitude: self.late.amplitude(),
            error,
            sweeps,
            method,
        }
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
