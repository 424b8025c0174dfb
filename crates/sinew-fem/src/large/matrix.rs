//! The tangent, or the viscosity, as a matrix.

use sinew_core::{AssemblyError, BlockMatrix, ElementStiffness, EvaluationError};

use super::axes::point;
use super::beside::TangentBeside;
use super::means::{at_edges, means, require, take_dilation};
use super::memory::Relaxing;
use super::product::{EdgeTangent, OwnTangent, left_of_smoothed, left_of_tets};
use super::region::HyperelasticRegion;
use super::scratch::Scratch;
use super::wanted::{OnLaw, Wanted};
use crate::cells::Cells;
use crate::elements::moving_part;
use crate::hyperelastic::{Deformation, HyperelasticLaw, Tensor};
use crate::smoothing::Average;

/// The tangent, or the viscosity, of a region, which is added to a matrix.
pub(crate) struct Tangents<'a, 'o> {
    pub(super) region: &'a HyperelasticRegion,
    pub(super) scratch: &'a mut Scratch,
    pub(super) relaxing: Relaxing<'a>,
    pub(super) wanted: Wanted,
    pub(super) sum: &'a mut Sum<'o>,
}

/// The matrix, and scratch space for one part of it.
pub(crate) struct Sum<'o> {
    cells: &'o Cells,
    /// Factor of the tangent that is added.
    factor: f64,
    out: &'o mut BlockMatrix,
    average: Average,
    /// Entries (N/m) of a part between all its nodes, row-major and node-major.
    whole: Vec<f64>,
    moving: ElementStiffness,
}

impl OnLaw for Tangents<'_, '_> {
    type Output = Result<(), EvaluationError>;

    fn run<L: HyperelasticLaw>(self, law: L) -> Self::Output {
        let Self {
            region,
            scratch,
            relaxing,
            wanted,
            sum,
        } = self;
        let kind = wanted.kind();
        let (rest, lambda) = (&region.rest, law.lame().0);
        let beside_of = |tet: usize, deformation: &Deformation<f64>| {
            TangentBeside::of(region, &relaxing, tet, deformation, wanted)
        };
        if !region.is_smoothed() {
            for tet in rest.tets() {
                let gradient = rest.gradient_of::<f64>(tet, &scratch.displacement);
                let at = point(&law, gradient, region.axes.as_ref(), tet);
                require(&law, region, &relaxing, &at, tet)?;
                let left = left_of_tets(region, &relaxing, &law, &at, tet);
                let own = OwnTangent::of(&law, &at, left, kind);
                let beside = beside_of(tet, &at.deformation);
                sum.average.of(std::iter::once(region.tet(tet)));
                sum.add(1.0, |change| beside.with(own.on(change), change))?;
            }
            return Ok(());
        }
        means::<f64, L>(region, scratch, &law, &relaxing, false)?;
        for tet in rest.tets() {
            let at = point(&law, scratch.gradient(tet), region.axes.as_ref(), tet);
            let [dilation, _] = scratch.dilations[region.patch_of[tet] as usize];
            let left = left_of_smoothed(region, &relaxing, &law, &at, (tet, dilation));
            let own = OwnTangent::of(&law, &at, left, kind);
            let beside = beside_of(tet, &at.deformation);
            sum.average.of(std::iter::once(region.tet(tet)));
            sum.add(1.0, |change| beside.with(own.on(change), change))?;
        }
        for (edge, average) in region.edge_averages().iter().enumerate() {
            let at = at_edges::<f64, L>(region, &law, edge, &scratch.gradients, &relaxing)?;
            let tangent = EdgeTangent::of(&law, &at, (region, &relaxing, edge), kind);
            sum.average.clone_from(average);
            sum.add(region.edge_share / 6.0, |change| tangent.on(change))?;
        }
        for patch in 0..region.patches.count() {
            take_dilation(region, &law, patch, scratch, &mut sum.average);
            let lambda = region.stiffness_of_patch(patch) * lambda;
            let lambda = relaxing.factor_of_dilation() * lambda;
            let share = sum.factor;
            sum.average.stiffness(share, [lambda, 0.0], &mut sum.whole);
            sum.add_whole()?;
        }
        Ok(())
    }
}

impl<'o> Sum<'o> {
    /// The matrix `out`, to which `factor` times a tangent is added.
    pub(super) fn new(cells: &'o Cells, factor: f64, out: &'o mut BlockMatrix) -> Self {
        Self {
            cells,
            factor,
            out,
            average: Average::default(),
            whole: Vec::new(),
            moving: ElementStiffness::default(),
        }
    }

    /// Adds `V g_aJ H_iJkL g_bL` between the nodes of the average, for a share of its volume V.
    fn add(
        &mut self,
        share: f64,
        tangent: impl Fn(Tensor<f64>) -> Tensor<f64>,
    ) -> Result<(), AssemblyError> {
        let average = &self.average;
        let volume = self.factor * share * average.volume;
        let columns = 3 * average.nodes.len();
        self.whole.clear();
        self.whole.resize(columns * columns, 0.0);
        for (b, gradient) in average.gradients.iter().enumerate() {
            for k in 0..3 {
                let mut moved = [0.0; 3];
                moved[k] = volume;
                let stress = tangent(Tensor::outer(moved, *gradient));
                for (a, gradient) in average.gradients.iter().enumerate() {
                    for (i, force) in stress.on(*gradient).into_iter().enumerate() {
                        self.whole[(3 * a + i) * columns + 3 * b + k] = force;
                    }
                }
            }
        }
        self.add_whole()
    }

    fn add_whole(&mut self) -> Result<(), AssemblyError> {
        moving_part(
            &self.whole,
            &self.average.nodes,
            self.cells,
            &mut self.moving,
        );
        self.out
            .add_element(&self.moving.cells, &self.moving.matrix)
    }
}
