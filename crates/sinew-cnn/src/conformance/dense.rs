//! Matrices written out in full, and their exponential.

use sinew_core::{BlockMatrix, LinearOperators};

/// A square matrix, row by row.
pub(super) type Dense = Vec<Vec<f64>>;

pub(super) fn zeros(n: usize) -> Dense {
    vec![vec![0.0; n]; n]
}

/// All entries of a matrix, zeros between cells that are not neighbours included.
pub(super) fn dense(matrix: &BlockMatrix) -> Dense {
    let layers = matrix.layers().count();
    let mut rows = zeros(matrix.dofs());
    for (i, row) in rows.iter_mut().enumerate() {
        for (cell, block) in matrix.row_blocks(i / layers) {
            let of_layer = &block[i % layers * layers..][..layers];
            row[cell * layers..][..layers].copy_from_slice(of_layer);
        }
    }
    rows
}

/// D = alpha M + beta K + E.
pub(super) fn dense_damping(operators: &LinearOperators) -> Dense {
    let damping = operators.damping();
    let mut rows = dense(operators.stiffness());
    let extra = damping.extra.as_deref().map(dense);
    for (i, row) in rows.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            *entry *= damping.stiffness;
            *entry += extra.as_ref().map_or(0.0, |extra| extra[i][j]);
        }
        row[i] += damping.mass * operators.mass()[i];
    }
    rows
}

/// A row times a vector.
pub(super) fn dot(row: &[f64], x: &[f64]) -> f64 {
    row.iter().zip(x).map(|(entry, x)| entry * x).sum()
}

fn product(a: &Dense, b: &Dense) -> Dense {
    let n = a.len();
    let mut out = zeros(n);
    for (row, a) in out.iter_mut().zip(a) {
        for (a, b) in a.iter().zip(b) {
            if *a != 0.0 {
                for (out, b) in row.iter_mut().zip(b) {
                    *out += a * b;
                }
            }
        }
    }
    out
}

/// e^A by its Taylor series, scaled and squared (Moler and Van Loan, SIAM Review 45, 2003, method 3).
pub(super) fn exponential(a: &Dense) -> Dense {
    let n = a.len();
    let norm = a.iter().map(|row| row.iter().map(|x| x.abs()).sum::<f64>());
    let norm = norm.fold(0.0, f64::max);
    let squarings = norm.max(1.0).log2().ceil() as i32 + 2;
    let scale = 0.5_f64.powi(squarings);
    let mut small = a.clone();
    small.iter_mut().flatten().for_each(|entry| *entry *= scale);
    let mut identity = zeros(n);
    for (i, row) in identity.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    // Horner's rule: 1 + A (1 + A/2 (1 + A/3 (..))); the norm of A is below 1/2.
    let mut sum = identity.clone();
    for k in (1..=18).rev() {
        sum = product(&small, &sum);
        sum.iter_mut()
            .flatten()
            .for_each(|entry| *entry /= f64::from(k));
        for (row, unit) in sum.iter_mut().zip(&identity) {
            for (entry, unit) in row.iter_mut().zip(unit) {
                *entry += unit;
            }
        }
    }
    for _ in 0..squarings {
        sum = product(&sum, &sum);
    }
    sum
}

/// u and v of `M a + D v + K u = F`, F constant, a time `t` (s) after `u` and `v`.
pub(super) fn motion(
    operators: &LinearOperators,
    force: &[f64],
    [u, v]: [&[f64]; 2],
    t: f64,
) -> [Vec<f64>; 2] {
    let n = operators.dofs();
    let (k, d, m) = (
        dense(operators.stiffness()),
        dense_damping(operators),
        operators.mass(),
    );
    let mut network = zeros(2 * n + 1);
    for i in 0..n {
        network[i][n + i] = t;
        for j in 0..n {
            network[n + i][j] = -t * k[i][j] / m[i];
            network[n + i][n + j] = -t * d[i][j] / m[i];
        }
        network[n + i][2 * n] = t * force[i] / m[i];
    }
    let exponential = exponential(&network);
    let start = [u, v, &[1.0]].concat();
    let mut moved: Vec<f64> = exponential.iter().map(|row| dot(row, &start)).collect();
    moved.truncate(2 * n);
    let velocity = moved.split_off(n);
    [moved, velocity]
}

#[cfg(test)]
mod tests {
    use sinew_core::closed_form::DampedOscillator;

    use super::*;

    #[test]
    fn the_exponential_of_a_rotation_is_the_rotation() {
        let angle = 7.3_f64;
        let turned = exponential(&vec![vec![0.0, -angle], vec![angle, 0.0]]);
        let expected = [[angle.cos(), -angle.sin()], [angle.sin(), angle.cos()]];
        for (row, expected) in turned.iter().zip(expected) {
            for (entry, expected) in row.iter().zip(expected) {
                assert!((entry - expected).abs() < 1e-13, "{entry} {expected}");
            }
        }
    }

    #[test]
    fn an_oscillator_moves_by_its_closed_form() -> Result<(), sinew_core::OperatorError> {
        let operators = LinearOperators::oscillator(0.5, 200.0, 3.0)?;
        let closed = DampedOscillator {
            omega: 20.0,
            damping: 6.0,
            load: 8.0,
            displacement: 0.01,
            velocity: -0.3,
        };
        let [u, v] = motion(&operators, &[4.0], [&[0.01], &[-0.3]], 0.37);
        let (expected_u, expected_v) = closed.at(0.37);
        assert!((u[0] - expected_u).abs() < 1e-14, "{} {expected_u}", u[0]);
        assert!((v[0] - expected_v).abs() < 1e-13, "{} {expected_v}", v[0]);
        Ok(())
    }
}
