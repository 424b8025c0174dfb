//! All hyperelastic regions of a body, and the order of work of one thread.

use std::sync::{Arc, OnceLock};

use sinew_core::{Deformed, EvaluationError};

use super::compiled::{Compiled, Precision};
use super::force::{Evaluation, Forces};
use super::gather::Gather;
use super::region::HyperelasticRegion;
use super::schedule::{Piece, Schedule};

/// All regions, with the sums at their nodes.
#[derive(Debug)]
pub(super) struct Regions {
    pub(super) regions: Vec<HyperelasticRegion>,
    /// The law of each.
    pub(super) laws: Vec<Arc<dyn Compiled>>,
    pub(super) gather: Gather,
    /// The order of work of one thread; made for the first evaluation by one thread.
    alone: OnceLock<Arc<Schedule>>,
}

impl Regions {
    pub(super) fn new(
        (regions, laws): (Vec<HyperelasticRegion>, Vec<Arc<dyn Compiled>>),
        gather: Gather,
    ) -> Self {
        Self {
            regions,
            laws,
            gather,
            alone: OnceLock::new(),
        }
    }

    /// The order of work of one thread.
    pub(super) fn alone(&self) -> &Arc<Schedule> {
        self.alone
            .get_or_init(|| Arc::new(Schedule::new(&self.regions, &self.gather, 1)))
    }

    /// The order of work of `parts` threads.
    pub(super) fn schedule(&self, parts: usize) -> Arc<Schedule> {
        match parts {
            0 | 1 => Arc::clone(self.alone()),
            parts => Arc::new(Schedule::new(&self.regions, &self.gather, parts)),
        }
    }
}

/// Does the tasks of a piece of a part with the law of its region, and returns their findings.
///
/// # Safety
/// The parts of a schedule of these regions are done pass by pass; other users of the places wait until they are done.
#[allow(unsafe_code, reason = "a kernel; ARCHITECTURE.md names it")]
pub(super) unsafe fn make<T: Precision>(
    laws: &[Arc<dyn Compiled>],
    evaluation: &Evaluation<'_, T>,
    part: usize,
    piece: &Piece,
) -> Result<Deformed, EvaluationError> {
    // SAFETY: the caller's promise.
    match unsafe { Forces::of(evaluation, part, piece) } {
        Some(forces) => T::forces(&*laws[piece.region], forces),
        None => Ok(Deformed::default()),
    }
}

/// Makes an evaluation by one thread. No other code uses its places during the call.
#[allow(unsafe_code, reason = "a kernel; ARCHITECTURE.md names it")]
pub(super) fn evaluate_alone<T: Precision>(
    schedule: &Schedule,
    laws: &[Arc<dyn Compiled>],
    evaluation: &Evaluation<'_, T>,
) -> Result<Deformed, EvaluationError> {
    let mut all = Deformed::default();
    for piece in schedule.passes().iter().flatten().flatten() {
        // SAFETY: the pieces of all passes, one after the other.
        let found = unsafe { make(laws, evaluation, 0, piece) }?;
        all.energy += found.energy;
        all.inverted += found.inverted;
        if found.smallest_volume_ratio < all.smallest_volume_ratio {
            all.smallest_volume_ratio = found.smallest_volume_ratio;
            all.worst_element = found.worst_element;
        }
    }
    Ok(all)
}
