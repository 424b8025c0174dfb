//! Products of a tangent, or of the viscosity, with a change of the displacement, without a matrix.

use sinew_core::{EvaluationError, TangentKind};
use sinew_sparse::simd::{InstructionSet, Number, Vectors, WithReal};

use super::axes::Place;
use super::beside::TangentBeside;
use super::chunks::LANES;
use super::evaluator::{Asked, Evaluator, Typed};
use super::kept::{load, no_rows, store};
use super::means::{add, at_edges, mean_at_edges, means, require};
use super::memory::{Points, Relaxing};
use super::region::HyperelasticRegion;
use super::scratch::Scratch;
use super::wanted::{OnLaw, Wanted};
use crate::hyperelastic::{Bulk, HyperelasticLaw, LawAt, Linearised, Tensor, projects};

/// The change of the forces at the corners of a region's tetrahedra, computed by these instructions.
pub(crate) struct Products<'a> {
    pub(super) region: &'a HyperelasticRegion,
    pub(super) scratch: &'a mut Scratch,
    pub(super) relaxing: Relaxing<'a>,
    pub(super) wanted: Wanted,
    pub(super) set: InstructionSet,
}

impl Products<'_> {
    /// True if plain numbers compute it: vectors take neither projections nor the stress beside the law's.
    pub(super) fn take_numbers(&self, law: &dyn Asked) -> bool {
        let kind = self.wanted.kind();
        self.wanted.has_beside(self.region)
            || kind != TangentKind::Exact && law.at(Tensor::zero(), true, |at| projects(at, kind))
    }

    /// Computes it with plain numbers.
    pub(super) fn with_numbers(&mut self, law: &dyn Asked) -> Result<(), EvaluationError> {
        law.with(self.wanted, Ok(()), |law| self.tets::<true, f64, _>(law))
    }

    /// Takes the means, where there are any, and the change of the stress at their edges.
    #[inline(always)]
    fn means<const ALL: bool, N: Number<Real = f64>, E: Evaluator<N> + ?Sized>(
        &mut self,
        law: &mut E,
    ) -> Result<(), EvaluationError> {
        let Self {
            region,
            scratch,
            relaxing,
            wanted,
            ..
        } = self;
        means::<N, E>(region, scratch, law, relaxing, true)?;
        for first in (0..region.edges.count()).step_by(N::LANES) {
            let at = at_edges::<N, E>(region, law, first, &scratch.gradients, relaxing)?;
            let change = mean_at_edges::<N>(region, first, &scratch.changes);
            let place = (*region, &*relaxing, first);
            let tangent = EdgeTangent::of::<ALL>(&*at, place, wanted.kind());
            let to = &mut scratch.at_edges[first..first + N::LANES];
            store(tangent.on(change), to);
        }
        Ok(())
    }

    /// Writes the change of the forces. `ALL` is true if projections and the stress beside the law's may contribute: that
    /// is compiled for plain numbers only, as it would double what there is to compile.
    #[inline(always)]
    fn tets<const ALL: bool, N: Number<Real = f64>, E: Evaluator<N> + ?Sized>(
        &mut self,
        law: &mut E,
    ) -> Result<(), EvaluationError> {
        let is_smoothed = self.region.is_smoothed();
        if is_smoothed {
            self.means::<ALL, N, E>(law)?;
        }
        let Self {
            region,
            scratch,
            relaxing,
            wanted,
            ..
        } = self;
        let rest = &region.rest;
        let corners = &mut scratch.corners[4 * region.first..];
        for first in (0..rest.count()).step_by(N::LANES) {
            let (gradient, change): (Tensor<N>, Tensor<N>) = if is_smoothed {
                (
                    load(&scratch.gradients[first..]),
                    load(&scratch.changes[first..]),
                )
            } else {
                (
                    rest.gradient_of(first, &scratch.displacement),
                    rest.gradient_of(first, &scratch.change),
                )
            };
            let at = law.at(gradient, region.axes.as_ref(), Place::Tets(first));
            let at = &*at;
            let mut dilation_change = N::of(0.0);
            let left = if is_smoothed {
                let patch = |lane: usize| region.patch_of[first + lane] as usize;
                let dilation = N::from_lanes(|lane| scratch.dilations[patch(lane)][0]);
                dilation_change = N::from_lanes(|lane| {
                    region.stiffness_of_patch(patch(lane)) * scratch.dilations[patch(lane)][1]
                });
                left_of_smoothed(region, relaxing, at, (first, dilation))
            } else {
                require(at, region, relaxing, first)?;
                left_of_tets(region, relaxing, at, first)
            };
            let own = OwnTangent::of::<ALL>(at, left, wanted.kind());
            let lambda = relaxing.factor_of_dilation() * at.lame().0;
            let of_patch = N::of(lambda) * dilation_change;
            let mut stress = own.on(change).plus(of_patch, at.dilation_gradient());
            if !region.edges_of.is_empty() {
                let mut sums = [no_rows(); LANES];
                for (lane, sum) in sums.iter_mut().enumerate().take(N::LANES) {
                    for edge in region.edges_of[first + lane] {
                        add(sum, 1.0, &scratch.at_edges[edge as usize]);
                    }
                }
                stress = stress.plus(N::of(region.edge_share / 6.0), load(&sums));
            }
            if ALL {
                let beside = TangentBeside::of(region, relaxing, first, at.deformation(), *wanted);
                stress = beside.with(stress, change);
            }
            let stress = stress.scaled(rest.volumes(first));
            rest.forces(first, stress, &mut corners[4 * (first - first % LANES)..]);
        }
        Ok(())
    }
}

