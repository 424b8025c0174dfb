//! Products of a tangent, or of the viscosity, with a change of the displacement, without a matrix.

use std::ops::Range;

use sinew_core::{EvaluationError, TangentKind};
use sinew_sparse::simd::{InstructionSet, Number, Vectors, WithReal};

use super::axes::Place;
use super::beside::TangentBeside;
use super::chunks::LANES;
use super::evaluator::{Asked, Evaluator, Typed};
use super::gather::{CornerPlaces, Gather};
use super::kept::{Rows, load, no_rows, store};
use super::means::{add, mean_at_edges, require};
use super::memory::{Points, Relaxing};
use super::region::HyperelasticRegion;
use super::rooms::RegionRooms;
use super::schedule::Task;
use super::scratch::{ProductRooms, Scratch};
use super::wanted::{OnLaw, Wanted};
use crate::hyperelastic::{Bulk, HyperelasticLaw, LawAt, Linearised, Tensor, projects};

/// A piece of the work on a product with a change of the displacement: the change of forces at the nodes of a region, computed by these instructions.
pub(crate) struct Products<'a> {
    pub(super) region: &'a HyperelasticRegion,
    pub(super) rooms: &'a RegionRooms,
    pub(super) corners: &'a CornerPlaces,
    pub(super) gather: &'a Gather,
    pub(super) tasks: &'a [Task],
    pub(super) scratch: &'a mut Scratch,
    pub(super) relaxing: Relaxing<'a>,
    pub(super) wanted: Wanted,
    pub(super) set: InstructionSet,
}

