//! Domains of definition of laws, fibres and memory.

use std::ops::RangeInclusive;

use sinew_core::EvaluationError;
use sinew_sparse::simd::{Number, Real};

use super::chunks::LANES;
use super::error::{
    fibres_refused, limit_of_fibres_reached, limit_reached, memory_refused, refused,
};
use super::fibres::RegionFibres;
use super::kept::lanes;
use super::memory::Relaxing;
use crate::hyperelastic::{Deformation, LawAt, SMALLEST_MARGIN, SMALLEST_VOLUME_RATIO};

/// Refuses tetrahedra or means side by side for which a law is not defined, or which are not finite; `tag` names that of a lane.
#[inline(always)]
pub(super) fn require_law<N: Number, A: LawAt<N> + ?Sized>(
    at: &A,
    tag: impl Fn(usize) -> u64,
) -> Result<(), EvaluationError> {
    let ratio = at.deformation().volume_ratio;
    let largest = N::Real::LARGEST;
    let least = match at.is_defined_when_inverted() {
        true => -largest,
        false => SMALLEST_VOLUME_RATIO,
    };
    if !(N::all_le(N::of(least), ratio) && N::all_le(ratio, N::of(largest))) {
        let ratios = lanes(ratio);
        let lane = first_outside(least..=largest, &ratios);
        return Err(refused(at.id(), tag(lane), ratios[lane]));
    }
    if at.is_within_limit() {
        return Ok(());
    }
    let lane = first_outside(SMALLEST_MARGIN..=f64::INFINITY, &lanes(at.margin()));
    let limit = at.limit().unwrap_or_default();
    Err(limit_reached(at.id(), limit, tag(lane)))
}

/// Same as [`require_law`], for fibres.
#[inline(always)]
pub(super) fn require_fibres<N: Number>(
    fibres: &[RegionFibres],
    deformation: &Deformation<N>,
    tag: impl Fn(usize) -> u64,
) -> Result<(), EvaluationError> {
    if fibres.iter().all(|family| family.admits(deformation)) {
        return Ok(());
    }
    let ratios = lanes(deformation.volume_ratio);
    let lane = first_outside(SMALLEST_VOLUME_RATIO..=f64::INFINITY, &ratios);
    Err(fibres_refused(tag(lane), ratios[lane]))
}

/// Refuses tetrahedra side by side whose fibres are beyond their limit, by the least margin of all families.
#[inline(always)]
pub(super) fn require_limit_of_fibres<N: Number>(
    margin: N,
    tag: impl Fn(usize) -> u64,
) -> Result<(), EvaluationError> {
    if N::all_le(N::of(0.0), margin) {
        return Ok(());
    }
    let lane = first_outside(0.0..=f64::INFINITY, &lanes(margin));
    Err(limit_of_fibres_reached(tag(lane)))
}

/// Same as [`require_law`], for memory.
#[inline(always)]
pub(super) fn require_memory<N: Number, T: Real>(
    relaxing: &Relaxing<'_, T>,
    deformation: &Deformation<N>,
    tag: impl Fn(usize) -> u64,
) -> Result<(), EvaluationError> {
    if relaxing.admits(deformation) {
        return Ok(());
    }
    let ratios = lanes(deformation.volume_ratio);
    let lane = first_outside(SMALLEST_VOLUME_RATIO..=f64::INFINITY, &ratios);
    Err(memory_refused(tag(lane), ratios[lane]))
}

/// The first lane that is not in a range.
#[cold]
#[inline(never)]
fn first_outside(range: RangeInclusive<f64>, lanes: &[f64; LANES]) -> usize {
    let is_outside = |number: &f64| !range.contains(number);
    lanes.iter().position(is_outside).unwrap_or(0)
}