/// [`Products`] with the type of the law.
pub(super) struct OfLaw<'p, 'a> {
    pub(super) products: &'p mut Products<'a>,
    pub(super) untyped: &'p dyn Asked,
}

impl OnLaw for OfLaw<'_, '_> {
    type Output = Result<(), EvaluationError>;

    fn run<L: HyperelasticLaw>(self, law: L) -> Self::Output {
        f64::with_vectors_or_numbers(self.products.set, Sweep { of: self, law })
    }
}

struct Sweep<'p, 'a, L> {
    of: OfLaw<'p, 'a>,
    law: L,
}

impl<L: HyperelasticLaw> WithReal<f64> for Sweep<'_, '_, L> {
    type Output = Result<(), EvaluationError>;

    #[inline(always)]
    fn run<N: Number<Real = f64>>(self) -> Self::Output {
        let OfLaw { products, untyped } = self.of;
        if N::LANES == 1 {
            products.with_numbers(untyped)
        } else {
            products.tets::<false, N, _>(&mut Typed(&self.law))
        }
    }
}

/// The remainder, after relaxation, of the energy of tetrahedra side by side that are averaged with no other.
#[inline(always)]
pub(super) fn left_of_tets<N: Number<Real = f64>, A: LawAt<N> + ?Sized>(
    region: &HyperelasticRegion,
    relaxing: &Relaxing<'_>,
    at: &A,
    first: usize,
) -> (N, Bulk<N>) {
    let stiffness = region.stiffness_of_tets::<N>(first);
    let Bulk { stress, modulus } = at.own_bulk();
    let bulk = Bulk {
        stress: stiffness * stress,
        modulus: stiffness * modulus,
    };
    relaxing.left_of(stiffness, bulk, at.dilation())
}

/// The remainder, after relaxation, of the share of the local energy that tetrahedra side by side keep for themselves,
/// and of the dilational one by the mean dilation of their patches, whose own modulus is added elsewhere.
#[inline(always)]
pub(super) fn left_of_smoothed<N: Number<Real = f64>, A: LawAt<N> + ?Sized>(
    region: &HyperelasticRegion,
    relaxing: &Relaxing<'_>,
    at: &A,
    (first, mean_dilation): (usize, N),
) -> (N, Bulk<N>) {
    let stiffness = N::from_lanes(|lane| {
        let patch = region.patch_of[first + lane] as usize;
        region.stiffness_of_patch(patch)
    });
    let bulk = Bulk {
        stress: stiffness * N::of(at.lame().0) * mean_dilation,
        modulus: N::of(0.0),
    };
    let share = N::of(1.0 - region.edge_share) * region.stiffness_of_tets(first);
    relaxing.left_of(share, bulk, at.dilation())
}

