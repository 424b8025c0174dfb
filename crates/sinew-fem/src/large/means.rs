//! Means over patches and edges, one by one, as tangents take them.

use sinew_core::EvaluationError;

use super::error::refused;
use super::region::HyperelasticRegion;
use super::scratch::Scratch;
use crate::hyperelastic::{Bulk, HyperelasticLaw, Point};
use crate::smoothing::Average;

/// Takes the gradient of the displacement in each tetrahedron and the mean dilation of each patch.
pub(super) fn means<L: HyperelasticLaw>(
    region: &HyperelasticRegion,
    scratch: &mut Scratch,
    law: &L,
) -> Result<(), EvaluationError> {
    for patch in 0..region.patches.count() {
        let tets = region.patches.of(patch);
        let mut sum = 0.0;
        for tet in tets {
            let tet = *tet as usize;
            let gradient = region.rest.gradient_of::<f64>(tet, &scratch.displacement);
            scratch.gradients[tet] = gradient;
            let at = law.at(gradient);
            check(law, &at, region.rest.tag(tet))?;
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
) -> Result<Point<f64, L::Own<f64>>, EvaluationError> {
    let at = law.at(region.mean_tensor(tets, |tet| scratch.gradients[tet]));
    let first = tets.first().map_or(0, |tet| region.rest.tag(*tet as usize));
    check(law, &at, first)?;
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

/// The dilational energy of a tetrahedron by the mean of its patch, whose own modulus is added elsewhere.
#[inline(always)]
pub(super) fn bulk_of_patch(lambda: f64, dilation: f64) -> Bulk<f64> {
    Bulk {
        stress: lambda * dilation,
        modulus: 0.0,
    }
}

#[inline(always)]
pub(super) fn check<L: HyperelasticLaw>(
    law: &L,
    at: &Point<f64, L::Own<f64>>,
    tag: u64,
) -> Result<(), EvaluationError> {
    if law.admits(&at.deformation) && at.volume_ratio.is_finite() {
        Ok(())
    } else {
        Err(refused::<L>(tag, at.volume_ratio))
    }
}
