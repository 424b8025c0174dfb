//! Own blocks of the tangent, or of the viscosity, positive semidefinite in any state.

use sinew_core::EvaluationError;
use sinew_sparse::simd::{InstructionSet, Number, Vectors, WithReal};

use super::axes::Place;
use super::beside::{block_beside, carried_block};
use super::chunks::LANES;
use super::evaluator::{Asked, Evaluator, Typed, Untyped};
use super::kept::{load, no_rows, store};
use super::means::{at_edge, means, require, take_dilation};
use super::memory::{Points, Relaxing};
use super::product::{left_of_smoothed, left_of_tets};
use super::region::HyperelasticRegion;
use super::scratch::Scratch;
use super::wanted::{OnLaw, Wanted};
use crate::hyperelastic::{Bulk, HyperelasticLaw, LawAt, Tensor};
use crate::smoothing::Average;

/// Own blocks of nodes, computed by these instructions: calls `add` with each node and parts of its block (N/m).
pub(crate) struct Blocks<'a> {
    pub(super) region: &'a HyperelasticRegion,
    pub(super) scratch: &'a mut Scratch,
    pub(super) relaxing: Relaxing<'a>,
    pub(super) wanted: Wanted,
    pub(super) set: InstructionSet,
    pub(super) add: &'a mut dyn FnMut(u32, [[f64; 3]; 3]),
}

impl Blocks<'_> {
    /// True if plain numbers compute them: vectors do not support the stress in addition to the law's.
    pub(super) fn take_numbers(&self) -> bool {
        self.wanted.has_beside(self.region)
    }

    /// Computes those of tetrahedra with plain numbers.
    pub(super) fn with_numbers(&mut self, law: &dyn Asked) -> Result<(), EvaluationError> {
        law.with(self.wanted, Ok(()), |law| self.tets::<true, f64, _>(law))
    }

    /// Computes those of means, if means are taken.
    pub(super) fn of_means(&mut self, law: &dyn Asked) -> Result<(), EvaluationError> {
        if !self.region.is_smoothed() {
            return Ok(());
        }
        law.with(self.wanted, Ok(()), |law| self.at_edges_and_patches(law))
    }

    /// Computes those of tetrahedra. `ALL` is true if stress in addition to the law's may contribute, which is compiled
    /// for plain numbers only.
    #[inline(always)]
    fn tets<const ALL: bool, N: Number<Real = f64>, E: Evaluator<N> + ?Sized>(
        &mut self,
        law: &mut E,
    ) -> Result<(), EvaluationError> {
        let Self {
            region,
            scratch,
            relaxing,
            wanted,
            add,
            ..
        } = self;
        let rest = &region.rest;
        let is_smoothed = region.is_smoothed();
        if is_smoothed {
            means::<N, E>(region, scratch, law, relaxing)?;
            if region.edge_share == 1.0 && !ALL {
                return Ok(());
            }
        }
        let mut lanes = [no_rows(); LANES];
        for first in (0..rest.count()).step_by(N::LANES) {
            let gradient = if is_smoothed {
                load::<N>(&scratch.gradients[first..])
            } else {
                rest.gradient_of::<N>(first, &scratch.displacement)
            };
            let at = law.at(gradient, region.axes.as_ref(), Place::Tets(first));
            let at = &*at;
            let left = if is_smoothed {
                let patch = |lane: usize| region.patch_of[first + lane] as usize;
                let dilation = N::from_lanes(|lane| scratch.dilations[patch(lane)]);
                left_of_smoothed(region, relaxing, at, (first, dilation))
            } else {
                require(at, region, relaxing, first)?;
                left_of_tets(region, relaxing, at, first)
            };
            let gradients = rest.all_gradients::<N>(first);
            for (vertex, gradient) in gradients.into_iter().enumerate() {
                let mut block = own_block(at, left, gradient);
                if ALL {
                    let at = at.deformation();
                    block = block + block_beside(region, relaxing, first, at, (*wanted, gradient));
                }
                store(block.scaled(rest.volumes(first)), &mut lanes);
                let nodes = rest.nodes_from(vertex, first);
                for (node, block) in nodes.zip(&lanes[..N::LANES]) {
                    let [[xx, xy, xz, _], [yx, yy, yz, _], [zx, zy, zz, _]] = *block;
                    add(node, [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]]);
                }
            }
        }
        Ok(())
    }

    /// Adds the contributions of means, if means are taken.
    fn at_edges_and_patches(
        &mut self,
        law: &mut (dyn Untyped + '_),
    ) -> Result<(), EvaluationError> {
        let Self {
            region,
            scratch,
            relaxing,
            add,
            ..
        } = self;
        for (edge, average) in region.edge_averages().iter().enumerate() {
            let at = at_edge(region, law, edge, &scratch.gradients, relaxing)?;
            let stiffness = region.stiffness_at_edges(edge);
            let left = relaxing.left_of(stiffness, Bulk::none(), at.dilation());
            let volume = region.edge_share / 6.0 * average.volume;
            for (node, gradient) in average.nodes.iter().zip(&average.gradients) {
                let carried = carried_block(relaxing, (Points::Edges, edge), *gradient);
                let block = own_block(at, left, *gradient) + carried;
                add(*node, block.scaled(volume).0);
            }
        }
        let mut average = Average::default();
        for patch in 0..region.patches.count() {
            let lambda = region.stiffness_of_patch(patch) * law.lame().0;
            take_dilation(region, law, patch, scratch, &mut average);
            let lambda = relaxing.factor_of_dilation() * lambda;
            for (node, gradient) in average.nodes.iter().zip(&average.gradients) {
                let block = Tensor::outer(*gradient, *gradient);
                add(*node, block.scaled(lambda * average.volume).0);
            }
        }
        Ok(())
    }
}

/// [`Blocks`] with the type of the law.
pub(super) struct OfLaw<'b, 'a> {
    pub(super) blocks: &'b mut Blocks<'a>,
    pub(super) untyped: &'b dyn Asked,
}

impl OnLaw for OfLaw<'_, '_> {
    type Output = Result<(), EvaluationError>;

    fn run<L: HyperelasticLaw>(self, law: L) -> Self::Output {
        f64::with_vectors_or_numbers(self.blocks.set, Sweep { of: self, law })
    }
}

struct Sweep<'b, 'a, L> {
    of: OfLaw<'b, 'a>,
    law: L,
}

impl<L: HyperelasticLaw> WithReal<f64> for Sweep<'_, '_, L> {
    type Output = Result<(), EvaluationError>;

    #[inline(always)]
    fn run<N: Number<Real = f64>>(self) -> Self::Output {
        let OfLaw { blocks, untyped } = self.of;
        if N::LANES == 1 {
            blocks.with_numbers(untyped)
        } else {
            blocks.tets::<false, N, _>(&mut Typed(&self.law))
        }
    }
}

/// The own blocks of nodes, for each m^3, of a share of the local energy and of the dilational one; zero without a
/// share, since the stress of a patch alone has no own block.
#[inline(always)]
fn own_block<N: Number, A: LawAt<N> + ?Sized>(
    at: &A,
    (share, bulk): (N, Bulk<N>),
    gradient: [N; 3],
) -> Tensor<N> {
    if N::all_le(share, N::of(0.0)) {
        return Tensor::zero();
    }
    let bulk = Bulk {
        stress: bulk.stress / share,
        modulus: bulk.modulus / share,
    };
    at.node_block(bulk, gradient).scaled(share)
}
