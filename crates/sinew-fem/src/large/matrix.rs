//! The tangent, or the viscosity, as a matrix.

use sinew_core::{AssemblyError, BlockMatrix, ElementStiffness, EvaluationError};

use super::axes::Place;
use super::beside::TangentBeside;
use super::evaluator::{Asked, Untyped};
use super::means::{at_edge, means, require, take_dilation};
use super::memory::Relaxing;
use super::product::{EdgeTangent, OwnTangent, left_of_smoothed, left_of_tets};
use super::region::HyperelasticRegion;
use super::scratch::Scratch;
use super::wanted::Wanted;
use crate::cells::Cells;
use crate::elements::moving_part;
use crate::hyperelastic::Tensor;
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
    /// Changes of F by the displacement of each of its nodes along each axis, and those of the stress (Pa).
    changes: Vec<Tensor<f64>>,
    stresses: Vec<Tensor<f64>>,
    /// Entries (N/m) of a part between all its nodes, row-major and node-major.
    whole: Vec<f64>,
    moving: ElementStiffness,
}

impl Tangents<'_, '_> {
    /// Adds the tangent, or the viscosity, of a region with this law.
    pub(super) fn run(&mut self, law: &dyn Asked) -> Result<(), EvaluationError> {
        law.with(self.wanted, Ok(()), |law| self.add(law))
    }

    fn add(&mut self, law: &mut (dyn Untyped + '_)) -> Result<(), EvaluationError> {
        let Self {
            region,
            scratch,
            relaxing,
            wanted,
            sum,
        } = self;
        let kind = wanted.kind();
        let is_smoothed = region.is_smoothed();
        if is_smoothed {
            means(region, scratch, law, relaxing)?;
        }
        for tet in region.rest.tets() {
            let gradient = match is_smoothed {
                true => scratch.gradient(tet),
                false => region.rest.gradient_of::<f64>(tet, &scratch.displacement),
            };
            let at = law.at_point(gradient, region.axes.as_ref(), Place::Tets(tet));
            let left = if is_smoothed {
                let dilation = scratch.dilations[region.patch_of[tet] as usize];
                left_of_smoothed(region, relaxing, at, (tet, dilation))
            } else {
                require(at, region, relaxing, tet)?;
                left_of_tets(region, relaxing, at, tet)
            };
            let own = OwnTangent::of::<true>(at, left, kind);
            let beside = TangentBeside::of(region, relaxing, tet, at.deformation(), *wanted);
            sum.average.of(std::iter::once(region.tet(tet)));
            sum.add(1.0, |changes, stresses| {
                own.on_all(stresses);
                for (stress, change) in stresses.iter_mut().zip(changes) {
                    *stress = beside.with(*stress, *change);
                }
            })?;
        }
        if !is_smoothed {
            return Ok(());
        }
        for (edge, average) in region.edge_averages().iter().enumerate() {
            let at = at_edge(region, law, edge, &scratch.gradients, relaxing)?;
            let tangent = EdgeTangent::of::<true>(at, (region, relaxing, edge), kind);
            sum.average.clone_from(average);
            let share = region.edge_share / 6.0;
            sum.add(share, |changes, stresses| tangent.on_all(changes, stresses))?;
        }
        for patch in 0..region.patches.count() {
            let lambda = region.stiffness_of_patch(patch) * law.lame().0;
            take_dilation(region, law, patch, scratch, &mut sum.average);
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
            changes: Vec::new(),
            stresses: Vec::new(),
            whole: Vec::new(),
            moving: ElementStiffness::default(),
        }
    }

    /// Adds `V g_aJ H_iJkL g_bL` between the nodes of the average, for a share of its volume V. `tangent` receives
    /// changes of F, and a copy of them to replace by those of the stress.
    fn add(
        &mut self,
        share: f64,
        tangent: impl Fn(&[Tensor<f64>], &mut [Tensor<f64>]),
    ) -> Result<(), AssemblyError> {
        let average = &self.average;
        let volume = self.factor * share * average.volume;
        self.changes.clear();
        for gradient in &average.gradients {
            self.changes.extend([0, 1, 2].map(|k| {
                let mut moved = [0.0; 3];
                moved[k] = volume;
                Tensor::outer(moved, *gradient)
            }));
        }
        self.stresses.clone_from(&self.changes);
        tangent(&self.changes, &mut self.stresses);
        let columns = self.stresses.len();
        self.whole.resize(columns * columns, 0.0);
        for (column, stress) in self.stresses.iter().enumerate() {
            for (a, gradient) in average.gradients.iter().enumerate() {
                for (i, force) in stress.on(*gradient).into_iter().enumerate() {
                    self.whole[(3 * a + i) * columns + column] = force;
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
