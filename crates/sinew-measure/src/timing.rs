//! The cost of a run: its median time over repeats, by the clock that its method names.

use std::time::Duration;

use serde::{Deserialize, Serialize};
use sinew_core::{Integrator, Run, SimulateError, State, System, simulate};

use crate::cpu_time::CostSince;

/// The number of repetitions and the time for measuring the cost of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Effort {
    /// Intended number of repetitions, whose median counts: fewer if they would exceed the budget, but always one; more
    /// if they take less than a quarter of it. With 0, nothing is timed.
    pub repeats: usize,
    /// CPU time (s) after which no further repetition starts.
    pub budget: f64,
}

impl Effort {
    /// Effort for results to be shown.
    pub const FULL: Self = Self {
        repeats: 5,
        budget: 0.06,
    };
    /// Effort for checks that everything runs.
    pub const QUICK: Self = Self {
        repeats: 1,
        budget: 0.05,
    };
    /// No timing: the row's times are 0, and only error and verdicts count.
    pub const UNTIMED: Self = Self {
        repeats: 0,
        budget: 0.0,
    };
}

/// Median time (s) of the run, by the clock that the integrator names.
pub(crate) fn time_run(
    system: &dyn System,
    integrator: &mut dyn Integrator,
    start: &State,
    run: &Run,
    steps: usize,
    effort: Effort,
) -> Result<f64, SimulateError> {
    let run = Run { steps, ..*run };
    let mut state = start.clone();
    median_time(effort, |runs| {
        let before = CostSince::now();
        for _ in 0..runs {
            state.clone_from(start);
            simulate(system, integrator, &mut state, &run, &mut ())?;
        }
        Ok(before.elapsed(integrator.cost_clock()))
    })
}

/// Median time (s) of a run, from a function that returns the time of several consecutive runs.
fn median_time<E>(
    effort: Effort,
    mut batch: impl FnMut(u32) -> Result<Duration, E>,
) -> Result<f64, E> {
    // Long enough that neither the clock's resolution nor its cost shows.
    const LONG_ENOUGH: Duration = Duration::from_millis(2);
    const MOST_RUNS: u32 = 1 << 16;
    if effort.repeats == 0 {
        return Ok(0.0);
    }
    let mut runs = 1;
    let mut time = batch(runs)?;
    let mut spent = time;
    while time < LONG_ENOUGH && runs < MOST_RUNS {
        runs *= 2;
        time = batch(runs)?;
        spent += time;
    }
    let mut times = vec![time];
    let enough = |times: &[Duration], spent: Duration| {
        let spent = spent.as_secs_f64();
        spent > effort.budget || times.len() >= effort.repeats && spent >= effort.budget / 4.0
    };
    while !enough(&times, spent) {
        time = batch(runs)?;
        spent += time;
        times.push(time);
    }
    times.sort_unstable();
    Ok(times[times.len() / 2].as_secs_f64() / f64::from(runs))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The batches for runs that take `run` each, and the time of a run according to them.
    fn batches(effort: Effort, run: Duration) -> (Vec<u32>, f64) {
        let mut batches = Vec::new();
        let time: Result<f64, ()> = median_time(effort, |runs| {
            batches.push(runs);
            Ok(runs * run)
        });
        (batches, time.unwrap())
    }

    const FIVE: Effort = Effort {
        repeats: 5,
        budget: 0.06,
    };

    #[test]
    fn as_many_repeats_are_made_as_were_asked_for() {
        let (made, time) = batches(FIVE, Duration::from_millis(4));
        assert_eq!(made, [1; 5]);
        assert!((time - 4e-3).abs() < 1e-12, "{time}");
    }

    #[test]
    fn no_repeat_is_begun_once_the_budget_is_spent_but_one_run_is_always_timed() {
        assert_eq!(batches(FIVE, Duration::from_millis(25)).0, [1; 3]);
        assert_eq!(batches(FIVE, Duration::from_secs(3)), (vec![1], 3.0));
    }

    #[test]
    fn short_runs_are_timed_together_and_repeated_for_a_quarter_of_the_budget() {
        // 2 ms are 2^5 runs; 1 + 2 + .. + 32 of them take 3.94 ms of the 15.
        let (made, time) = batches(FIVE, Duration::from_nanos(62_500));
        assert_eq!(made[..6], [1, 2, 4, 8, 16, 32]);
        assert_eq!(made[5..], [32; 7]);
        assert!((time - 62.5e-6).abs() < 1e-12, "{time}");
    }

    #[test]
    fn without_repeats_nothing_is_run() {
        assert_eq!(
            batches(Effort::UNTIMED, Duration::from_secs(1)),
            (vec![], 0.0)
        );
    }
}
