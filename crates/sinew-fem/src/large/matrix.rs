//! The tangent, or the viscosity, as a matrix.

use sinew_core::{AssemblyError, BlockMatrix, ElementStiffness, EvaluationError};

use super::beside::TangentBeside;
use super::means::{at_edges, means, require, take_dilation};
use super::memory::{Past, Relaxing};
use super::product::{EdgeTangent, OwnTangent, left_of_smoothed, left_of_tets};
use super::region::HyperelasticRegion;
use super::scratch::Scratch;
use super::wanted::Wanted;
use crate::cells::Cells;
use crate::elements::moving_part;
use crate::hyperelastic::{Deformation, HyperelasticLaw, LawVisitor, Tensor};
use crate::smoothing::Average;

/// Adds so many times the tangent, or the viscosity, of a region.
///
/// # Errors
/// [`EvaluationError`] when the law is outside its domain, or the matrix has no block for a coupling.
pub(super) fn add(
    region: &HyperelasticRegion,
    scratch: &mut Scratch,
    past: Past<'_>,
    wanted: Wanted,
    (cells, factor, out): (&Cells, f64, &mut BlockMatrix),
) -> Result<(), EvaluationError> {
    let mut sum = Sum {
        cells,
        factor,
        out,
        average: Average::default(),
        whole: Vec::new(),
        moving: ElementStiffness::default(),
    };
    let tangents = Tangents {
        region,
        scratch,
        relaxing: wanted.relaxing(region, past),
        wanted,
        sum: &mut sum,
    };
    wanted.with_law(region, tangents)
}

struct Tangents<'a, 'o> {
    region: &'a HyperelasticRegion,
    scratch: &'a mut Scratch,
    relaxing: Relaxing<'a>,
    wanted: Wanted,
    sum: &'a mut Sum<'o>,
}

/// The matrix, and room for one part of it.
struct Sum<'o> {
    cells: &'o Cells,
    /// By which it is multiplied.
    factor: f64,
    out: &'o mut BlockMatrix,
    average: Average,
    /// Entries (N/m) of a part between all its nodes, row-major and node-major.
    whole: Vec<f64>,
    moving: ElementStiffness,
}

impl LawVisitor for Tangents<'_, '_> {
    type Output = Result<(), EvaluationError>;

    fn visit<L: HyperelasticLaw>(self, law: L) -> Self::Output {
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
                let at = law.at(rest.gradient_of::<f64>(tet, &scratch.displacement));
                require::<L, f64>(region, &relaxing, &at.deformation, tet)?;
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
            let at = law.at(scratch.gradient(tet));
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

impl Sum<'_> {
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
