//! Own blocks of the tangent, positive semidefinite in any state.

use sinew_core::EvaluationError;

use super::means::{at_edge, bulk_of_patch, check, means, take_dilation};
use super::region::HyperelasticRegion;
use super::scratch::Scratch;
use crate::hyperelastic::{Bulk, HyperelasticLaw, LawVisitor, Tensor};
use crate::smoothing::Average;

/// Calls `add` with each node and parts of its block (N/m).
pub(super) fn add(
    region: &HyperelasticRegion,
    scratch: &mut Scratch,
    add: &mut impl FnMut(u32, [[f64; 3]; 3]),
) -> Result<(), EvaluationError> {
    region.law.with_law(Blocks {
        region,
        scratch,
        add,
    })
}

struct Blocks<'a, F> {
    region: &'a HyperelasticRegion,
    scratch: &'a mut Scratch,
    add: &'a mut F,
}

impl<F: FnMut(u32, [[f64; 3]; 3])> LawVisitor for Blocks<'_, F> {
    type Output = Result<(), EvaluationError>;

    fn visit<L: HyperelasticLaw>(self, law: L) -> Self::Output {
        let Self {
            region,
            scratch,
            add,
        } = self;
        let (rest, lambda) = (&region.rest, law.lame().0);
        if !region.is_smoothed() {
            for tet in rest.tets() {
                let at = law.at(rest.gradient_of::<f64>(tet, &scratch.displacement));
                check(&law, &at, rest.tag(tet))?;
                let bulk = law.own_bulk(&at);
                for (node, gradient) in rest.nodes(tet).into_iter().zip(rest.all_gradients(tet)) {
                    let block = law.node_block(&at, bulk, gradient);
                    add(node, block.scaled(rest.volume(tet)).0);
                }
            }
            return Ok(());
        }
        means(region, scratch, &law)?;
        let share = 1.0 - region.edge_share;
        for tet in rest.tets().filter(|_| share > 0.0) {
            let at = law.at(scratch.gradients[tet]);
            let [dilation, _] = scratch.dilations[region.patch_of[tet] as usize];
            let bulk = bulk_of_patch(lambda, dilation / share);
            for (node, gradient) in rest.nodes(tet).into_iter().zip(rest.all_gradients(tet)) {
                let block = law.node_block(&at, bulk, gradient);
                add(node, block.scaled(share * rest.volume(tet)).0);
            }
        }
        for (edge, average) in region.edge_averages().iter().enumerate() {
            let at = at_edge(region, &law, region.edges.of(edge), scratch)?;
            let volume = region.edge_share / 6.0 * average.volume;
            for (node, gradient) in average.nodes.iter().zip(&average.gradients) {
                let block = law.node_block(&at, Bulk::none(), *gradient);
                add(*node, block.scaled(volume).0);
            }
        }
        let mut average = Average::default();
        for patch in 0..region.patches.count() {
            take_dilation(region, &law, patch, scratch, &mut average);
            for (node, gradient) in average.nodes.iter().zip(&average.gradients) {
                let block = Tensor::outer(*gradient, *gradient);
                add(*node, block.scaled(lambda * average.volume).0);
            }
        }
        Ok(())
    }
}
