//! Means over patches and edges, one by one, as tangents take them.

use sinew_core::EvaluationError;

use super::error::{fibres_refused, refused};
use super::memory::{Relaxing, require};
use super::region::HyperelasticRegion;
use super::scratch::Scratch;
use crate::hyperelastic::{HyperelasticLaw, Point};
use crate::smoothing::Average;

/// Takes the gradient of the displacement in each tetrahedron and the mean dilation of each patch.
pub(super) fn means<L: HyperelasticLaw>(
    region: &HyperelasticRegion,
    scratch: &mut Scratch,
    law: &L,
    relaxing: &Relaxing<'_>,
) -> Result<(), EvaluationError> {
    for patch in 0..region.patches.count() {
        let tets = region.patches.of(patch);
        let mut sum = 0.0;
        for tet in tets {
            let tet = *tet as usize;
            let gradient = region.rest.gradient_of::<f64>(tet, &scratch.displacement);
            scratch.gradients[tet] = gradient;
            let at = law.at(gradient);
            check(region, law, relaxing, &at, tet)?;
            sum += region.rest.volume(tet) * law.dilation(&at);
        }
        scratch.dilations[patch] = [sum / region.patch_volumes[patch], 0.0];
    }
    Ok(())
}

/// The mean deformation at an edge with these tetrahedra.
#[inline(always)]
pub(super) fn at_edge<L: HyperelasticLaw>(
    region: &HyperelasticRegion,
    law: &L,
    tets: &[u32],
    scratch: &Scratch,
    relaxing: &Relaxing<'_>,
) -> Result<Point<f64, L::Own<f64>>, EvaluationError> {
    let at = law.at(region.mean_tensor(tets, |tet| scratch.gradients[tet]));
    let first = || tets.first().map_or(0, |tet| region.rest.tag(*tet as usize));
    if !is_defined(law, &at) {
        return Err(refused::<L>(first(), at.volume_ratio));
    }
    require(relaxing, &at.deformation, |_| first())?;
    Ok(at)
}

/// Takes the derivative of a patch's mean dilation by the displacement of each of its nodes, in the place of a mean gradient.
pub(super) fn take_dilation<L: HyperelasticLaw>(
    region: &HyperelasticRegion,
    law: &L,
    patch: usize,
    scratch: &Scratch,
    out: &mut Average,
) {
    out.of(region.patches.of(patch).iter().map(|tet| {
        let tet = *tet as usize;
        let normal = law.dilation_gradient(&law.at(scratch.gradients[tet]));
        let (nodes, volume, gradients) = region.tet(tet);
        (nodes, volume, gradients.map(|gradient| normal.on(gradient)))
    }));
}

/// Refuses a tetrahedron that the law or the fibres are not defined for.
#[inline(always)]
pub(super) fn check<L: HyperelasticLaw>(
    region: &HyperelasticRegion,
    law: &L,
    relaxing: &Relaxing<'_>,
    at: &Point<f64, L::Own<f64>>,
    tet: usize,
) -> Result<(), EvaluationError> {
    if !is_defined(law, at) {
        return Err(refused::<L>(region.rest.tag(tet), at.volume_ratio));
    }
    require(relaxing, &at.deformation, |_| region.rest.tag(tet))?;
    match &region.fibres {
        Some(fibres) if !fibres.admits(&at.deformation) => {
            Err(fibres_refused(region.rest.tag(tet), at.volume_ratio))
        }
        _ => Ok(()),
    }
}

#[inline(always)]
fn is_defined<L: HyperelasticLaw>(law: &L, at: &Point<f64, L::Own<f64>>) -> bool {
    law.admits(&at.deformation) && at.volume_ratio.is_finite()
}
