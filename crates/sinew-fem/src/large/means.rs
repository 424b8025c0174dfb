//! Means over patches and edges, for tangents.

use sinew_core::EvaluationError;
use sinew_sparse::simd::Number;

use super::axes::Place;
use super::defined::{require_fibres, require_law, require_memory};
use super::evaluator::{Evaluator, Untyped};
use super::kept::{Rows, load, no_rows, store};
use super::memory::Relaxing;
use super::region::HyperelasticRegion;
use super::scratch::Scratch;
use crate::hyperelastic::{LawAt, Tensor};
use crate::smoothing::Average;

/// Takes the gradient of the displacement in each tetrahedron and the mean dilation of each patch.
#[inline(always)]
pub(super) fn means<N: Number<Real = f64>, E: Evaluator<N> + ?Sized>(
    region: &HyperelasticRegion,
    scratch: &mut Scratch,
    law: &mut E,
    relaxing: &Relaxing<'_>,
) -> Result<(), EvaluationError> {
    let rest = &region.rest;
    for first in (0..rest.count()).step_by(N::LANES) {
        let gradient = rest.gradient_of::<N>(first, &scratch.displacement);
        store(gradient, &mut scratch.gradients[first..first + N::LANES]);
        let at = law.at(gradient, region.axes.as_ref(), Place::Tets(first));
        let at = &*at;
        require(at, region, relaxing, first)?;
        let volume = rest.volumes::<N>(first);
        (volume * at.dilation()).store(&mut scratch.dilations_of_tets[first..]);
    }
    for (patch, mean) in (0..region.patches.count()).zip(&mut scratch.dilations) {
        let tets = region.patches.of(patch).iter();
        let sum: f64 = tets
            .map(|tet| scratch.dilations_of_tets[*tet as usize])
            .sum();
        *mean = sum / region.patch_volumes[patch];
    }
    Ok(())
}

/// The law at the mean deformation of an edge, with the gradient in each tetrahedron.
pub(super) fn at_edge<'e>(
    region: &HyperelasticRegion,
    law: &'e mut (dyn Untyped + '_),
    edge: usize,
    gradients: &[Rows<f64>],
    relaxing: &Relaxing<'_>,
) -> Result<&'e dyn LawAt<f64>, EvaluationError> {
    let mut sum = no_rows();
    for tet in region.edges.of(edge) {
        let volume = region.rest.volume(*tet as usize);
        add(&mut sum, volume, &gradients[*tet as usize]);
    }
    let gradient = load::<f64>(&[sum]).scaled(region.edge_volumes[edge].recip());
    mean_at_edges(region, law, (edge, gradient), relaxing)
}

/// The law at the mean gradients of the displacement at edges side by side, from the `first` on.
#[inline(always)]
pub(super) fn mean_at_edges<'e, N: Number<Real = f64>, E: Evaluator<N> + ?Sized>(
    region: &HyperelasticRegion,
    law: &'e mut E,
    (first, gradient): (usize, Tensor<N>),
    relaxing: &Relaxing<'_>,
) -> Result<E::Ref<'e>, EvaluationError> {
    let at = law.at(gradient, region.axes.as_ref(), Place::Means);
    let tag = |lane: usize| {
        let tets = region.edges.of(region.edge_at(first + lane));
        tets.first().map_or(0, |tet| region.rest.tag(*tet as usize))
    };
    require_law(&*at, tag)?;
    require_memory(relaxing, at.deformation(), tag)?;
    Ok(at)
}

/// `sum += factor tensor`.
#[inline(always)]
pub(super) fn add(sum: &mut Rows<f64>, factor: f64, tensor: &Rows<f64>) {
    let entries = sum.as_flattened_mut().iter_mut();
    for (sum, entry) in entries.zip(tensor.as_flattened()) {
        *sum += factor * entry;
    }
}

/// Takes the derivative of a patch's mean dilation by the displacement of each of its nodes, instead of a mean
/// gradient.
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

/// Refuses tetrahedra side by side for which the law, the fibres or the memory are not defined.
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