impl Products<'_> {
    /// True if plain numbers compute it: vectors support neither projections nor the stress in addition to the law's.
    pub(super) fn take_numbers(&self, law: &dyn Asked) -> bool {
        let kind = self.wanted.kind();
        self.wanted.has_beside(self.region)
            || kind != TangentKind::Exact && law.at(Tensor::zero(), true, |at| projects(at, kind))
    }

    /// Computes it with plain numbers.
    pub(super) fn with_numbers(&mut self, law: &dyn Asked) -> Result<(), EvaluationError> {
        law.with(self.wanted, Ok(()), |law| self.all::<true, f64, _>(law))
    }

    /// Does the tasks. `ALL` is true if projections and stress in addition to the law's may contribute. That is
    /// compiled for plain numbers only, since it would double the code to compile.
    #[inline(always)]
    fn all<const ALL: bool, N: Number<Real = f64>, E: Evaluator<N> + ?Sized>(
        &mut self,
        law: &mut E,
    ) -> Result<(), EvaluationError> {
        for task in self.tasks {
            match task {
                Task::Means(chunk) => self.means::<N, E>(law, *chunk)?,
                Task::Edges(edges) => self.edges::<ALL, N, E>(law, edges.clone())?,
                Task::Forces(chunk) => self.tets::<ALL, N, E>(law, *chunk)?,
                Task::Nodes(nodes) => {
                    let Scratch { product, sums, .. } = &mut *self.scratch;
                    self.gather
                        .sum_part(nodes.clone(), self.corners, &mut product.corners, sums);
                }
            }
        }
        Ok(())
    }

    /// Takes the means over patches of a chunk, and keeps gradients for those over edges.
    #[inline(always)]
    fn means<N: Number<Real = f64>, E: Evaluator<N> + ?Sized>(
        &mut self,
        law: &mut E,
        number: usize,
    ) -> Result<(), EvaluationError> {
        let (region, rest, relaxing) = (self.region, &self.region.rest, &self.relaxing);
        let chunk = &region.chunks[number];
        let Scratch {
            displacement,
            change,
            product,
            ..
        } = &mut *self.scratch;
        let [dilations, changes] = product.dilations.each_mut();
        let [dilations, changes] = [dilations, changes].map(|all| &mut all[region.kept.tets..]);
        let rows = self.rooms.gradients[number] as usize;
        for first in chunk.slots.clone().step_by(N::LANES) {
            let gradient = rest.gradient_of::<N>(first, displacement);
            let change = rest.gradient_of::<N>(first, change);
            let at = law.at(gradient, region.axes.as_ref(), Place::Tets(first));
            let at = &*at;
            require(at, region, relaxing, first)?;
            let volume = rest.volumes::<N>(first);
            (volume * at.dilation()).store(&mut dilations[first..]);
            let of_change = at.dilation_gradient().contracted(change);
            (volume * of_change).store(&mut changes[first..]);
            if !region.edges_of.is_empty() {
                let own = rows + first - chunk.slots.start;
                let own = own..own + N::LANES;
                let [gradients, of_changes] = &mut product.gradients;
                store(gradient.scaled(volume), &mut gradients[own.clone()]);
                store(change.scaled(volume), &mut of_changes[own]);
            }
        }
        for patch in chunk.patches.clone() {
            let tets = region.patches.of(patch);
            // The tetrahedra of a patch are neighbours in memory.
            let first = tets.first().map_or(0, |tet| *tet as usize);
            let over = region.patch_volumes[patch].recip();
            let take_mean = |of_tets: &mut [f64], factor: f64| {
                let of_tets = &mut of_tets[first..first + tets.len()];
                let sum: f64 = of_tets.iter().sum();
                of_tets.fill(factor * over * sum);
            };
            take_mean(dilations, 1.0);
            take_mean(changes, region.stiffness_of_patch(patch));
        }
        Ok(())
    }

    /// Computes the change of the stress at some edges.
    #[inline(always)]
    fn edges<const ALL: bool, N: Number<Real = f64>, E: Evaluator<N> + ?Sized>(
        &mut self,
        law: &mut E,
        edges: Range<usize>,
    ) -> Result<(), EvaluationError> {
        let (region, relaxing) = (self.region, &self.relaxing);
        let ProductRooms {
            gradients: [gradients, changes],
            at_edges,
            ..
        } = &mut self.scratch.product;
        for first in edges.step_by(N::LANES) {
            let volume = N::load(&region.edge_volumes[first..]);
            let over = N::select_le(volume, N::of(0.0), N::of(0.0), volume.recip());
            let gradient = sums_at_edges::<N>(self.rooms, first, gradients).scaled(over);
            let change = sums_at_edges::<N>(self.rooms, first, changes).scaled(over);
            let at = mean_at_edges::<N, E>(region, law, (first, gradient), relaxing)?;
            let place = (region, relaxing, first);
            let tangent = EdgeTangent::of::<ALL>(&*at, place, self.wanted.kind());
            let own = self.rooms.edges[first / LANES] as usize + first % LANES;
            store(tangent.on(change), &mut at_edges[own..own + N::LANES]);
        }
        Ok(())
    }

    /// Writes the change of the forces at the corners of the tetrahedra of a chunk.
    #[inline(always)]
    fn tets<const ALL: bool, N: Number<Real = f64>, E: Evaluator<N> + ?Sized>(
        &mut self,
        law: &mut E,
        number: usize,
    ) -> Result<(), EvaluationError> {
        let (region, relaxing, wanted) = (self.region, &self.relaxing, self.wanted);
        let rest = &region.rest;
        let is_smoothed = region.is_smoothed();
        let slots = region.chunks[number].slots.clone();
        let Scratch {
            displacement,
            change,
            product,
            ..
        } = &mut *self.scratch;
        let corners = &mut product.corners[self.rooms.corners[number] as usize..];
        let [dilations, changes] = &product.dilations;
        let kept = if is_smoothed { region.kept.tets } else { 0 };
        let [dilations, changes] = [dilations, changes].map(|all| &all[kept..]);
        for first in slots.clone().step_by(N::LANES) {
            let gradient = rest.gradient_of::<N>(first, displacement);
            let change = rest.gradient_of::<N>(first, change);
            let at = law.at(gradient, region.axes.as_ref(), Place::Tets(first));
            let at = &*at;
            let mut dilation_change = N::of(0.0);
            let left = if is_smoothed {
                dilation_change = N::load(&changes[first..]);
                let dilation = N::load(&dilations[first..]);
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
                let edges_of = &self.rooms.edges_of[first..first + N::LANES];
                for (sum, edges) in sums.iter_mut().zip(edges_of) {
                    *sum = rows_of(&product.at_edges, edges);
                }
                stress = stress.plus(N::of(region.edge_share / 6.0), load(&sums));
            }
            if ALL {
                let beside = TangentBeside::of(region, relaxing, first, at.deformation(), wanted);
                stress = beside.with(stress, change);
            }
            let stress = stress.scaled(rest.volumes(first));
            let own = first - slots.start;
            rest.forces(first, stress, &mut corners[4 * (own - own % LANES)..]);
        }
        Ok(())
    }
}

/// The sums, at edges side by side, of gradients in their tetrahedra.
#[inline(always)]
fn sums_at_edges<N: Number<Real = f64>>(
    rooms: &RegionRooms,
    first: usize,
    gradients: &[Rows<f64>],
) -> Tensor<N> {
    let starts = &rooms.starts_at[first..=first + N::LANES];
    let mut sums = [no_rows(); LANES];
    for (sum, range) in sums.iter_mut().zip(starts.windows(2)) {
        let tets = range[0] as usize..range[1] as usize;
        *sum = rows_of(gradients, &rooms.gradients_at[tets]);
    }
    load(&sums)
}

/// The sum of some tensors, all of whose entries are added as one row.
#[inline(always)]
fn rows_of(all: &[Rows<f64>], places: &[u32]) -> Rows<f64> {
    let mut sum = no_rows();
    for place in places {
        add(&mut sum, 1.0, &all[*place as usize]);
    }
    sum
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
            products.all::<false, N, _>(&mut Typed(&self.law))
        }
    }
}

/// The remainder, after relaxation, of the energy of tetrahedra side by side without averages.
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
    let stiffness = region.stiffness_of_patches::<N>(first);
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
    /// The tangent for each share, if there is one.
    linearised: Option<(N, Linearised<'a, N, A>)>,
    /// First derivative of the dilational energy (Pa), if there is no share.
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

    /// Replaces `stresses`, which contains the changes of F, by the changes of the stress.
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
