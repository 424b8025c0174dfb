//! All hyperelastic regions of a body, and the order of work of one thread.

use std::sync::OnceLock;

use sinew_core::{Deformed, EvaluationError};
use sinew_sparse::simd::Vectors;

use super::force::Evaluation;
use super::gather::Gather;
use super::region::HyperelasticRegion;
use super::schedule::Schedule;

/// All regions, with the sums at their nodes.
#[derive(Debug)]
pub(super) struct Regions {
    pub(super) regions: Vec<HyperelasticRegion>,
    pub(super) gather: Gather,
    /// Made for the first evaluation: machines have schedules of their own.
    alone: OnceLock<Schedule>,
}

impl Regions {
    pub(super) fn new(regions: Vec<HyperelasticRegion>, gather: Gather) -> Self {
        Self {
            regions,
            gather,
            alone: OnceLock::new(),
        }
    }

    /// The order of work of one thread.
    pub(super) fn alone(&self) -> &Schedule {
        self.alone
            .get_or_init(|| Schedule::new(&self.regions, &self.gather, 1))
    }
}

/// Makes an evaluation, whose places nobody else uses meanwhile, by one thread.
#[allow(unsafe_code, reason = "a kernel; ARCHITECTURE.md names it")]
pub(super) fn evaluate_alone<T: Vectors>(
    schedule: &Schedule,
    evaluation: &Evaluation<'_, T>,
) -> Result<Deformed, EvaluationError> {
    let mut all = Deformed::default();
    for piece in schedule.passes().iter().flatten().flatten() {
        // SAFETY: the pieces of all passes, one after the other.
        let found = unsafe { evaluation.make(0, piece) }?;
        all.energy += found.energy;
        all.inverted += found.inverted;
        if found.smallest_volume_ratio < all.smallest_volume_ratio {
            all.smallest_volume_ratio = found.smallest_volume_ratio;
            all.worst_element = found.worst_element;
        }
    }
    Ok(all)
}
