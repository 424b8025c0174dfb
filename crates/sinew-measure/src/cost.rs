//! Cost of a run: time, or work.

use serde::{Deserialize, Serialize};

use crate::row::Row;

/// Measure of the cost of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Cost {
    /// Measured CPU time of a run on this machine.
    #[default]
    CpuTime,
    /// Counted work at fixed prices: rough, but the same on every machine and in every repetition.
    Work,
}

/// Price (s) of a sweep over all cells.
const SWEEP: f64 = 1e-6;
/// Price (s) of a step in addition to its sweeps.
const STEP: f64 = 0.05 * SWEEP;
/// Price (s) of a solution by a factor, which has several times as many entries as the matrix.
const SOLUTION: f64 = 5.0 * SWEEP;
/// Price (s) of a factor.
const FACTORIZATION: f64 = 500.0 * SWEEP;

impl Cost {
    /// The row with its times replaced by the prices of its work, if cost is counted by work.
    pub(crate) fn charged(self, row: Row) -> Row {
        if self == Self::CpuTime {
            return row;
        }
        let steps = row.steps.max(1) as f64;
        let run = steps * STEP + row.work.sweeps as f64 * SWEEP + row.work.solves as f64 * SOLUTION;
        Row {
            cpu_s_per_s: run / (steps * row.dt),
            us_per_step: run / steps * 1e6,
            setup_cpu_s: row.work.factorizations as f64 * FACTORIZATION,
            ..row
        }
    }

    /// Lower bound of the cost (s) of a step with a sweep, if a sweep takes `sweep` (s) of CPU time.
    pub(crate) fn of_least_step(self, sweep: f64) -> f64 {
        match self {
            Self::CpuTime => sweep,
            Self::Work => SWEEP,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row::Work;

    #[test]
    fn work_has_the_same_price_whatever_the_clock_said() {
        let row = |cpu_s_per_s| Row {
            steps: 10,
            dt: 0.1,
            cpu_s_per_s,
            work: Work {
                sweeps: 20,
                factorizations: 1,
                ..Work::default()
            },
            ..Row::default()
        };
        let [slow, fast] = [1.0, 1e-3].map(|time| Cost::Work.charged(row(time)));
        assert_eq!(slow, fast);
        assert!((slow.cpu_s_per_s - 20.5e-6).abs() < 1e-18);
        assert!((slow.us_per_step - 2.05).abs() < 1e-12);
        assert!((slow.setup_cpu_s - 5e-4).abs() < 1e-18);
        assert_eq!(Cost::CpuTime.charged(row(0.5)), row(0.5));
    }
}
