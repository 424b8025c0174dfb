//! Stresses of deformed tetrahedra.

use super::force::means;
use super::region::HyperelasticRegion;
use super::scratch::Scratch;
use crate::hyperelastic::{HyperelasticLaw, LawVisitor, Tensor};

/// Calls `tell` with the place of each tetrahedron of a region and its Cauchy stress (Pa), `P F'/J`; not a number where
/// the law has no meaning.
pub(super) fn stresses(
    region: &HyperelasticRegion,
    scratch: &mut Scratch,
    tell: &mut impl FnMut(usize, [f64; 6]),
) {
    region.law.with_law(Stresses {
        region,
        scratch,
        tell,
    });
}

struct Stresses<'a, F> {
    region: &'a HyperelasticRegion,
    scratch: &'a mut Scratch,
    tell: &'a mut F,
}

impl<F: FnMut(usize, [f64; 6])> LawVisitor for Stresses<'_, F> {
    type Output = ();

    fn visit<L: HyperelasticLaw>(self, law: L) {
        let Self {
            region,
            scratch,
            tell,
        } = self;
        let (rest, lambda) = (&region.rest, law.lame().0);
        let is_defined = !region.is_smoothed() || means(region, scratch, &law).is_ok();
        for tet in 0..rest.count() {
            let at = law.at(rest.gradient_of::<f64>(tet, &scratch.displacement));
            let stress = if !is_defined || !law.admits(&at.deformation) {
                Tensor::diagonal(f64::NAN)
            } else if region.is_smoothed() {
                let [dilation, _] = scratch.dilations[region.patch_of[tet] as usize];
                let mut stress = law.stress(&at).scaled(1.0 - region.edge_share);
                stress = stress.plus(lambda * dilation, law.dilation_gradient(&at));
                for edge in region.edges_of.get(tet).into_iter().flatten() {
                    let tets = region.edges.of(*edge as usize);
                    let at_edge = law.at(region.mean_tensor(tets, &scratch.gradients));
                    stress = stress.plus(region.edge_share / 6.0, law.stress(&at_edge));
                }
                stress
            } else {
                law.stress_with(&at, law.own_bulk(&at))
            };
            let cauchy = stress
                .times_transposed(at.gradient)
                .scaled(at.volume_ratio.recip());
            let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = cauchy.0;
            // A mean stress is symmetric only in the sum over tetrahedra.
            let shear = [(xy + yx) / 2.0, (yz + zy) / 2.0, (xz + zx) / 2.0];
            tell(
                region.first + tet,
                [xx, yy, zz, shear[0], shear[1], shear[2]],
            );
        }
    }
}
