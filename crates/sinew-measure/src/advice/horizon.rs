//! The part of a scene that pilots can follow in the time they have.

use sinew_core::spectrum::Spectrum;
use sinew_scene::Simulation;

use super::error::AdviceError;
use crate::case::{Span, course};
use crate::cpu_time::thread_cpu_time;
use crate::reference::{Course, Expansion, Pace, Taylor, cost_of_extrapolation};

/// The reference is solved twice, the second time with two thirds of the step: 1 + 3/2 solutions.
const SOLUTIONS: f64 = 2.5;

/// A reference by Faber series is checked over a fifth of the time, at thrice the cost.
const SOLUTIONS_BY_FABER: f64 = 1.6;

/// Steps of the reference whose cost is measured.
const TRIAL_STEPS: f64 = 4.0;

/// Number of instants of the comparison if not even one interval of the scene can be followed.
const INSTANTS: usize = 10;

/// Smallest representative share of an interval.
const SMALLEST_SHARE: f64 = 1e-3;

/// The part of a scene that is followed, from t = 0 on, and its method.
#[derive(Clone, Copy, Debug)]
pub(super) struct Horizon {
    pub(super) span: Span,
    pub(super) pace: Pace,
}

/// The longest part of a scene whose reference takes at most `seconds` of CPU time: the whole scene, with long steps if
/// the full reference takes longer; or some of its intervals; or a whole fraction of the first interval.
pub(super) fn horizon(simulation: &Simulation, seconds: f64) -> Result<Horizon, AdviceError> {
    let whole = Span::of(simulation);
    let cost = ReferenceCost::new(simulation);
    if seconds >= whole.duration * cost.per_second(Pace::Short) {
        return Ok(Horizon {
            span: whole,
            pace: Pace::Short,
        });
    }
    Ok(Horizon {
        span: longest_part(whole, seconds, cost.per_second(Pace::Long))?,
        pace: Pace::Long,
    })
}

/// The longest part that takes at most `seconds` of CPU time at a cost (CPU s per simulated s).
fn longest_part(whole: Span, seconds: f64, cost: f64) -> Result<Span, AdviceError> {
    let affordable = seconds / cost;
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

/// Estimate of a reference's cost from its first steps.
struct ReferenceCost<'a> {
    simulation: &'a Simulation,
    spectrum: Option<Spectrum>,
}

impl<'a> ReferenceCost<'a> {
    fn new(simulation: &'a Simulation) -> Self {
        let linear = simulation.system().as_linear();
        Self {
            simulation,
            spectrum: linear.map(|linear| Spectrum::of(linear.operators())),
        }
    }

    /// CPU time (s) per simulated second of a checked reference at a pace.
    fn per_second(&self, pace: Pace) -> f64 {
        let linear = self.simulation.system().as_linear();
        let (Some(linear), Some(spectrum)) = (linear, &self.spectrum) else {
            let interval = Span::of(self.simulation).interval();
            let (system, start) = (self.simulation.system(), self.simulation.initial_state());
            return cost_of_extrapolation(system, start, interval);
        };
        let mut state = self.simulation.initial_state().clone();
        match course(self.simulation, pace) {
            Course::Taylor(pace) => {
                let refinement = pace.refinement();
                let mut taylor = Taylor::within(linear.operators(), spectrum, refinement);
                let trial = TRIAL_STEPS * taylor.longest_step();
                if trial == 0.0 {
                    return f64::INFINITY;
                }
                if trial.is_infinite() {
                    return 0.0;
                }
                let before = thread_cpu_time();
                taylor.advance(&mut state, trial, |_| {});
                SOLUTIONS * (thread_cpu_time() - before).as_secs_f64() / trial
            }
            // Only force laws are followed so, which have gone above.
            Course::Extrapolated => 0.0,
            Course::Faber => {
                let mut expansion = Expansion::new(linear.operators(), spectrum, f64::INFINITY);
                let trial = expansion.longest_step();
                let before = thread_cpu_time();
                expansion.step(&mut state, &[trial], |_, _| {});
                // A breakpoint may have ended the step.
                let spent = (thread_cpu_time() - before).as_secs_f64();
                SOLUTIONS_BY_FABER * spent / state.t()
            }
        }
    }
}
