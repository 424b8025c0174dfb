//! Products of a tangent, or of the viscosity, with a change of the displacement, without a matrix.

use sinew_core::{EvaluationError, TangentKind};
use sinew_sparse::simd::{InstructionSet, Number, Vectors, WithReal};

use super::axes::point;
use super::beside::TangentBeside;
use super::chunks::LANES;
use super::kept::{load, store};
use super::means::{add, at_edges, mean_at_edges, means, require};
use super::memory::{Points, Relaxing};
use super::region::HyperelasticRegion;
use super::scratch::Scratch;
use super::wanted::{OnLaw, Wanted};
use crate::hyperelastic::{Bulk, HyperelasticLaw, Linearised, Point, Tensor};

/// The change of the forces at the corners of a region's tetrahedra, computed by these instructions.
pub(crate) struct Products<'a> {
    pub(super) region: &'a HyperelasticRegion,
    pub(super) scratch: &'a mut Scratch,
    pub(super) relaxing: Relaxing<'a>,
    pub(super) wanted: Wanted,
    pub(super) set: InstructionSet,
}

impl Products<'_> {
    fn has_beside(&self) -> bool {
        self.wanted.has_beside(self.region)
    }
}

impl OnLaw for Products<'_> {
    type Output = Result<(), EvaluationError>;

    fn run<L: HyperelasticLaw>(self, law: L) -> Self::Output {
        let kind = self.wanted.kind();
        let set = self.set;
        let projects = Linearised::<f64, L>::projects(&law, kind);
        let sweep = Sweep::<L, false> {
            products: self,
            law,
            kind,
        };
        if sweep.products.has_beside() || projects {
            sweep.of_all().run::<f64>()
        } else {
            f64::with_vectors_or_numbers(set, sweep)
        }
    }
}

/// All loops over a region, for one law and one kind of tangent. `ALL` is true if they include projections and the
/// stress beside the law's: this is compiled for plain numbers only, as it would double what there is to compile.
struct Sweep<'a, L, const ALL: bool> {
    products: Products<'a>,
    law: L,
    kind: TangentKind,
}

impl<L: HyperelasticLaw, const ALL: bool> WithReal<f64> for Sweep<'_, L, ALL> {
    type Output = Result<(), EvaluationError>;

    #[inline(always)]
    fn run<N: Number<Real = f64>>(self) -> Self::Output {
        if !ALL && N::LANES == 1 {
            self.of_all().run::<f64>()
        } else {
            self.tets::<N>()
        }
    }
}

impl<'a, L: HyperelasticLaw, const ALL: bool> Sweep<'a, L, ALL> {
    fn of_all(self) -> Sweep<'a, L, true> {
        Sweep {
            products: self.products,
            law: self.law,
            kind: self.kind,
        }
    }

    /// Takes the means, where there are any, and the change of the stress at their edges.
    #[inline(always)]
    fn means<N: Number<Real = f64>>(&mut self) -> Result<(), EvaluationError> {
        let Products {
            region,
            scratch,
            relaxing,
            ..
        } = &mut self.products;
        means::<N, L>(region, scratch, &self.law, relaxing, true)?;
        for first in (0..region.edges.count()).step_by(N::LANES) {
            let at = at_edges::<N, L>(region, &self.law, first, &scratch.gradients, relaxing)?;
            let change = mean_at_edges::<N>(region, first, &scratch.changes);
            let place = (*region, &*relaxing, first);
            let tangent = EdgeTangent::among::<ALL>(&self.law, &at, place, self.kind);
            let to = &mut scratch.at_edges[first..first + N::LANES];
            store(tangent.on(change), to);
        }
        Ok(())
    }

    /// Writes the change of the forces.
    #[inline(always)]
    fn tets<N: Number<Real = f64>>(mut self) -> Result<(), EvaluationError> {
        let is_smoothed = self.products.region.is_smoothed();
        if is_smoothed {
            self.means::<N>()?;
        }
        let Products {
            region,
            scratch,
            relaxing,
            wanted,
            ..
        } = self.products;
        let (rest, law, kind) = (&region.rest, self.law, self.kind);
        let lambda = relaxing.factor_of_dilation() * law.lame().0;
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
            let at = point(&law, gradient, region.axes.as_ref(), first);
            let mut dilation_change = N::of(0.0);
            let left = if is_smoothed {
                let patch = |lane: usize| region.patch_of[first + lane] as usize;
                let dilation = N::from_lanes(|lane| scratch.dilations[patch(lane)][0]);
                dilation_change = N::from_lanes(|lane| {
                    region.stiffness_of_patch(patch(lane)) * scratch.dilations[patch(lane)][1]
                });
                left_of_smoothed(region, &relaxing, &law, &at, (first, dilation))
            } else {
                require(&law, region, &relaxing, &at, first)?;
                left_of_tets(region, &relaxing, &law, &at, first)
            };
            let own = OwnTangent::among::<ALL>(&law, &at, left, kind);
            let of_patch = N::of(lambda) * dilation_change;
            let mut stress = own.on(change).plus(of_patch, law.dilation_gradient(&at));
            if !region.edges_of.is_empty() {
                let mut sums = [[[0.0; 4]; 3]; LANES];
                for (lane, sum) in sums.iter_mut().enumerate().take(N::LANES) {
                    for edge in region.edges_of[first + lane] {
                        add(sum, 1.0, &scratch.at_edges[edge as usize]);
                    }
                }
                stress = stress.plus(N::of(region.edge_share / 6.0), load(&sums));
            }
            if ALL {
                let beside = TangentBeside::of(region, &relaxing, first, &at.deformation, wanted);
                stress = beside.with(stress, change);
            }
            rest.forces(first, stress, &mut corners[4 * first..]);
        }
        Ok(())
    }
}

