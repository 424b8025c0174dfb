//! Evaluations of forces that threads share.

#![allow(unsafe_code, reason = "a kernel; ARCHITECTURE.md names it")]

use std::sync::Arc;

use sinew_core::EvaluationError;
use sinew_sparse::simd::{InstructionSet, Shared, SharedSlice};

use super::compiled::Precision;
use super::force::Evaluation;
use super::memory::Past;
use super::region::Numbers;
use super::regions::{Regions, evaluate_alone, make};
use super::schedule::Schedule;
use super::scratch::Kept;

/// The forces of all hyperelastic regions in one precision, in parts that threads compute at the same time.
#[derive(Debug)]
pub(crate) struct SharedForces<T> {
    all: Arc<Regions>,
    /// Data of each region that loops read.
    numbers: Vec<Numbers<T>>,
    schedule: Arc<Schedule>,
    set: InstructionSet,
    kept: Kept<T>,
    sums: Shared<[T; 4]>,
}

impl<T: Precision> SharedForces<T> {
    pub(super) fn new(
        all: Arc<Regions>,
        numbers: Vec<Numbers<T>>,
        parts: usize,
        set: InstructionSet,
    ) -> Self {
        let schedule = all.schedule(parts);
        Self {
            numbers,
            set,
            kept: Kept::new(&all.regions, schedule.rooms(), parts),
            schedule,
            sums: Shared::filled([T::default(); 4], all.gather.nodes().len()),
            all,
        }
    }

    /// Number of passes.
    pub(crate) fn passes(&self) -> usize {
        self.schedule.passes().len()
    }

    fn evaluation<'a>(
        &'a self,
        schedule: &'a Schedule,
        kept: &'a Kept<T>,
        displacement: &'a [[T; 4]],
    ) -> Evaluation<'a, T> {
        Evaluation {
            regions: &self.all.regions,
            numbers: &self.numbers,
            gather: &self.all.gather,
            rooms: schedule.rooms(),
            places: kept.places(displacement, self.sums.slice()),
            // Bodies with memory are not shared.
            past: Past::RELAXED,
            remembered: None,
            set: self.set,
            with_energy: false,
        }
    }

    /// Computes a part of a pass with the displacement (m) of all mesh nodes.
    ///
    /// # Safety
    /// Passes follow one another, each part of a pass is computed once, and no other code uses the sums during the
    /// call.
    pub(crate) unsafe fn make(
        &self,
        displacement: &[[T; 4]],
        pass: usize,
        part: usize,
    ) -> Result<(), EvaluationError> {
        let evaluation = self.evaluation(&self.schedule, &self.kept, displacement);
        let mut pieces = self.schedule.passes()[pass][part].iter();
        pieces.try_for_each(|piece| {
            // SAFETY: the caller's promise.
            unsafe { make(&self.all.laws, &evaluation, part, piece) }.map(|_| ())
        })
    }

    /// Computes everything in one part, so that errors do not depend on the parts.
    pub(crate) fn make_alone(&mut self, displacement: &[[T; 4]]) -> Result<(), EvaluationError> {
        let alone = self.all.alone();
        let kept = Kept::new(&self.all.regions, alone.rooms(), 1);
        // Nobody else uses what belongs to `self`.
        let evaluation = self.evaluation(alone, &kept, displacement);
        evaluate_alone(alone, &self.all.laws, &evaluation).map(|_| ())
    }

    /// The sums of the forces (N) at nodes, in the order of [`super::gather::Gather`].
    pub(crate) fn sums(&self) -> SharedSlice<'_, [T; 4]> {
        self.sums.slice()
    }
}
