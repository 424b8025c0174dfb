//! Means over patches and edges, as tangents take them.

use sinew_core::EvaluationError;
use sinew_sparse::simd::Number;

use super::axes::Place;
use super::chunks::LANES;
use super::defined::{require_fibres, require_law, require_memory};
use super::evaluator::{Evaluator, Untyped};
use super::kept::{Rows, load, no_rows, store};
use super::memory::Relaxing;
use super::region::HyperelasticRegion;
use super::scratch::Scratch;
use crate::hyperelastic::{LawAt, Tensor};
use crate::smoothing::Average;

/// Takes the gradient of the displacement in each tetrahedron and the mean dilation of each patch; with those of the change, where it is
/// asked for.
#[inline(always)]
pub(super) fn means<N: Number<Real = f64>, E: Evaluator<N> + ?Sized>(
    region: &HyperelasticRegion,
    scratch: &mut Scratch,
    law: &mut E,
    relaxing: &Relaxing<'_>,
    with_change: bool,
) -> Result<(), EvaluationError> {
    let rest = &region.rest;
    for first in (0..rest.count()).step_by(N::LANES) {
        let side_by_side = first..first + N::LANES;
        let gradient = rest.gradient_of::<N>(first, &scratch.displacement);
        store(gradient, &mut scratch.gradients[side_by_side.clone()]);
        let at = law.at(gradient, region.axes.as_ref(), Place::Tets(first));
        let at = &*at;
        require(at, region, relaxing, first)?;
        let [dilations, changes] = &mut scratch.dilations_of_tets;
        let volume = rest.volumes::<N>(first);
        (volume * at.dilation()).store(&mut dilations[first..]);
        if with_change {
            let change = rest.gradient_of::<N>(first, &scratch.change);
            store(change, &mut scratch.changes[side_by_side]);
            let change = at.dilation_gradient().contracted(change);
            (volume * change).store(&mut changes[first..]);
        }
    }
    let mean = |patch: usize, of_tets: &[f64]| {
        let tets = region.patches.of(patch).iter();
        let sum: f64 = tets.map(|tet| of_tets[*tet as usize]).sum();
        sum / region.patch_volumes[patch]
    };
    let [dilations, changes] = &scratch.dilations_of_tets;
    for (patch, means) in (0..region.patches.count()).zip(&mut scratch.dilations) {
        let change = if with_change {
            mean(patch, changes)
        } else {
            0.0
        };
        *means = [mean(patch, dilations), change];
    }
    Ok(())
}

/// The mean deformation at edges side by side.
#[inline(always)]
pub(super) fn at_edges<'e, N: Number<Real = f64>, E: Evaluator<N> + ?Sized>(
    region: &HyperelasticRegion,
    law: &'e mut E,
    first: usize,
    gradients: &[Rows<f64>],
    relaxing: &Relaxing<'_>,
) -> Result<E::Ref<'e>, EvaluationError> {
    let gradient = mean_at_edges::<N>(region, first, gradients);
    let at = law.at(gradient, region.axes.as_ref(), Place::Means);
    let tag = |lane: usize| {
        let tets = region.edges.of(region.edge_at(first + lane));
        tets.first().map_or(0, |tet| region.rest.tag(*tet as usize))
    };
    require_law(&*at, tag)?;
    require_memory(relaxing, at.deformation(), tag)?;
    Ok(at)
}

/// The mean of tensors over the tetrahedra at edges side by side.
#[inline(always)]
pub(super) fn mean_at_edges<N: Number<Real = f64>>(
    region: &HyperelasticRegion,
    first: usize,
    of_tets: &[Rows<f64>],
) -> Tensor<N> {
    let mut sums = [no_rows(); LANES];
    for (lane, sum) in sums.iter_mut().enumerate().take(N::LANES) {
        for tet in region.edges.of(region.edge_at(first + lane)) {
            let volume = region.rest.volume(*tet as usize);
            add(sum, volume, &of_tets[*tet as usize]);
        }
    }
    let volumes = N::from_lanes(|lane| region.edge_volumes[region.edge_at(first + lane)]);
    load::<N>(&sums).scaled(volumes.recip())
}

/// `sum += factor tensor`.
#[inline(always)]
pub(super) fn add(sum: &mut Rows<f64>, factor: f64, tensor: &Rows<f64>) {
    let entries = sum.as_flattened_mut().iter_mut();
    for (sum, entry) in entries.zip(tensor.as_flattened()) {
        *sum += factor * entry;
    }
}

/// Takes the derivative of a patch's mean dilation by the displacement of each of its nodes, in the place of a mean gradient.
pub(super) fn take_dilation(
    region: &HyperelasticRegion,
    law: &(dyn Untyped + '_),
    patch: usize,
    scratch: &Scratch,
    out: &mut Average,
) {
    out.of(region.patches.of(patch).iter().map(|tet| {
        let tet = *tet as usize;
        let (_, normal) = law.dilation(scratch.gradient(tet));
        let (nodes, volume, gradients) = region.tet(tet);
        (nodes, volume, gradients.map(|gradient| normal.on(gradient)))
    }));
}

/// Refuses tetrahedra side by side that the law, the fibres or the memory are not defined for.
#[inline(always)]
pub(super) fn require<N: Number, A: LawAt<N> + ?Sized>(
    at: &A,
    region: &HyperelasticRegion,
    relaxing: &Relaxing<'_>,
    first: usize,
) -> Result<(), EvaluationError> {
    let tag = |lane: usize| region.rest.tag(first + lane);
    require_law(at, tag)?;
    require_memory(relaxing, at.deformation(), tag)?;
    require_fibres(&region.fibres, at.deformation(), tag)
}
