//! Symmetric 3x3 matrices.

use sinew_tools::vector::{Vector, cross, dot};

/// A matrix by its rows.
pub(crate) type Matrix = [Vector; 3];

/// The product with a vector.
pub(crate) fn times(matrix: &Matrix, vector: Vector) -> Vector {
    matrix.map(|row| dot(row, vector))
}

/// `A^-1 b` by the adjugate; `None` where A is singular.
pub(crate) fn solved(matrix: &Matrix, b: Vector) -> Option<Vector> {
    let [r0, r1, r2] = *matrix;
    let columns = [cross(r1, r2), cross(r2, r0), cross(r0, r1)];
    let determinant = dot(r0, columns[0]);
    let x = [0, 1, 2]
        .map(|axis| (0..3).map(|row| columns[row][axis] * b[row]).sum::<f64>() / determinant);
    x.iter().all(|value| value.is_finite()).then_some(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_is_solved_or_refused() {
        let matrix = [[4.0, 1.0, -0.5], [1.0, 3.0, 0.2], [-0.5, 0.2, 5.0]];
        let x = [0.3, -1.0, 2.0];
        let found = solved(&matrix, times(&matrix, x)).unwrap();
        assert!((0..3).all(|axis| (found[axis] - x[axis]).abs() < 1e-15));
        assert_eq!(solved(&[[0.0; 3]; 3], x), None);
    }
}
