//! The axes of loads.

use super::error::HomogeneousError;
use crate::frame::{frame, unit};
use crate::hyperelastic::Tensor;

/// Three perpendicular axes: the first is that of the pull, the second the other one in a sheet's plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes([[f64; 3]; 3]);

impl Axes {
    /// Axes with the first along a vector. The second is the mesh's axis after the one nearest to the vector, without
    /// its part along the vector: `y` for a pull along `x`, `z` for one along `y`, `x` for one along `z`.
    ///
    /// # Errors
    ///
    /// [`HomogeneousError::NoAxis`].
    pub fn along(vector: [f64; 3]) -> Result<Self, HomogeneousError> {
        let first = unit(vector).ok_or(HomogeneousError::NoAxis)?;
        let by_size = |i: &usize, j: &usize| first[*i].abs().total_cmp(&first[*j].abs());
        // Of equal ones the first.
        let nearest = (0..3).rev().max_by(by_size).unwrap_or_default();
        let mut second = [0.0; 3];
        second[(nearest + 1) % 3] = 1.0;
        frame(first, second)
            .map(Self)
            .ok_or(HomogeneousError::NoAxis)
    }

    /// Axes with the first along a vector, and the second along the part of another vector that is perpendicular to it.
    ///
    /// # Errors
    ///
    /// [`HomogeneousError::NoAxis`] for a vector without direction, [`HomogeneousError::NoSecondAxis`] for two along one
    /// line.
    pub fn spanned(first: [f64; 3], second: [f64; 3]) -> Result<Self, HomogeneousError> {
        let first = unit(first).ok_or(HomogeneousError::NoAxis)?;
        let second = unit(second).ok_or(HomogeneousError::NoAxis)?;
        frame(first, second)
            .map(Self)
            .ok_or(HomogeneousError::NoSecondAxis)
    }

    /// The axes as unit vectors.
    #[must_use]
    pub fn vectors(&self) -> [[f64; 3]; 3] {
        self.0
    }

    /// A tensor given in these axes, in those of the mesh.
    pub(super) fn in_mesh(&self, entries: [[f64; 3]; 3]) -> Tensor<f64> {
        Tensor(entries).out_of_axes(Tensor(self.0))
    }

    /// A tensor given in the axes of the mesh, in these.
    pub(super) fn of_mesh(&self, tensor: Tensor<f64>) -> [[f64; 3]; 3] {
        tensor.in_axes(Tensor(self.0)).0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hyperelastic::dot;

    #[test]
    fn axes_are_at_right_angles_and_right_handed() {
        for vector in [
            [2.0, 0.0, 0.0],
            [0.0, -3.0, 0.0],
            [1.0, 1.0, 1.0],
            [0.2, -0.4, 5.0],
        ] {
            let axes = Axes::along(vector).unwrap();
            let rows = Tensor(axes.vectors());
            assert!((rows.times_transposed(rows) - Tensor::identity()).largest() < 1e-15);
            assert!((dot(rows.0[0], rows.cofactor().0[0]) - 1.0).abs() < 1e-15);
        }
        let second = |vector| Axes::along(vector).unwrap().vectors()[1];
        assert_eq!(second([1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]);
        assert_eq!(second([0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
        assert_eq!(second([0.0, 0.0, 1.0]), [1.0, 0.0, 0.0]);
    }

    #[test]
    fn tensors_go_to_other_axes_and_back() {
        let axes = Axes::along([1.0, 2.0, -0.5]).unwrap();
        let entries = [[1.0, 2.0, 3.0], [-4.0, 5.0, 6.0], [7.0, 8.0, -9.0]];
        let again = axes.of_mesh(axes.in_mesh(entries));
        assert!((Tensor(again) - Tensor(entries)).largest() < 1e-14);
        let [first, ..] = axes.vectors();
        let along = axes.in_mesh([[2.0, 0.0, 0.0], [0.0; 3], [0.0; 3]]);
        assert!((along - Tensor::outer(first, first).scaled(2.0)).largest() < 1e-15);
    }

    #[test]
    fn a_second_axis_is_taken_as_far_as_it_is_across() {
        let axes = Axes::spanned([0.0, 0.0, 2.0], [3.0, 0.0, 5.0]).unwrap();
        let expected = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(axes.vectors(), expected);
        let parallel = Axes::spanned([1.0, 1.0, 0.0], [-2.0, -2.0, 0.0]);
        assert_eq!(parallel, Err(HomogeneousError::NoSecondAxis));
    }

    #[test]
    fn an_axis_has_a_direction() {
        for vector in [[0.0; 3], [f64::NAN, 0.0, 0.0]] {
            assert_eq!(Axes::along(vector), Err(HomogeneousError::NoAxis));
        }
    }
}
