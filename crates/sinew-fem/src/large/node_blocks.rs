//! Own blocks of the tangent, or of the viscosity, positive semidefinite in any state.

use sinew_core::EvaluationError;
use sinew_sparse::simd::{InstructionSet, Number, Vectors, WithReal};

use super::axes::point;
use super::beside::{block_beside, carried_block};
use super::chunks::LANES;
use super::kept::{load, store};
use super::means::{at_edges, means, require, take_dilation};
use super::memory::{Points, Relaxing};
use super::product::{left_of_smoothed, left_of_tets};
use super::region::HyperelasticRegion;
use super::scratch::Scratch;
use super::wanted::{OnLaw, Wanted};
use crate::hyperelastic::{Bulk, HyperelasticLaw, Point, Tensor};
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

impl OnLaw for Blocks<'_> {
    type Output = Result<(), EvaluationError>;

    fn run<L: HyperelasticLaw>(mut self, law: L) -> Self::Output {
        let (set, blocks) = (self.set, &mut self);
        if blocks.wanted.has_beside(blocks.region) {
            Sweep::<L, true> { blocks, law }.run::<f64>()?;
        } else {
            f64::with_vectors_or_numbers(set, Sweep::<L, false> { blocks, law })?;
        }
        if self.region.is_smoothed() {
            self.at_edges_and_patches(&law)?;
        }
        Ok(())
    }
}

/// The loop over tetrahedra, for one law. `ALL` is true if it includes the stress beside the law's, which is compiled
/// for plain numbers only.
struct Sweep<'a, 'b, L, const ALL: bool> {
    blocks: &'a mut Blocks<'b>,
    law: L,
}

impl<L: HyperelasticLaw, const ALL: bool> WithReal<f64> for Sweep<'_, '_, L, ALL> {
    type Output = Result<(), EvaluationError>;

    #[inline(always)]
    fn run<N: Number<Real = f64>>(self) -> Self::Output {
        if !ALL && N::LANES == 1 {
            return Sweep::<L, true> {
                blocks: self.blocks,
                law: self.law,
            }
            .run::<f64>();
        }
        let Blocks {
            region,
            scratch,
            relaxing,
            wanted,
            add,
            ..
        } = self.blocks;
        let (rest, law) = (&region.rest, &self.law);
        let is_smoothed = region.is_smoothed();
        if is_smoothed {
            means::<N, L>(region, scratch, law, relaxing, false)?;
            if region.edge_share == 1.0 && !ALL {
                return Ok(());
            }
        }
        let mut lanes = [[[0.0; 4]; 3]; LANES];
        for first in (0..rest.count()).step_by(N::LANES) {
            let gradient = if is_smoothed {
                load::<N>(&scratch.gradients[first..])
            } else {
                rest.gradient_of::<N>(first, &scratch.displacement)
            };
            let at = point(law, gradient, region.axes.as_ref(), first);
            let left = if is_smoothed {
                let patch = |lane: usize| region.patch_of[first + lane] as usize;
                let dilation = N::from_lanes(|lane| scratch.dilations[patch(lane)][0]);
                left_of_smoothed(region, relaxing, law, &at, (first, dilation))
            } else {
                require(law, region, relaxing, &at, first)?;
                left_of_tets(region, relaxing, law, &at, first)
            };
            let gradients = rest.all_gradients::<N>(first);
            for (vertex, gradient) in gradients.into_iter().enumerate() {
                let mut block = own_block(law, &at, left, gradient);
                if ALL {
                    let at = &at.deformation;
                    block = block + block_beside(region, relaxing, first, at, (*wanted, gradient));
                }
                store(block.scaled(rest.volumes(first)), &mut lanes);
                let nodes = rest.nodes_from(vertex, first);
                for (node, block) in nodes.iter().zip(&lanes[..N::LANES]) {
                    add(*node, block.map(|[x, y, z, _]| [x, y, z]));
                }
            }
        }
        Ok(())
    }
}

impl Blocks<'_> {
    /// Adds what belongs to means, where they are taken.
    fn at_edges_and_patches<L: HyperelasticLaw>(self, law: &L) -> Result<(), EvaluationError> {
        let Self {
            region,
            scratch,
            relaxing,
            add,
            ..
        } = self;
        for (edge, average) in region.edge_averages().iter().enumerate() {
            let at = at_edges::<f64, L>(region, law, edge, &scratch.gradients, &relaxing)?;
            let stiffness = region.stiffness_at_edges(edge);
            let left = relaxing.left_of(stiffness, Bulk::none(), law.dilation(&at));
            let volume = region.edge_share / 6.0 * average.volume;
            for (node, gradient) in average.nodes.iter().zip(&average.gradients) {
                let carried = carried_block(&relaxing, (Points::Edges, edge), *gradient);
                let block = own_block(law, &at, left, *gradient) + carried;
                add(*node, block.scaled(volume).0);
            }
        }
        let lambda = relaxing.factor_of_dilation() * law.lame().0;
        let mut average = Average::default();
        for patch in 0..region.patches.count() {
            let lambda = region.stiffness_of_patch(patch) * lambda;
            take_dilation(region, law, patch, scratch, &mut average);
            for (node, gradient) in average.nodes.iter().zip(&average.gradients) {
                let block = Tensor::outer(*gradient, *gradient);
                add(*node, block.scaled(lambda * average.volume).0);
            }
        }
        Ok(())
    }
}

/// The own blocks of nodes, for each m^3, of a share of the local energy and of the dilational one; nothing without a share, as the stress of a patch
/// alone has none.
#[inline(always)]
fn own_block<N: Number, L: HyperelasticLaw>(
    law: &L,
    at: &Point<N, L::Own<N>>,
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
    law.node_block(at, bulk, gradient).scaled(share)
}
