//! Stresses of deformed tetrahedra.

use sinew_core::TangentKind;

use super::axes::Place;
use super::evaluator::{Asked, Untyped};
use super::memory::{Points, Relaxing};
use super::product::{left_of_smoothed, left_of_tets};
use super::region::HyperelasticRegion;
use super::wanted::Wanted;
use crate::hyperelastic::prony::first_piola;
use crate::hyperelastic::{Bulk, LawAt};

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
    pub(super) fn run(&self, law: &dyn Asked) -> [f64; 6] {
        law.with(Wanted::Kind(TangentKind::Exact), [f64::NAN; 6], |law| {
            self.of(law)
        })
    }

    fn of(&self, law: &mut (dyn Untyped + '_)) -> [f64; 6] {
        let Self {
            region,
            tet,
            ref relaxing,
            displacement,
        } = *self;
        let rest = &region.rest;
        let gradient = |tet: usize| rest.gradient_by(tet, displacement);
        let axes = region.axes.as_ref();
        let is_possible = |at: &dyn LawAt<f64>| at.admits() && relaxing.admits(at.deformation());
        let stress_at = |at: &dyn LawAt<f64>, (share, bulk): (f64, Bulk<f64>)| {
            let local = at.stress().scaled(share);
            local.plus(bulk.stress, at.dilation_gradient())
        };
        let patch = region.patch_of.get(tet);
        let dilation = patch.map(|patch| {
            rest.mean(region.patches.of(*patch as usize), |tet| {
                law.dilation(gradient(tet)).0
            })
        });
        let at = law.at_point(gradient(tet), axes, Place::Tets(tet));
        let deformation = *at.deformation();
        let mut is_defined = is_possible(at);
        let left = match dilation {
            Some(dilation) => left_of_smoothed(region, relaxing, at, (tet, dilation)),
            None => left_of_tets(region, relaxing, at, tet),
        };
        let mut stress = stress_at(at, left);
        for edge in region.edges_of.get(tet).into_iter().flatten() {
            let edge = *edge as usize;
            let gradient = region.mean_tensor(region.edges.of(edge), gradient);
            let at = law.at_point(gradient, axes, Place::Means);
            is_defined &= is_possible(at);
            let stiffness = region.stiffness_at_edges::<f64>(edge);
            let left = relaxing.left_of(stiffness, Bulk::none(), at.dilation());
            let mut own = stress_at(at, left);
            if let Some(carried) = relaxing.carried::<f64>(Points::Edges, edge) {
                own = own + first_piola(at.deformation(), carried);
            }
            stress = stress.plus(region.edge_share / 6.0, own);
        }
        for fibres in &region.fibres {
            is_defined &= fibres.admits(&deformation);
            let at = fibres.at(tet, &deformation);
            is_defined &= fibres.fibres.is_within_limit(&at);
            let own = fibres.fibres.stress(&at);
            stress = stress.plus(relaxing.factor_of_fibres(), own);
        }
        if let Some(carried) = relaxing.carried::<f64>(Points::Tets, tet) {
            stress = stress + first_piola(&deformation, carried);
        }
        if !is_defined {
            return [f64::NAN; 6];
        }
        let cauchy = stress.times_transposed(deformation.gradient);
        let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] =
            cauchy.scaled(deformation.volume_ratio.recip()).0;
        // With averages the stress of one tetrahedron need not be symmetric; its antisymmetric part does no work over all.
        let shear = [(xy + yx) / 2.0, (yz + zy) / 2.0, (xz + zx) / 2.0];
        [xx, yy, zz, shear[0], shear[1], shear[2]]
    }
}
