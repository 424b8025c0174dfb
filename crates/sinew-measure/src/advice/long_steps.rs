//! A reference in steps four times as long, for scenes whose own takes too much time.

use sinew_core::spectrum::Spectrum;
use sinew_core::{State, System};

use crate::reference::{ErrorNorm, LateRange, ReferenceError, Taylor, Track, largest};

/// Steps against those of the full reference. At |lambda| h = 2 the last term of the series is below
/// 2^24/24! = 3e-17, still under rounding; only peaks of the fastest motion pass between the steps.
pub(super) const REFINEMENT: f64 = 0.25;

/// Steps of the check against those of the solution.
const CHECK: f64 = 1.5;

/// Largest error of a reference that is still called one.
const ALLOWED: f64 = 1e-6;

/// As [`follow`](crate::reference::follow), in steps four times as long, its check as well. Sizes of
/// the motion are those at the ends of the steps.
pub(super) fn follow_in_long_steps(
    system: &dyn System,
    start: &State,
    times: &[f64],
) -> Result<Track, ReferenceError> {
    let linear = system.as_linear().ok_or(ReferenceError::NotLinear)?;
    let operators = linear.operators();
    let spectrum = Spectrum::of(operators);
    let solve = |refinement| {
        solve(
            Taylor::within(operators, &spectrum, refinement),
            start,
            times,
        )
    };
    let mut track = solve(REFINEMENT);
    let check = solve(CHECK * REFINEMENT);
    let mut difference = ErrorNorm::default();
    let pairs = check.displacements.iter().zip(&track.displacements);
    pairs.for_each(|(check, u)| difference.include(check, u));
    track.error = difference.relative();
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
    let mut displacements = Vec::with_capacity(times.len());
    for &time in times {
        taylor.advance(&mut state, time, |state| {
            max_u = max_u.max(largest(&state.u));
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

#[cfg(test)]
mod tests {
    use sinew_core::closed_form::DampedOscillator;
    use sinew_core::{LinearModel, LinearOperators, Load, Ramp};

    use super::*;
    use crate::reference::follow;

    fn oscillator() -> LinearModel {
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
        let model = oscillator();
        let start = State::new(vec![0.01], vec![-5.0]);
        let times: Vec<f64> = (0..=10).map(|j| f64::from(j) * 0.5).collect();
        let long = follow_in_long_steps(&model, &start, &times).unwrap();
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
