//! Vectors of three coordinates, and the inverse of a small matrix.

use std::ops::{Add, AddAssign, Div, Index, IndexMut, Mul, Neg, Sub};

/// A vector along x, y and z.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Vector3(pub(crate) [f64; 3]);

impl Vector3 {
    pub(crate) const ZERO: Self = Self([0.0; 3]);

    /// The unit vectors along x, y and z.
    pub(crate) const AXES: [Self; 3] = [
        Self([1.0, 0.0, 0.0]),
        Self([0.0, 1.0, 0.0]),
        Self([0.0, 0.0, 1.0]),
    ];

    pub(crate) fn dot(self, other: Self) -> f64 {
        let (Self(a), Self(b)) = (self, other);
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    pub(crate) fn cross(self, other: Self) -> Self {
        let (Self(a), Self(b)) = (self, other);
        Self([
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ])
    }

    pub(crate) fn norm_squared(self) -> f64 {
        self.dot(self)
    }

    pub(crate) fn norm(self) -> f64 {
        self.norm_squared().sqrt()
    }

    /// The unit vector in this direction.
    pub(crate) fn normalize(self) -> Self {
        self / self.norm()
    }
}

impl From<[f64; 3]> for Vector3 {
    fn from(coordinates: [f64; 3]) -> Self {
        Self(coordinates)
    }
}

impl From<Vector3> for [f64; 3] {
    fn from(vector: Vector3) -> Self {
        vector.0
    }
}

impl Index<usize> for Vector3 {
    type Output = f64;

    fn index(&self, axis: usize) -> &f64 {
        &self.0[axis]
    }
}

impl IndexMut<usize> for Vector3 {
    fn index_mut(&mut self, axis: usize) -> &mut f64 {
        &mut self.0[axis]
    }
}

impl Add for Vector3 {
    type Output = Self;

    fn add(self, Self(b): Self) -> Self {
        let Self(a) = self;
        Self([a[0] + b[0], a[1] + b[1], a[2] + b[2]])
    }
}

impl AddAssign for Vector3 {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Vector3 {
    type Output = Self;

    fn sub(self, Self(b): Self) -> Self {
        let Self(a) = self;
        Self([a[0] - b[0], a[1] - b[1], a[2] - b[2]])
    }
}

impl Neg for Vector3 {
    type Output = Self;

    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl Mul<f64> for Vector3 {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self(self.0.map(|x| x * factor))
    }
}

impl Div<f64> for Vector3 {
    type Output = Self;

    fn div(self, divisor: f64) -> Self {
        Self(self.0.map(|x| x / divisor))
    }
}

/// The inverse by elimination with row pivoting (Golub and Van Loan, Matrix Computations, section 3.4).
///
/// `None` for a singular matrix.
pub(crate) fn inverse<const N: usize>(mut matrix: [[f64; N]; N]) -> Option<[[f64; N]; N]> {
    let mut inverse: [[f64; N]; N] =
        std::array::from_fn(|row| std::array::from_fn(|column| f64::from(row == column)));
    for column in 0..N {
        let size = |row: &usize| matrix[*row][column].abs();
        let pivot = (column..N).max_by(|a, b| size(a).total_cmp(&size(b)))?;
        matrix.swap(column, pivot);
        inverse.swap(column, pivot);
        let divisor = matrix[column][column];
        if divisor == 0.0 {
            return None;
        }
        for entry in matrix[column].iter_mut().chain(&mut inverse[column]) {
            *entry /= divisor;
        }
        let (source, result) = (matrix[column], inverse[column]);
        for row in (0..N).filter(|row| *row != column) {
            let factor = matrix[row][column];
            for at in 0..N {
                matrix[row][at] -= factor * source[at];
                inverse[row][at] -= factor * result[at];
            }
        }
    }
    Some(inverse)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_times_its_inverse_is_one_whatever_rows_need_exchanging() {
        // Zeros on the diagonal: without pivoting there is no inverse.
        let matrix = [
            [0.0, 2.0, 0.0, 1.0],
            [3.0, 0.0, 1.0, 0.0],
            [0.0, 1.0, 0.0, 4.0],
            [1.0, 0.0, 5.0, 1.0],
        ];
        let library = nalgebra::Matrix4::from_fn(|i, j| matrix[i][j]);
        let expected = library.try_inverse().unwrap();
        let inverse = inverse(matrix).unwrap();
        for (i, row) in inverse.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                assert!((entry - expected[(i, j)]).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn a_singular_matrix_has_no_inverse() {
        assert_eq!(inverse([[1.0, 2.0], [2.0, 4.0]]), None);
    }

    #[test]
    fn the_cross_product_stands_on_both_and_measures_their_area() {
        let (a, b) = (Vector3([1.0, 2.0, 3.0]), Vector3([-2.0, 0.5, 4.0]));
        let normal = a.cross(b);
        assert!(normal.dot(a).abs() < 1e-14 && normal.dot(b).abs() < 1e-14);
        // Lagrange's identity.
        let area = a.norm_squared() * b.norm_squared() - a.dot(b).powi(2);
        assert!((normal.norm_squared() - area).abs() < 1e-12);
        assert!((normal.normalize().norm() - 1.0).abs() < 1e-15);
    }
}
