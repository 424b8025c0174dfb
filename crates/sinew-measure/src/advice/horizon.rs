//! How much of a scene its pilots can follow.

use sinew_scene::Simulation;

use super::AdviceError;
use crate::case::Span;
use crate::cpu_time::thread_cpu_time;
use crate::reference::Taylor;

/// The reference is solved twice, the second time in steps of two thirds: 1 + 3/2 solutions.
const SOLUTIONS: f64 = 2.5;

/// Steps of the reference whose cost is measured.
const TRIAL_STEPS: f64 = 4.0;

/// Instants of the comparison where not even one interval of the scene's can be followed.
const INSTANTS: usize = 10;

/// Smallest share of an interval that still says something about the scene.
const SMALLEST_SHARE: f64 = 1e-3;

/// The longest part of a scene, from t = 0, whose reference takes at most so much CPU time (s):
/// all of it, or some of its intervals, or a whole fraction of the first.
pub(super) fn horizon(simulation: &Simulation, seconds: f64) -> Result<Span, AdviceError> {
    let whole = Span::of(simulation);
    let affordable = seconds / reference_cost(simulation);
    if affordable >= whole.duration {
        return Ok(whole);
    }
    let interval = whole.interval();
    let intervals = (affordable / interval).floor();
    if intervals >= whole.samples as f64 {
        return Ok(whole);
    }
    if intervals >= 1.0 {
        return Ok(Span {
            duration: intervals * interval,
            samples: intervals as usize,
        });
    }
    let part = interval / (interval / affordable).ceil();
    if part >= SMALLEST_SHARE * interval {
        return Ok(Span {
            duration: part,
            samples: INSTANTS,
        });
    }
    let duration = SMALLEST_SHARE * interval;
    Err(AdviceError::TooFast {
        duration,
        needed: duration / affordable * seconds,
    })
}

/// CPU time (s) per simulated second of a checked reference, from its first steps.
fn reference_cost(simulation: &Simulation) -> f64 {
    let Some(linear) = simulation.system().as_linear() else {
        // The reference says what is missing.
        return 0.0;
    };
    let mut taylor = Taylor::new(linear.operators(), 1.0);
    let trial = TRIAL_STEPS * taylor.longest_step();
    if trial == 0.0 {
        return f64::INFINITY;
    }
    if trial.is_infinite() {
        return 0.0;
    }
    let mut state = simulation.initial_state().clone();
    let before = thread_cpu_time();
    taylor.advance(&mut state, trial, |_| {});
    SOLUTIONS * (thread_cpu_time() - before).as_secs_f64() / trial
}
