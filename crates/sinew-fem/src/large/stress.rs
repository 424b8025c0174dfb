//! Stresses of deformed tetrahedra.

use super::axes::{point, point_at_edges};
use super::memory::{Points, Relaxing};
use super::product::{left_of_smoothed, left_of_tets};
use super::region::HyperelasticRegion;
use crate::hyperelastic::prony::first_piola;
use crate::hyperelastic::{Bulk, HyperelasticLaw, Point};

/// The Cauchy stress (Pa), `P F'/J`, of a tetrahedron, with the displacement (m) of each mesh node; NaN if the law,
/// fibres or memory are undefined there.
pub(crate) struct Cauchy<'a> {
    pub(super) region: &'a HyperelasticRegion,
    pub(super) tet: usize,
    pub(super) relaxing: Relaxing<'a>,
    pub(super) displacement: &'a dyn Fn(u32) -> [f64; 3],
}

impl Cauchy<'_> {
    /// Computes it for the law of the region.
    pub(super) fn run<L: HyperelasticLaw>(self, law: L) -> [f64; 6] {
        let Self {
            region,
            tet,
            relaxing,
            displacement,
        } = self;
        let rest = &region.rest;
        let gradient = |tet: usize| rest.gradient_by(tet, displacement);
        let at = point(&law, gradient(tet), region.axes.as_ref(), tet);
        let is_possible =
            |at: &Point<f64, L::Own<f64>>| law.admits(at) && relaxing.admits(&at.deformation);
        let mut is_defined = is_possible(&at);
        let left = match region.patch_of.get(tet) {
            Some(patch) => {
                let dilation = rest.mean(region.patches.of(*patch as usize), |tet| {
                    law.dilation(&law.at(gradient(tet)))
                });
                left_of_smoothed(region, &relaxing, &law, &at, (tet, dilation))
            }
            None => left_of_tets(region, &relaxing, &law, &at, tet),
        };
        let stress_at = |at: &Point<f64, L::Own<f64>>, (share, bulk): (f64, Bulk<f64>)| {
            let local = law.stress(at).scaled(share);
            local.plus(bulk.stress, law.dilation_gradient(at))
        };
        let mut stress = stress_at(&at, left);
        for edge in region.edges_of.get(tet).into_iter().flatten() {
            let edge = *edge as usize;
            let gradient = region.mean_tensor(region.edges.of(edge), gradient);
            let at = point_at_edges(&law, gradient, region.axes.as_ref());
            is_defined &= is_possible(&at);
            let stiffness = region.stiffness_at_edges::<f64>(edge);
            let left = relaxing.left_of(stiffness, Bulk::none(), law.dilation(&at));
            let mut own = stress_at(&at, left);
            if let Some(carried) = relaxing.carried::<f64>(Points::Edges, edge) {
                own = own + first_piola(&at.deformation, carried);
            }
            stress = stress.plus(region.edge_share / 6.0, own);
        }
        for fibres in &region.fibres {
            is_defined &= fibres.admits(&at.deformation);
            let own = fibres.fibres.stress(&fibres.at(tet, &at.deformation));
            stress = stress.plus(relaxing.factor_of_fibres(), own);
        }
        if let Some(carried) = relaxing.carried::<f64>(Points::Tets, tet) {
            stress = stress + first_piola(&at.deformation, carried);
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
