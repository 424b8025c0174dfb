//! A histogram of durations.

use std::fmt::{self, Debug};

/// Durations of at least this many microseconds are counted as one.
const MOST: usize = 20_000;

/// A histogram of durations by microsecond, in memory of fixed size.
#[derive(Clone)]
pub struct Jitter {
    counts: Vec<u64>,
    all: u64,
    longest: f64,
}

impl Default for Jitter {
    fn default() -> Self {
        Self {
            counts: vec![0; MOST + 1],
            all: 0,
            longest: 0.0,
        }
    }
}

impl Debug for Jitter {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Jitter")
            .field("all", &self.all)
            .field("p50", &self.quantile(0.5))
            .field("p99", &self.quantile(0.99))
            .field("longest", &self.longest)
            .finish()
    }
}

impl Jitter {
    /// Counts a duration (s).
    pub(crate) fn count(&mut self, duration: f64) {
        self.counts[((1e6 * duration) as usize).min(MOST)] += 1;
        self.all += 1;
        self.longest = self.longest.max(duration);
    }

    /// Number of durations.
    #[must_use]
    pub fn all(&self) -> u64 {
        self.all
    }

    /// The longest (s).
    #[must_use]
    pub fn longest(&self) -> f64 {
        self.longest
    }

    /// The duration (s) that this share of all do not exceed, to a microsecond and at most 20 ms.
    #[must_use]
    pub fn quantile(&self, share: f64) -> f64 {
        let wanted = (share * self.all as f64).ceil() as u64;
        let mut seen = 0;
        let place = self.counts.iter().position(|count| {
            seen += count;
            seen >= wanted
        });
        let micros = place.map_or(MOST, |place| place + 1);
        (1e-6 * micros as f64).min(self.longest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_what_was_counted() {
        let mut jitter = Jitter::default();
        assert_eq!(jitter.quantile(0.99), 0.0);
        for micros in 0..1000 {
            jitter.count(1e-6 * (f64::from(micros) + 0.5));
        }
        jitter.count(1.0);
        let is = |share: f64, expected: f64| (jitter.quantile(share) - expected).abs() < 1e-12;
        assert!(is(0.5, 501e-6) && is(0.99, 991e-6) && is(1.0, 0.020_001));
        assert_eq!((jitter.all(), jitter.longest()), (1001, 1.0));
    }
}