/// The tangent of a share of the local energy, and of the dilational one.
pub(super) struct OwnTangent<'a, N, A: ?Sized> {
    at: &'a A,
    /// The tangent for each share, where there is one.
    linearised: Option<(N, Linearised<'a, N, A>)>,
    /// First derivative of the dilational energy (Pa), where there is no share.
    bulk_stress: N,
}

impl<'a, N: Number, A: LawAt<N> + ?Sized> OwnTangent<'a, N, A> {
    /// The tangent of a kind; `ALL` is true if that may be a projection.
    #[inline(always)]
    pub(super) fn of<const ALL: bool>(
        at: &'a A,
        (share, bulk): (N, Bulk<N>),
        kind: TangentKind,
    ) -> Self {
        let none = N::of(0.0);
        if N::all_le(share, none) {
            // Alone the stress of the patch gives nothing definite: what is not exact does without it.
            let is_exact = kind == TangentKind::Exact;
            return Self {
                at,
                linearised: None,
                bulk_stress: if is_exact { bulk.stress } else { none },
            };
        }
        let bulk = Bulk {
            stress: bulk.stress / share,
            modulus: bulk.modulus / share,
        };
        let linearised = if ALL {
            Linearised::of(at, bulk, kind)
        } else {
            Linearised::as_it_is(at, bulk, kind)
        };
        Self {
            at,
            linearised: Some((share, linearised)),
            bulk_stress: none,
        }
    }

    /// The change of the stress by a change of F.
    #[inline(always)]
    pub(super) fn on(&self, change: Tensor<N>) -> Tensor<N> {
        match &self.linearised {
            Some((share, linearised)) => linearised.on(change).scaled(*share),
            None => self.at.dilation_tangent(change).scaled(self.bulk_stress),
        }
    }

    /// Replaces changes of F by those of the stress.
    pub(super) fn on_all(&self, changes: &mut [Tensor<N>]) {
        match &self.linearised {
            Some((share, linearised)) => {
                linearised.on_all(changes);
                for change in changes {
                    *change = change.scaled(*share);
                }
            }
            None => {
                for change in changes {
                    *change = self.on(*change);
                }
            }
        }
    }
}

/// The tangent of the local energy at the mean deformation of edges side by side.
pub(super) struct EdgeTangent<'a, N, A: ?Sized> {
    own: OwnTangent<'a, N, A>,
    /// R (Pa).
    carried: Option<Tensor<N>>,
}

impl<'a, N: Number<Real = f64>, A: LawAt<N> + ?Sized> EdgeTangent<'a, N, A> {
    /// The tangent of a kind, with the same meaning of `ALL` as [`OwnTangent::of`].
    #[inline(always)]
    pub(super) fn of<const ALL: bool>(
        at: &'a A,
        (region, relaxing, first): (&HyperelasticRegion, &Relaxing<'_>, usize),
        kind: TangentKind,
    ) -> Self {
        let stiffness = region.stiffness_at_edges(first);
        let left = relaxing.left_of(stiffness, Bulk::none(), at.dilation());
        let is_exact = kind == TangentKind::Exact;
        Self {
            own: OwnTangent::of::<ALL>(at, left, kind),
            carried: if ALL {
                relaxing.carried_tensor(Points::Edges, first, is_exact)
            } else {
                None
            },
        }
    }

    /// The change of the stress by a change of F.
    #[inline(always)]
    pub(super) fn on(&self, change: Tensor<N>) -> Tensor<N> {
        self.with_carried(self.own.on(change), change)
    }

    /// The changes of the stress by changes of F, in place of `stresses`, which are these changes.
    pub(super) fn on_all(&self, changes: &[Tensor<N>], stresses: &mut [Tensor<N>]) {
        self.own.on_all(stresses);
        for (stress, change) in stresses.iter_mut().zip(changes) {
            *stress = self.with_carried(*stress, *change);
        }
    }

    #[inline(always)]
    fn with_carried(&self, own: Tensor<N>, change: Tensor<N>) -> Tensor<N> {
        match self.carried {
            Some(carried) => own + change * carried,
            None => own,
        }
    }
}
