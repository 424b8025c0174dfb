//! Internal forces and the energy behind them.

use sinew_core::{Deformed, EvaluationError};

use super::error::refused;
use super::region::HyperelasticRegion;
use super::scratch::Scratch;
use crate::hyperelastic::{Bulk, HyperelasticLaw, LawVisitor, Point};

/// Writes the forces at the corners of a region's tetrahedra and adds to what is found.
pub(super) fn evaluate<const ENERGY: bool>(
    region: &HyperelasticRegion,
    scratch: &mut Scratch,
    found: &mut Deformed,
) -> Result<(), EvaluationError> {
    region.law.with_law(Forces::<ENERGY> {
        region,
        scratch,
        found,
    })
}

struct Forces<'a, const ENERGY: bool> {
    region: &'a HyperelasticRegion,
    scratch: &'a mut Scratch,
    found: &'a mut Deformed,
}

impl<const ENERGY: bool> LawVisitor for Forces<'_, ENERGY> {
    type Output = Result<(), EvaluationError>;

    fn visit<L: HyperelasticLaw>(self, law: L) -> Self::Output {
        if self.region.is_smoothed() {
            self.smoothed(law)
        } else {
            self.plain(law)
        }
    }
}

impl<const ENERGY: bool> Forces<'_, ENERGY> {
    fn plain<L: HyperelasticLaw>(self, law: L) -> Result<(), EvaluationError> {
        let rest = &self.region.rest;
        let corners = self.scratch.corners[self.region.first..].iter_mut();
        for (tet, corners) in (0..rest.count()).zip(corners) {
            let at = law.at(rest.gradient_of::<f64>(tet, &self.scratch.displacement));
            note(self.found, at.volume_ratio, rest.tag(tet));
            check(&law, &at, rest.tag(tet))?;
            if ENERGY {
                self.found.energy += rest.volume(tet) * law.whole_energy(&at);
            }
            let stress = law.stress_with(&at, law.own_bulk(&at));
            rest.forces(tet, stress, corners);
        }
        Ok(())
    }

    fn smoothed<L: HyperelasticLaw>(self, law: L) -> Result<(), EvaluationError> {
        let Self {
            region,
            scratch,
            found,
        } = self;
        let (rest, lambda) = (&region.rest, law.lame().0);
        means(region, scratch, &law)?;
        if ENERGY {
            for (patch, [dilation, _]) in (0..region.patches.count()).zip(&scratch.dilations) {
                let volume = region.volume_of(region.patches.of(patch));
                found.energy += 0.5 * volume * lambda * dilation * dilation;
            }
        }
        for edge in 0..region.edges.count() {
            let tets = region.edges.of(edge);
            let at = at_edge(region, &law, tets, scratch)?;
            scratch.at_edges[edge] = law.stress(&at);
            if ENERGY {
                let volume = region.volume_of(tets) / 6.0;
                found.energy += region.edge_share * volume * law.energy(&at);
            }
        }
        let own_share = 1.0 - region.edge_share;
        let corners = scratch.corners[region.first..].iter_mut();
        for (tet, corners) in (0..rest.count()).zip(corners) {
            let at = law.at(scratch.gradients[tet]);
            note(found, at.volume_ratio, rest.tag(tet));
            if ENERGY {
                found.energy += own_share * rest.volume(tet) * law.energy(&at);
            }
            let [dilation, _] = scratch.dilations[region.patch_of[tet] as usize];
            let mut stress = law.stress(&at).scaled(own_share);
            stress = stress.plus(lambda * dilation, law.dilation_gradient(&at));
            for edge in region.edges_of.get(tet).into_iter().flatten() {
                stress = stress.plus(region.edge_share / 6.0, scratch.at_edges[*edge as usize]);
            }
            rest.forces(tet, stress, corners);
        }
        Ok(())
    }
}

/// Takes the gradient of the displacement in each tetrahedron and the mean dilation of each patch.
pub(super) fn means<L: HyperelasticLaw>(
    region: &HyperelasticRegion,
    scratch: &mut Scratch,
    law: &L,
) -> Result<(), EvaluationError> {
    for patch in 0..region.patches.count() {
        let tets = region.patches.of(patch);
        let (mut sum, mut volumes) = (0.0, 0.0);
        for tet in tets {
            let tet = *tet as usize;
            let gradient = region.rest.gradient_of::<f64>(tet, &scratch.displacement);
            scratch.gradients[tet] = gradient;
            let at = law.at(gradient);
            check(law, &at, region.rest.tag(tet))?;
            let volume = region.rest.volume(tet);
            sum += volume * law.dilation(&at);
            volumes += volume;
        }
        scratch.dilations[patch] = [sum / volumes, 0.0];
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

#[inline(always)]
fn note(found: &mut Deformed, volume_ratio: f64, tag: u64) {
    if volume_ratio <= 0.0 {
        found.inverted += 1;
    }
    if volume_ratio < found.smallest_volume_ratio {
        found.smallest_volume_ratio = volume_ratio;
        found.worst_element = Some(tag);
    }
}
