//! Interval between two checks of a run: for progress, and for a request to stop.

use std::time::{Duration, Instant};

/// Wall time between two checks.
const LOOK: Duration = Duration::from_millis(40);

/// Number of steps between two checks of a run, for its progress and for a request to stop: several checks a
/// second for steps of any length.
#[derive(Debug, Clone, Copy)]
pub struct Pace {
    steps: usize,
    at: usize,
    looked: Instant,
}

impl Pace {
    /// A run that begins now, after `step` steps.
    #[must_use]
    pub fn new(step: usize) -> Self {
        Self {
            steps: 1,
            at: step,
            looked: Instant::now(),
        }
    }

    /// The step after which the next check is due.
    #[must_use]
    pub fn next(&self) -> usize {
        self.at.saturating_add(self.steps)
    }

    /// Records a check after a step.
    pub fn look(&mut self, step: usize) {
        let taken = step.saturating_sub(self.at);
        if taken > 0 {
            let each = self.looked.elapsed().as_secs_f64() / taken as f64;
            let fitting = LOOK.as_secs_f64() / each.max(1e-9);
            // Steps at the beginning are no measure of later ones.
            self.steps = (fitting as usize).clamp(1, 2 * self.steps);
        }
        (self.at, self.looked) = (step, Instant::now());
    }
}
