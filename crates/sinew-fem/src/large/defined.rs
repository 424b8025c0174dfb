//! Domains of definition of laws, fibres and memory.

use sinew_core::EvaluationError;
use sinew_sparse::simd::{Number, Real};

use super::chunks::LANES;
use super::error::{fibres_refused, limit_reached, memory_refused, refused};
use super::fibres::RegionFibres;
use super::kept::lanes;
use super::memory::Relaxing;
use crate::hyperelastic::{
    Deformation, HyperelasticLaw, Point, SMALLEST_MARGIN, SMALLEST_VOLUME_RATIO,
};

/// Refuses tetrahedra or means side by side for which a law is not defined, or which are not finite; `tag` names that of a lane.
#[inline(always)]
pub(super) fn require_law<L: HyperelasticLaw, N: Number>(
    law: &L,
    at: &Point<N, L::Own<N>>,
    tag: impl Fn(usize) -> u64,
) -> Result<(), EvaluationError> {
    let (ratio, largest) = (at.volume_ratio, N::Real::LARGEST);
    let is_of_size =
        N::all_le(N::of(least::<L>(largest)), ratio) && N::all_le(ratio, N::of(largest));
    if !is_of_size {
        return Err(refused_among(law, &lanes(ratio), tag));
    }
    if law.is_within_limit(at) {
        return Ok(());
    }
    Err(beyond_limit(law, &lanes(law.margin(at)), tag))
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

/// The error for the first lane that is beyond a law's limit.
#[cold]
#[inline(never)]
fn beyond_limit<L: HyperelasticLaw>(
    law: &L,
    margins: &[f64; LANES],
    tag: impl Fn(usize) -> u64,
) -> EvaluationError {
    let is_beyond = |margin: &f64| margin.is_nan() || *margin < SMALLEST_MARGIN;
    let lane = margins.iter().position(is_beyond).unwrap_or(0);
    limit_reached(law.id(), law.limit().unwrap_or_default(), tag(lane))
}

/// The first lane of these volume ratios that is not above 0.
#[cold]
#[inline(never)]
fn first_below(ratios: &[f64; LANES]) -> usize {
    let is_below = |ratio: &f64| ratio.is_nan() || *ratio < SMALLEST_VOLUME_RATIO;
    ratios.iter().position(is_below).unwrap_or(0)
}
