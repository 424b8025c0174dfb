//! Simulated time against the time on the wall.

use std::time::{Duration, Instant};

/// Time (s) by which the simulation may be behind its next step before that time is given up.
const GIVEN_UP: f64 = 0.05;

/// Time (s) over which the pace is a mean.
const MEAN_OVER: f64 = 1.0;

/// Keeps simulated time at that of the wall. What a simulation cannot follow is dropped, and shows as a pace below 1: the step never
/// grows instead.
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

    /// The simulated time (s) that it should be now.
    pub(crate) fn target(&self) -> f64 {
        self.t + self.since.elapsed().as_secs_f64()
    }

    /// Time until simulated time should be `t` (s).
    pub(crate) fn until(&self, t: f64) -> Duration {
        Duration::try_from_secs_f64(t - self.target()).unwrap_or_default()
    }

    /// Records the simulated time (s), and drops a delay that cannot be caught up. A next step of `tick` (s) is not
    /// due before that time has gone by.
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

    /// Simulated time over the time on the wall, the mean of the last second.
    pub(crate) fn mean(&self) -> f64 {
        self.mean
    }
}
