//! Products of the tangent with a change of the displacement, without a matrix.

use sinew_core::{EvaluationError, TangentKind};

use super::beside::TangentBeside;
use super::means::{at_edge, check, means};
use super::memory::{Past, Points, Relaxing};
use super::region::HyperelasticRegion;
use super::scratch::Scratch;
use crate::hyperelastic::{Bulk, HyperelasticLaw, LawVisitor, Linearised, Point, Tensor};

/// The tangent of a product.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// One of a kind.
    Kind(TangentKind),
    /// That which stiffness damping multiplies: the exact one, so that the rate of a stress is damped, but with rotations held fast where a
    /// law has one, which is semidefinite; of stress that relaxes, as it is at once.
    Damped,
    /// That which bounds a stable step: the exact one, with fibres that are idle as if they were pulled, since they may be before the next look.
    Stiffest,
}

/// Writes the change of the forces at the corners of a region's tetrahedra.
pub(super) fn product(
    region: &HyperelasticRegion,
    scratch: &mut Scratch,
    past: Past<'_>,
    wanted: Wanted,
) -> Result<(), EvaluationError> {
    region.law.with_law(Products {
        region,
        scratch,
        relaxing: match wanted {
            Wanted::Damped => Relaxing::none(),
            Wanted::Kind(_) | Wanted::Stiffest => Relaxing::of(region.memory.as_ref(), past),
        },
        wanted,
    })
}

struct Products<'a> {
    region: &'a HyperelasticRegion,
    scratch: &'a mut Scratch,
    relaxing: Relaxing<'a>,
    wanted: Wanted,
}

impl LawVisitor for Products<'_> {
    type Output = Result<(), EvaluationError>;

    fn visit<L: HyperelasticLaw>(self, law: L) -> Self::Output {
        let kind = match self.wanted {
            Wanted::Kind(kind) => kind,
            Wanted::Stiffest => TangentKind::Exact,
            Wanted::Damped => {
                let at = law.at(Tensor::<f64>::zero());
                match law.frozen_tangent(&at, Tensor::zero()) {
                    Some(_) => TangentKind::Frozen,
                    None => TangentKind::Exact,
                }
            }
        };
        if self.region.is_smoothed() {
            self.smoothed(law, kind)
        } else {
            self.plain(law, kind)
        }
    }
}

impl Products<'_> {
    fn plain<L: HyperelasticLaw>(self, law: L, kind: TangentKind) -> Result<(), EvaluationError> {
        let (region, relaxing) = (self.region, self.relaxing);
        let rest = &region.rest;
        let corners = &mut self.scratch.corners[4 * region.first..];
        for tet in rest.tets() {
            let at = law.at(rest.gradient_of::<f64>(tet, &self.scratch.displacement));
            check(region, &law, &relaxing, &at, tet)?;
            let change = rest.gradient_of::<f64>(tet, &self.scratch.change);
            let left = left_of_tet(region, &relaxing, &law, &at, tet);
            let own = OwnTangent::of(&law, &at, left, kind);
            let how = (kind, self.wanted == Wanted::Stiffest);
            let beside = TangentBeside::of(region, &relaxing, tet, &at.deformation, how);
            let stress = beside.with(own.on(change), change);
            rest.forces(tet, stress, &mut corners[4 * tet..]);
        }
        Ok(())
    }

    fn smoothed<L: HyperelasticLaw>(
        self,
        law: L,
        kind: TangentKind,
    ) -> Result<(), EvaluationError> {
        let Self {
            region,
            scratch,
            relaxing,
            wanted,
        } = self;
        let (rest, lambda) = (&region.rest, law.lame().0);
        means(region, scratch, &law, &relaxing)?;
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
            let at = at_edge(region, &law, tets, scratch, &relaxing)?;
            let change = region.mean_tensor(tets, |tet| scratch.changes[tet]);
            let tangent = EdgeTangent::of(&law, &at, (region, &relaxing, edge), kind);
            scratch.at_edges[edge] = tangent.on(change);
        }
        let corners = &mut scratch.corners[4 * region.first..];
        for tet in rest.tets() {
            let at = law.at(scratch.gradients[tet]);
            let patch = region.patch_of[tet] as usize;
            let [dilation, change] = scratch.dilations[patch];
            let left = left_of_smoothed(region, &relaxing, &law, &at, (tet, dilation));
            let own = OwnTangent::of(&law, &at, left, kind);
            let mut stress = own.on(scratch.changes[tet]);
            let lambda = lambda * region.stiffness_of_patch(patch);
            let of_patch = relaxing.factor_of_dilation() * lambda * change;
            stress = stress.plus(of_patch, law.dilation_gradient(&at));
            for edge in region.edges_of.get(tet).into_iter().flatten() {
                stress = stress.plus(region.edge_share / 6.0, scratch.at_edges[*edge as usize]);
            }
            let how = (kind, wanted == Wanted::Stiffest);
            let beside = TangentBeside::of(region, &relaxing, tet, &at.deformation, how);
            stress = beside.with(stress, scratch.changes[tet]);
            rest.forces(tet, stress, &mut corners[4 * tet..]);
        }
        Ok(())
    }
}

