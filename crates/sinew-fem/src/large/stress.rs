//! Stresses of deformed tetrahedra.

use super::region::HyperelasticRegion;
use crate::hyperelastic::{HyperelasticLaw, LawVisitor};

/// The Cauchy stress (Pa), `P F'/J`, of a tetrahedron, with the displacement (m) of each mesh node; not a number where the law has no
/// meaning.
pub(super) fn cauchy(
    region: &HyperelasticRegion,
    tet: usize,
    displacement: impl Fn(u32) -> [f64; 3],
) -> [f64; 6] {
    region.law.with_law(Cauchy {
        region,
        tet,
        displacement,
    })
}

struct Cauchy<'a, U> {
    region: &'a HyperelasticRegion,
    tet: usize,
    displacement: U,
}

impl<U: Fn(u32) -> [f64; 3]> LawVisitor for Cauchy<'_, U> {
    type Output = [f64; 6];

    fn visit<L: HyperelasticLaw>(self, law: L) -> [f64; 6] {
        let Self {
            region,
            tet,
            displacement,
        } = self;
        let rest = &region.rest;
        let gradient = |tet: usize| rest.gradient_by(tet, &displacement);
        let at = law.at(gradient(tet));
        let mut is_defined = law.admits(&at.deformation);
        let mut stress = if let Some(patch) = region.patch_of.get(tet) {
            let [dilation] = region.mean(region.patches.of(*patch as usize), |tet| {
                [law.dilation(&law.at(gradient(tet)))]
            });
            let own = law.stress(&at).scaled(1.0 - region.edge_share);
            own.plus(law.lame().0 * dilation, law.dilation_gradient(&at))
        } else {
            law.stress_with(&at, law.own_bulk(&at))
        };
        for edge in region.edges_of.get(tet).into_iter().flatten() {
            let tets = region.edges.of(*edge as usize);
            let at = law.at(region.mean_tensor(tets, gradient));
            is_defined &= law.admits(&at.deformation);
            stress = stress.plus(region.edge_share / 6.0, law.stress(&at));
        }
        if !is_defined {
            return [f64::NAN; 6];
        }
        let cauchy = stress.times_transposed(at.gradient);
        let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = cauchy.scaled(at.volume_ratio.recip()).0;
        // With averages the stress of one tetrahedron need not be symmetric; its antisymmetric part does no work over all.
        let shear = [(xy + yx) / 2.0, (yz + zy) / 2.0, (xz + zx) / 2.0];
        [xx, yy, zz, shear[0], shear[1], shear[2]]
    }
}
