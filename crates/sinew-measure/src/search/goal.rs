//! The goal of a search.

use serde::{Deserialize, Serialize};

use crate::row::Row;

/// The largest error and cost of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Goal {
    /// Largest relative error over the whole scene (fraction), the expected one if only a part is compared.
    pub error: f64,
    /// Largest CPU time per simulated second (s), without set-up; infinite if cost does not matter.
    pub budget: f64,
}

impl Goal {
    /// An error at any cost.
    #[must_use]
    pub fn error(error: f64) -> Self {
        Self {
            error,
            budget: f64::INFINITY,
        }
    }

    /// True if a run meets the goal.
    #[must_use]
    pub fn is_met_by(self, row: &Row) -> bool {
        row.cpu_s_per_s <= self.budget
            && row
                .sound_error_over_scene()
                .is_some_and(|e| e <= self.error)
    }
}
