//! The goal of a search.

use serde::{Deserialize, Serialize};

use crate::row::Row;

/// The largest error and cost of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Goal {
    /// Largest relative error over the whole scene (fraction), to be expected where not all of it
    /// is compared.
    pub error: f64,
    /// Most CPU seconds per simulated second, set-up apart; infinite where cost is no matter.
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
