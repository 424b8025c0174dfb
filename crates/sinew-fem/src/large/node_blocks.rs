//! Own blocks of the tangent, positive semidefinite in any state.

use sinew_core::EvaluationError;

use super::beside::{block_beside, carried_block};
use super::means::{at_edge, check, means, take_dilation};
use super::memory::{Past, Points, Relaxing};
use super::product::{left_of_smoothed, left_of_tet};
use super::region::HyperelasticRegion;
use super::scratch::Scratch;
use crate::hyperelastic::{Bulk, HyperelasticLaw, LawVisitor, Point, Tensor};
use crate::smoothing::Average;

/// Calls `add` with each node and parts of its block (N/m).
pub(super) fn add(
    region: &HyperelasticRegion,
    scratch: &mut Scratch,
    past: Past<'_>,
    add: &mut impl FnMut(u32, [[f64; 3]; 3]),
) -> Result<(), EvaluationError> {
    region.law.with_law(Blocks {
        region,
        scratch,
        relaxing: Relaxing::of(region.memory.as_ref(), past),
        add,
    })
}

struct Blocks<'a, F> {
    region: &'a HyperelasticRegion,
    scratch: &'a mut Scratch,
    relaxing: Relaxing<'a>,
    add: &'a mut F,
}

impl<F: FnMut(u32, [[f64; 3]; 3])> LawVisitor for Blocks<'_, F> {
    type Output = Result<(), EvaluationError>;

    fn visit<L: HyperelasticLaw>(self, law: L) -> Self::Output {
        let Self {
            region,
            scratch,
            relaxing,
            add,
        } = self;
        let (rest, lambda) = (&region.rest, law.lame().0);
        if !region.is_smoothed() {
            for tet in rest.tets() {
                let at = law.at(rest.gradient_of::<f64>(tet, &scratch.displacement));
                check(region, &law, &relaxing, &at, tet)?;
                let left = left_of_tet(region, &relaxing, &law, &at, tet);
                for (node, gradient) in rest.nodes(tet).into_iter().zip(rest.all_gradients(tet)) {
                    let beside = block_beside(region, &relaxing, tet, &at.deformation, gradient);
                    let block = own_block(&law, &at, left, gradient) + beside;
                    add(node, block.scaled(rest.volume(tet)).0);
                }
            }
            return Ok(());
        }
        means(region, scratch, &law, &relaxing)?;
        let share = 1.0 - region.edge_share;
        let has_beside = region.fibres.is_some() || relaxing.is_there();
        for tet in rest.tets().filter(|_| share > 0.0 || has_beside) {
            let at = law.at(scratch.gradients[tet]);
            let [dilation, _] = scratch.dilations[region.patch_of[tet] as usize];
            let left = left_of_smoothed(region, &relaxing, &law, &at, (tet, dilation));
            for (node, gradient) in rest.nodes(tet).into_iter().zip(rest.all_gradients(tet)) {
                let beside = block_beside(region, &relaxing, tet, &at.deformation, gradient);
                let block = own_block(&law, &at, left, gradient) + beside;
                add(node, block.scaled(rest.volume(tet)).0);
            }
        }
        for (edge, average) in region.edge_averages().iter().enumerate() {
            let at = at_edge(region, &law, region.edges.of(edge), scratch, &relaxing)?;
            let stiffness = region.stiffness_at_edge(edge);
            let left = relaxing.left_of(stiffness, Bulk::none(), law.dilation(&at));
            let volume = region.edge_share / 6.0 * average.volume;
            for (node, gradient) in average.nodes.iter().zip(&average.gradients) {
                let carried = carried_block(&relaxing, (Points::Edges, edge), *gradient);
                let block = own_block(&law, &at, left, *gradient) + carried;
                add(*node, block.scaled(volume).0);
            }
        }
        let lambda = relaxing.factor_of_dilation() * lambda;
        let mut average = Average::default();
        for patch in 0..region.patches.count() {
            let lambda = region.stiffness_of_patch(patch) * lambda;
            take_dilation(region, &law, patch, scratch, &mut average);
            for (node, gradient) in average.nodes.iter().zip(&average.gradients) {
                let block = Tensor::outer(*gradient, *gradient);
                add(*node, block.scaled(lambda * average.volume).0);
            }
        }
        Ok(())
    }
}

/// A node's own block, for each m^3, of a share of the local energy and of the dilational one; nothing without a share, as the stress of a patch
/// alone has none.
fn own_block<L: HyperelasticLaw>(
    law: &L,
    at: &Point<f64, L::Own<f64>>,
    (share, bulk): (f64, Bulk<f64>),
    gradient: [f64; 3],
) -> Tensor<f64> {
    if share == 0.0 {
        return Tensor::zero();
    }
    let bulk = Bulk {
        stress: bulk.stress / share,
        modulus: bulk.modulus / share,
    };
    law.node_block(at, bulk, gradient).scaled(share)
}
