//! Matrices written out in full.

use sinew_core::{BlockMatrix, LinearOperators};

/// Rounding, relative to the sizes of the terms of a sum.
pub const ROUNDING: f64 = 1e-13;

/// A square matrix, row by row.
pub type Dense = Vec<Vec<f64>>;

/// Every entry, including zeros between cells that are not neighbours.
pub fn dense(matrix: &BlockMatrix) -> Dense {
    let layers = matrix.layers().count();
    let entry = |i: usize, j: usize| {
        let block = matrix.block(i / layers, j / layers);
        block.map_or(0.0, |block| block[(i % layers) * layers + j % layers])
    };
    let dofs = 0..matrix.dofs();
    dofs.clone()
        .map(|i| dofs.clone().map(|j| entry(i, j)).collect())
        .collect()
}

/// D = alpha M + beta K + extra.
pub fn dense_damping(operators: &LinearOperators) -> Dense {
    let damping = operators.damping();
    let extra = damping.extra.as_deref().map(dense);
    let mut matrix = dense(operators.stiffness());
    for (i, row) in matrix.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            *entry *= damping.stiffness;
            if i == j {
                *entry += damping.mass * operators.mass()[i];
            }
            *entry += extra.as_ref().map_or(0.0, |extra| extra[i][j]);
        }
    }
    matrix
}

/// The sum of one row times a vector, and that of the sizes of its terms, a scale for rounding.
pub fn row_product(row: &[f64], x: &[f64]) -> (f64, f64) {
    let terms = row.iter().zip(x).map(|(entry, x)| entry * x);
    terms.fold((0.0, 0.0), |(sum, size), term| {
        (sum + term, size + f64::abs(term))
    })
}
