//! Products of the tangent with a change of the displacement, without a matrix.

use sinew_core::{EvaluationError, TangentKind};

use super::means::{at_edge, bulk_of_patch, check, means};
use super::region::HyperelasticRegion;
use super::scratch::Scratch;
use crate::hyperelastic::{Bulk, HyperelasticLaw, LawVisitor, Linearised, Point, Tensor};

/// Writes the change of the forces at the corners of a region's tetrahedra; without a kind, frozen where the law has a rotation and
/// exact elsewhere.
pub(super) fn product(
    region: &HyperelasticRegion,
    scratch: &mut Scratch,
    kind: Option<TangentKind>,
) -> Result<(), EvaluationError> {
    region.law.with_law(Products {
        region,
        scratch,
        kind,
    })
}

struct Products<'a> {
    region: &'a HyperelasticRegion,
    scratch: &'a mut Scratch,
    kind: Option<TangentKind>,
}

impl LawVisitor for Products<'_> {
    type Output = Result<(), EvaluationError>;

    fn visit<L: HyperelasticLaw>(self, law: L) -> Self::Output {
        let kind = self.kind.unwrap_or_else(|| {
            let at = law.at(Tensor::<f64>::zero());
            match law.frozen_tangent(&at, Tensor::zero()) {
                Some(_) => TangentKind::Frozen,
                None => TangentKind::Exact,
            }
        });
        if self.region.is_smoothed() {
            self.smoothed(law, kind)
        } else {
            self.plain(law, kind)
        }
    }
}

impl Products<'_> {
    fn plain<L: HyperelasticLaw>(self, law: L, kind: TangentKind) -> Result<(), EvaluationError> {
        let rest = &self.region.rest;
        let corners = &mut self.scratch.corners[4 * self.region.first..];
        for tet in rest.tets() {
            let at = law.at(rest.gradient_of::<f64>(tet, &self.scratch.displacement));
            check(&law, &at, rest.tag(tet))?;
            let change = rest.gradient_of::<f64>(tet, &self.scratch.change);
            let tangent = Linearised::of(&law, &at, law.own_bulk(&at), kind);
            rest.forces(tet, tangent.on(change), &mut corners[4 * tet..]);
        }
        Ok(())
    }

    fn smoothed<L: HyperelasticLaw>(
        self,
        law: L,
        kind: TangentKind,
    ) -> Result<(), EvaluationError> {
        let Self {
            region, scratch, ..
        } = self;
        let (rest, lambda) = (&region.rest, law.lame().0);
        means(region, scratch, &law)?;
        for patch in 0..region.patches.count() {
            let tets = region.patches.of(patch);
            for tet in tets {
                let tet = *tet as usize;
                scratch.changes[tet] = rest.gradient_of::<f64>(tet, &scratch.change);
            }
            let [change] = region.mean(tets, |tet| {
                let at = law.at(scratch.gradients[tet]);
                [law.dilation_gradient(&at).contracted(scratch.changes[tet])]
            });
            scratch.dilations[patch][1] = change;
        }
        for edge in 0..region.edges.count() {
            let tets = region.edges.of(edge);
            let at = at_edge(region, &law, tets, scratch)?;
            let change = region.mean_tensor(tets, |tet| scratch.changes[tet]);
            let tangent = Linearised::of(&law, &at, Bulk::none(), kind);
            scratch.at_edges[edge] = tangent.on(change);
        }
        let corners = &mut scratch.corners[4 * region.first..];
        for tet in rest.tets() {
            let at = law.at(scratch.gradients[tet]);
            let [dilation, change] = scratch.dilations[region.patch_of[tet] as usize];
            let own = OwnTangent::of(&law, &at, region, lambda * dilation, kind);
            let mut stress = own.on(scratch.changes[tet]);
            stress = stress.plus(lambda * change, law.dilation_gradient(&at));
            for edge in region.edges_of.get(tet).into_iter().flatten() {
                stress = stress.plus(region.edge_share / 6.0, scratch.at_edges[*edge as usize]);
            }
            rest.forces(tet, stress, &mut corners[4 * tet..]);
        }
        Ok(())
    }
}

/// The tangent of a tetrahedron's own share of the local energy and of the stress of its patch.
pub(super) struct OwnTangent<'a, L: HyperelasticLaw> {
    law: &'a L,
    at: &'a Point<f64, L::Own<f64>>,
    /// The tangent for each share, where the tetrahedron has one.
    linearised: Option<(f64, Linearised<'a, f64, L>)>,
    /// What is left of the stress of the patch (Pa).
    bulk_stress: f64,
}

impl<'a, L: HyperelasticLaw> OwnTangent<'a, L> {
    /// `bulk_stress` is lambda times the mean dilation of the patch.
    pub(super) fn of(
        law: &'a L,
        at: &'a Point<f64, L::Own<f64>>,
        region: &HyperelasticRegion,
        bulk_stress: f64,
        kind: TangentKind,
    ) -> Self {
        let share = 1.0 - region.edge_share;
        if share > 0.0 {
            let bulk = bulk_of_patch(1.0, bulk_stress / share);
            Self {
                law,
                at,
                linearised: Some((share, Linearised::of(law, at, bulk, kind))),
                bulk_stress: 0.0,
            }
        } else {
            // Alone the stress of the patch gives nothing definite: what is not exact does without it.
            let is_exact = kind == TangentKind::Exact;
            Self {
                law,
                at,
                linearised: None,
                bulk_stress: if is_exact { bulk_stress } else { 0.0 },
            }
        }
    }

    /// The change of the stress by a change of F.
    pub(super) fn on(&self, change: Tensor<f64>) -> Tensor<f64> {
        match &self.linearised {
            Some((share, linearised)) => linearised.on(change).scaled(*share),
            None => self
                .law
                .dilation_tangent(self.at, change)
                .scaled(self.bulk_stress),
        }
    }
}
