//! The free strains of a load, at which their stresses vanish.

use nalgebra::{DMatrix, DVector};

use super::axes::Axes;
use super::load::Load;
use super::solid::Solid;
use crate::hyperelastic::Tensor;

/// A load on a material along some axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Loaded<'a> {
    pub(super) solid: &'a Solid,
    pub(super) axes: &'a Axes,
    pub(super) load: Load,
}

const MOST_STEPS: usize = 60;
/// Least share of a Newton step that is tried.
const LEAST_SHARE: f64 = 1e-4;
/// Tolerances of the remaining stress: relative to the largest stress, and relative to the largest stiffness, since
/// rounding near incompressibility is some 1e-16 of the latter.
const LEFT: [f64; 2] = [1e-9, 1e-12];

impl Loaded<'_> {
    /// The gradient of the displacement in the axes of the mesh.
    pub(super) fn gradient(&self, amount: f64, free: &DVector<f64>) -> Tensor<f64> {
        let mut h = self.load.prescribed(amount);
        for ((row, column), value) in self.load.free().iter().zip(free.iter()) {
            h[*row][*column] = *value;
        }
        self.axes.in_mesh(h)
    }

    /// Free strains at rest.
    pub(super) fn at_rest(&self) -> DVector<f64> {
        DVector::zeros(self.load.free().len())
    }

    /// The stresses (Pa) that must vanish, and the largest of all stresses.
    fn residual(&self, h: Tensor<f64>) -> Option<(DVector<f64>, f64)> {
        let stress = self.axes.of_mesh(self.solid.stress(h)?);
        let free = self.load.free().iter();
        let residual = free.map(|(row, column)| stress[*row][*column]);
        let residual = DVector::from_iterator(self.load.free().len(), residual);
        Some((residual, Tensor(stress).largest()))
    }

    /// The derivative of these stresses with respect to the free strains.
    fn slopes(&self, h: Tensor<f64>) -> DMatrix<f64> {
        let free = self.load.free();
        let mut slopes = DMatrix::zeros(free.len(), free.len());
        for (place, (row, column)) in free.iter().enumerate() {
            let mut change = [[0.0; 3]; 3];
            change[*row][*column] = 1.0;
            let change = self.axes.in_mesh(change);
            let stress = self.axes.of_mesh(self.solid.tangent(h, change));
            for (of, (row, column)) in free.iter().enumerate() {
                slopes[(of, place)] = stress[*row][*column];
            }
        }
        slopes
    }

    /// Newton's method with a line search on the stresses; `None` if it finds no equilibrium.
    pub(super) fn solve(&self, amount: f64, guess: &DVector<f64>) -> Option<DVector<f64>> {
        let mut free = guess.clone();
        let mut at = self.gradient(amount, &free);
        let (mut residual, mut largest) = self.residual(at)?;
        let mut stiffness = 0.0;
        for _ in 0..MOST_STEPS {
            let left = residual.amax();
            if left == 0.0 {
                return Some(free);
            }
            let slopes = self.slopes(at);
            stiffness = slopes.amax();
            let Some(step) = slopes.lu().solve(&residual) else {
                break;
            };
            let better = |share: &f64| {
                let tried = &free - *share * &step;
                let h = self.gradient(amount, &tried);
                let (residual, largest) = self.residual(h)?;
                (residual.amax() < left).then_some((tried, h, residual, largest))
            };
            let shares = std::iter::successors(Some(1.0), |share| Some(0.5 * share));
            let mut shares = shares.take_while(|share| *share > LEAST_SHARE);
            let Some((tried, h, next, next_largest)) = shares.find_map(|share| better(&share))
            else {
                break;
            };
            (free, at, residual, largest) = (tried, h, next, next_largest);
        }
        let [of_stress, of_stiffness] = LEFT;
        let bound = of_stress * largest + of_stiffness * stiffness;
        (residual.amax() <= bound).then_some(free)
    }
}
