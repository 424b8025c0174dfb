//! Domains of definition of laws, fibres and memory.

use sinew_core::EvaluationError;
use sinew_sparse::simd::{Number, Real};

use super::chunks::LANES;
use super::error::{fibres_refused, memory_refused, refused};
use super::fibres::RegionFibres;
use super::kept::lanes;
use super::memory::Relaxing;
use crate::hyperelastic::{Deformation, HyperelasticLaw, SMALLEST_VOLUME_RATIO};

/// Refuses tetrahedra or means side by side for which a law is not defined, or which are not finite; `tag` names that of a lane.
#[inline(always)]
pub(super) fn require_law<L: HyperelasticLaw, N: Number>(
    law: &L,
    deformation: &Deformation<N>,
    tag: impl Fn(usize) -> u64,
) -> Result<(), EvaluationError> {
    let (ratio, largest) = (deformation.volume_ratio, N::Real::LARGEST);
    if N::all_le(N::of(least::<L>(largest)), ratio) && N::all_le(ratio, N::of(largest)) {
        return Ok(());
    }
    Err(refused_among(law, &lanes(ratio), tag))
}

/// [`require_law`] for fibres.
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
    let lane = first_below(&ratios);
    Err(fibres_refused(tag(lane), ratios[lane]))
}

/// [`require_law`] for memory.
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
    let lane = first_below(&ratios);
    Err(memory_refused(tag(lane), ratios[lane]))
}

/// The smallest volume ratio that a law is defined for, of numbers of this size.
const fn least<L: HyperelasticLaw>(largest: f64) -> f64 {
    if L::DEFINED_WHEN_INVERTED {
        -largest
    } else {
        SMALLEST_VOLUME_RATIO
    }
}

/// The error for the first lane that a law is not defined for.
#[cold]
#[inline(never)]
fn refused_among<L: HyperelasticLaw>(
    law: &L,
    ratios: &[f64; LANES],
    tag: impl Fn(usize) -> u64,
) -> EvaluationError {
    let is_refused = |ratio: &f64| !(least::<L>(f64::MAX)..=f64::MAX).contains(ratio);
    let lane = ratios.iter().position(is_refused).unwrap_or(0);
    refused(law.id(), tag(lane), ratios[lane])
}

/// The first lane of these volume ratios that is not above 0.
#[cold]
#[inline(never)]
fn first_below(ratios: &[f64; LANES]) -> usize {
    let is_below = |ratio: &f64| ratio.is_nan() || *ratio < SMALLEST_VOLUME_RATIO;
    ratios.iter().position(is_below).unwrap_or(0)
}