/// What is left of the energy of a tetrahedron that is averaged with no other.
#[inline(always)]
pub(super) fn left_of_tet<L: HyperelasticLaw>(
    region: &HyperelasticRegion,
    relaxing: &Relaxing<'_>,
    law: &L,
    at: &Point<f64, L::Own<f64>>,
    tet: usize,
) -> (f64, Bulk<f64>) {
    let stiffness = region.stiffness_of_tet(tet);
    let Bulk { stress, modulus } = law.own_bulk(at);
    let bulk = Bulk {
        stress: stiffness * stress,
        modulus: stiffness * modulus,
    };
    relaxing.left_of(stiffness, bulk, law.dilation(at))
}

/// What is left of a tetrahedron's own share of the local energy, and of the dilational one by the mean dilation of its patch, whose own modulus
/// is added elsewhere.
#[inline(always)]
pub(super) fn left_of_smoothed<L: HyperelasticLaw>(
    region: &HyperelasticRegion,
    relaxing: &Relaxing<'_>,
    law: &L,
    at: &Point<f64, L::Own<f64>>,
    (tet, mean_dilation): (usize, f64),
) -> (f64, Bulk<f64>) {
    let patch = region.patch_of[tet] as usize;
    let bulk = Bulk {
        stress: region.stiffness_of_patch(patch) * law.lame().0 * mean_dilation,
        modulus: 0.0,
    };
    let share = (1.0 - region.edge_share) * region.stiffness_of_tet(tet);
    relaxing.left_of(share, bulk, law.dilation(at))
}

/// The tangent of a share of the local energy, and of the dilational one.
pub(super) struct OwnTangent<'a, L: HyperelasticLaw> {
    law: &'a L,
    at: &'a Point<f64, L::Own<f64>>,
    /// The tangent for each share, where there is one.
    linearised: Option<(f64, Linearised<'a, f64, L>)>,
    /// First derivative of the dilational energy (Pa), where there is no share.
    bulk_stress: f64,
}

impl<'a, L: HyperelasticLaw> OwnTangent<'a, L> {
    pub(super) fn of(
        law: &'a L,
        at: &'a Point<f64, L::Own<f64>>,
        (share, bulk): (f64, Bulk<f64>),
        kind: TangentKind,
    ) -> Self {
        if share > 0.0 {
            let bulk = Bulk {
                stress: bulk.stress / share,
                modulus: bulk.modulus / share,
            };
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
                bulk_stress: if is_exact { bulk.stress } else { 0.0 },
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

/// The tangent of the local energy at the mean deformation of an edge.
pub(super) struct EdgeTangent<'a, L: HyperelasticLaw> {
    own: OwnTangent<'a, L>,
    /// R (Pa).
    carried: Option<Tensor<f64>>,
}

impl<'a, L: HyperelasticLaw> EdgeTangent<'a, L> {
    pub(super) fn of(
        law: &'a L,
        at: &'a Point<f64, L::Own<f64>>,
        (region, relaxing, edge): (&HyperelasticRegion, &Relaxing<'_>, usize),
        kind: TangentKind,
    ) -> Self {
        let stiffness = region.stiffness_at_edge(edge);
        let left = relaxing.left_of(stiffness, Bulk::none(), law.dilation(at));
        let is_exact = kind == TangentKind::Exact;
        Self {
            own: OwnTangent::of(law, at, left, kind),
            carried: relaxing.carried_tensor(Points::Edges, edge, is_exact),
        }
    }

    /// The change of the stress by a change of F.
    pub(super) fn on(&self, change: Tensor<f64>) -> Tensor<f64> {
        let own = self.own.on(change);
        match self.carried {
            Some(carried) => own + change * carried,
            None => own,
        }
    }
}
