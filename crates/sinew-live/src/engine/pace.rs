//! Simulated time relative to wall time.

use std::time::{Duration, Instant};

/// Largest delay (s) of the next step; a longer delay is discarded.
const GIVEN_UP: f64 = 0.05;

/// Time (s) over which the pace is a mean.
const MEAN_OVER: f64 = 1.0;

/// Synchronises simulated time with wall time. If a simulation is too slow, the lost time is discarded and the pace is
/// below 1; the step is never increased.
#[derive(Debug)]
pub(crate) struct Pace {
    /// Instant at which simulated time was `t`.
    since: Instant,
    t: f64,
    /// Beginning of the mean.
    mean_from: (Instant, f64),
    mean: f64,
}

impl Pace {
    pub(crate) fn new(t: f64) -> Self {
        let now = Instant::now();
        Self {
            since: now,
            t,
            mean_from: (now, t),
            mean: 1.0,
        }
    }

    /// The current target of the simulated time (s).
    pub(crate) fn target(&self) -> f64 {
        self.t + self.since.elapsed().as_secs_f64()
    }

    /// Time until simulated time should be `t` (s).
    pub(crate) fn until(&self, t: f64) -> Duration {
        Duration::try_from_secs_f64(t - self.target()).unwrap_or_default()
    }

    /// Records the simulated time (s), and discards a delay that cannot be recovered. The next step of `tick` (s) is
    /// not due before that time has passed.
    pub(crate) fn note(&mut self, t: f64, tick: f64) {
        if self.target() - t > tick + GIVEN_UP {
            (self.since, self.t) = (Instant::now(), t);
        }
        let (from, begun) = self.mean_from;
        let span = from.elapsed().as_secs_f64();
        if span >= MEAN_OVER {
            self.mean = (t - begun) / span;
            self.mean_from = (Instant::now(), t);
        }
    }

    /// Simulated time over wall time, the mean of the last second.
    pub(crate) fn mean(&self) -> f64 {
        self.mean
    }
}