/// The remainder, after relaxation, of the energy of tetrahedra side by side that are averaged with no other.
#[inline(always)]
pub(super) fn left_of_tets<N: Number<Real = f64>, L: HyperelasticLaw>(
    region: &HyperelasticRegion,
    relaxing: &Relaxing<'_>,
    law: &L,
    at: &Point<N, L::Own<N>>,
    first: usize,
) -> (N, Bulk<N>) {
    let stiffness = region.stiffness_of_tets::<N>(first);
    let Bulk { stress, modulus } = law.own_bulk(at);
    let bulk = Bulk {
        stress: stiffness * stress,
        modulus: stiffness * modulus,
    };
    relaxing.left_of(stiffness, bulk, law.dilation(at))
}

/// The remainder, after relaxation, of the share of the local energy that tetrahedra side by side keep for themselves,
/// and of the dilational one by the mean dilation of their patches, whose own modulus is added elsewhere.
#[inline(always)]
pub(super) fn left_of_smoothed<N: Number<Real = f64>, L: HyperelasticLaw>(
    region: &HyperelasticRegion,
    relaxing: &Relaxing<'_>,
    law: &L,
    at: &Point<N, L::Own<N>>,
    (first, mean_dilation): (usize, N),
) -> (N, Bulk<N>) {
    let stiffness = N::from_lanes(|lane| {
        let patch = region.patch_of[first + lane] as usize;
        region.stiffness_of_patch(patch)
    });
    let bulk = Bulk {
        stress: stiffness * N::of(law.lame().0) * mean_dilation,
        modulus: N::of(0.0),
    };
    let share = N::of(1.0 - region.edge_share) * region.stiffness_of_tets(first);
    relaxing.left_of(share, bulk, law.dilation(at))
}

/// The tangent of a share of the local energy, and of the dilational one.
pub(super) struct OwnTangent<'a, N: Number, L: HyperelasticLaw> {
    law: &'a L,
    at: &'a Point<N, L::Own<N>>,
    /// The tangent for each share, where there is one.
    linearised: Option<(N, Linearised<'a, N, L>)>,
    /// First derivative of the dilational energy (Pa), where there is no share.
    bulk_stress: N,
}

impl<'a, N: Number, L: HyperelasticLaw> OwnTangent<'a, N, L> {
    pub(super) fn of(
        law: &'a L,
        at: &'a Point<N, L::Own<N>>,
        left: (N, Bulk<N>),
        kind: TangentKind,
    ) -> Self {
        Self::among::<true>(law, at, left, kind)
    }

    /// The tangent of a kind, which is not projected unless all kinds are among those to choose from.
    #[inline(always)]
    fn among<const ALL: bool>(
        law: &'a L,
        at: &'a Point<N, L::Own<N>>,
        (share, bulk): (N, Bulk<N>),
        kind: TangentKind,
    ) -> Self {
        let none = N::of(0.0);
        if N::all_le(share, none) {
            // Alone the stress of the patch gives nothing definite: what is not exact does without it.
            let is_exact = kind == TangentKind::Exact;
            return Self {
                law,
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
            Linearised::of(law, at, bulk, kind)
        } else {
            Linearised::as_it_is(law, at, bulk, kind)
        };
        Self {
            law,
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
            None => self
                .law
                .dilation_tangent(self.at, change)
                .scaled(self.bulk_stress),
        }
    }
}

/// The tangent of the local energy at the mean deformation of edges side by side.
pub(super) struct EdgeTangent<'a, N: Number, L: HyperelasticLaw> {
    own: OwnTangent<'a, N, L>,
    /// R (Pa).
    carried: Option<Tensor<N>>,
}

impl<'a, N: Number<Real = f64>, L: HyperelasticLaw> EdgeTangent<'a, N, L> {
    pub(super) fn of(
        law: &'a L,
        at: &'a Point<N, L::Own<N>>,
        place: (&HyperelasticRegion, &Relaxing<'_>, usize),
        kind: TangentKind,
    ) -> Self {
        Self::among::<true>(law, at, place, kind)
    }

    /// Builds the edges' tangent, with the same meaning of `ALL` as [`OwnTangent::among`].
    #[inline(always)]
    fn among<const ALL: bool>(
        law: &'a L,
        at: &'a Point<N, L::Own<N>>,
        (region, relaxing, first): (&HyperelasticRegion, &Relaxing<'_>, usize),
        kind: TangentKind,
    ) -> Self {
        let stiffness = region.stiffness_at_edges(first);
        let left = relaxing.left_of(stiffness, Bulk::none(), law.dilation(at));
        let is_exact = kind == TangentKind::Exact;
        Self {
            own: OwnTangent::among::<ALL>(law, at, left, kind),
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
        let own = self.own.on(change);
        match self.carried {
            Some(carried) => own + change * carried,
            None => own,
        }
    }
}
