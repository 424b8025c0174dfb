//! Stresses of deformed tetrahedra.

use sinew_core::TangentKind;

use super::axes::Place;
use super::evaluator::{Asked, Untyped};
use super::memory::{Points, Relaxing};
use super::product::{left_of_smoothed, left_of_tets};
use super::region::HyperelasticRegion;
use super::wanted::Wanted;
use crate::hyperelastic::prony::first_piola;
use crate::hyperelastic::{Bulk, LawAt, Tensor};

/// The Cauchy stress (Pa), `P F'/J`, of a tetrahedron, with the displacement (m) of each mesh node; NaN if the law,
/// fibres or memory are undefined there.
pub(crate) struct Cauchy<'a> {
    pub(super) region: &'a HyperelasticRegion,
    pub(super) tet: usize,
    pub(super) relaxing: Relaxing<'a>,
    pub(super) displacement: &'a dyn Fn(u32) -> [f64; 3],
    /// Shared values of other tetrahedra with the same displacement.
    pub(super) shared: Option<&'a mut SharedStress>,
}

/// Values that the stresses of several tetrahedra of a region share, at one displacement: each is computed once.
#[derive(Debug, Default)]
pub(crate) struct SharedStress {
    /// The gradient of the displacement in each tetrahedron.
    gradients: Vec<Option<Tensor<f64>>>,
    /// The mean dilation of each patch.
    dilations: Vec<Option<f64>>,
    /// The stress at each edge.
    edges: Vec<Option<AtEdge>>,
}

impl SharedStress {
    /// An instance without values for a region; `None` if its tetrahedra share nothing.
    pub(super) fn of(region: &HyperelasticRegion) -> Option<Self> {
        region.is_smoothed().then(|| Self {
            gradients: vec![None; region.rest.count()],
            dilations: vec![None; region.patches.count()],
            edges: vec![None; region.edges.count()],
        })
    }
}

/// The first Piola-Kirchhoff stress (Pa) by the mean deformation at an edge.
#[derive(Clone, Copy, Debug)]
struct AtEdge {
    stress: Tensor<f64>,
    is_defined: bool,
}

impl Cauchy<'_> {
    /// Computes the stress for the law of the region.
    pub(super) fn run(mut self, law: &dyn Asked) -> [f64; 6] {
        law.with(Wanted::Kind(TangentKind::Exact), [f64::NAN; 6], |law| {
            self.of(law)
        })
    }

    fn of(&mut self, law: &mut (dyn Untyped + '_)) -> [f64; 6] {
        let (region, tet) = (self.region, self.tet);
        let patch = region.patch_of.get(tet);
        let dilation = patch.map(|patch| self.dilation(law, *patch as usize));
        let gradient = self.gradient(tet);
        let at = law.at_point(gradient, region.axes.as_ref(), Place::Tets(tet));
        let deformation = *at.deformation();
        let mut is_defined = self.is_possible(at);
        let left = match dilation {
            Some(dilation) => left_of_smoothed(region, &self.relaxing, at, (tet, dilation)),
            None => left_of_tets(region, &self.relaxing, at, tet),
        };
        let mut stress = stress_at(at, left);
        for edge in region.edges_of.get(tet).into_iter().flatten() {
            let at = self.at_edge(law, *edge as usize);
            is_defined &= at.is_defined;
            stress = stress.plus(region.edge_share / 6.0, at.stress);
        }
        let relaxing = &self.relaxing;
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

    fn is_possible(&self, at: &dyn LawAt<f64>) -> bool {
        at.admits() && self.relaxing.admits(at.deformation())
    }

    /// The gradient of the displacement in a tetrahedron.
    fn gradient(&mut self, tet: usize) -> Tensor<f64> {
        let computed = || self.region.rest.gradient_by(tet, self.displacement);
        match &mut self.shared {
            Some(shared) => *shared.gradients[tet].get_or_insert_with(computed),
            None => computed(),
        }
    }

    /// The mean dilation of a patch.
    fn dilation(&mut self, law: &mut (dyn Untyped + '_), patch: usize) -> f64 {
        let known = self.shared.as_ref().map(|shared| shared.dilations[patch]);
        if let Some(dilation) = known.flatten() {
            return dilation;
        }
        let (rest, tets) = (&self.region.rest, self.region.patches.of(patch));
        let dilation = rest.mean(tets, |tet| law.dilation(self.gradient(tet)).0);
        if let Some(shared) = &mut self.shared {
            shared.dilations[patch] = Some(dilation);
        }
        dilation
    }

    /// The stress at an edge.
    fn at_edge(&mut self, law: &mut (dyn Untyped + '_), edge: usize) -> AtEdge {
        let known = self.shared.as_ref().map(|shared| shared.edges[edge]);
        if let Some(at) = known.flatten() {
            return at;
        }
        let region = self.region;
        let gradient = region.mean_tensor(region.edges.of(edge), |tet| self.gradient(tet));
        let relaxing = &self.relaxing;
        let at = law.at_point(gradient, region.axes.as_ref(), Place::Means);
        let stiffness = region.stiffness_at_edges::<f64>(edge);
        let left = relaxing.left_of(stiffness, Bulk::none(), at.dilation());
        let mut stress = stress_at(at, left);
        if let Some(carried) = relaxing.carried::<f64>(Points::Edges, edge) {
            stress = stress + first_piola(at.deformation(), carried);
        }
        let at = AtEdge {
            stress,
            is_defined: self.is_possible(at),
        };
        if let Some(shared) = &mut self.shared {
            shared.edges[edge] = Some(at);
        }
        at
    }
}

fn stress_at(at: &dyn LawAt<f64>, (share, bulk): (f64, Bulk<f64>)) -> Tensor<f64> {
    let local = at.stress().scaled(share);
    local.plus(bulk.stress, at.dilation_gradient())
}
