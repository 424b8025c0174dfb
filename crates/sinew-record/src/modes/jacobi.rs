//! Eigenvalues of small symmetric matrices.

/// Rounds of rotations after which a matrix is diagonal in any case.
const MOST_ROUNDS: usize = 60;

/// Eigenvalues of a symmetric matrix (by rows, overwritten) of this size, the largest first, and their vectors, each in a
/// row, by Jacobi's rotations (Golub and Van Loan, Matrix Computations, section 8.5).
pub(super) fn eigen(matrix: &mut [f64], size: usize) -> (Vec<f64>, Vec<f64>) {
    let at = |i: usize, j: usize| i * size + j;
    let mut vectors = vec![0.0; size * size];
    for i in 0..size {
        vectors[at(i, i)] = 1.0;
    }
    for _ in 0..MOST_ROUNDS {
        let diagonal: f64 = (0..size).map(|i| matrix[at(i, i)].powi(2)).sum();
        let off: f64 = matrix.iter().map(|x| x * x).sum::<f64>() - diagonal;
        if off <= 1e-30 * diagonal {
            break;
        }
        for p in 0..size {
            for q in p + 1..size {
                let off = matrix[at(p, q)];
                if off == 0.0 {
                    continue;
                }
                let ratio = (matrix[at(q, q)] - matrix[at(p, p)]) / (2.0 * off);
                let tangent = ratio.signum() / (ratio.abs() + ratio.hypot(1.0));
                let cosine = tangent.hypot(1.0).recip();
                let sine = tangent * cosine;
                for k in 0..size {
                    let (a, b) = (matrix[at(k, p)], matrix[at(k, q)]);
                    matrix[at(k, p)] = cosine * a - sine * b;
                    matrix[at(k, q)] = sine * a + cosine * b;
                }
                for rows in [&mut *matrix, &mut vectors] {
                    for k in 0..size {
                        let (a, b) = (rows[at(p, k)], rows[at(q, k)]);
                        rows[at(p, k)] = cosine * a - sine * b;
                        rows[at(q, k)] = sine * a + cosine * b;
                    }
                }
            }
        }
    }
    let mut order: Vec<usize> = (0..size).collect();
    order.sort_by(|a, b| matrix[at(*b, *b)].total_cmp(&matrix[at(*a, *a)]));
    let values = order.iter().map(|i| matrix[at(*i, *i)]).collect();
    let rows = order
        .iter()
        .flat_map(|i| vectors[at(*i, 0)..at(*i, 0) + size].to_vec());
    (values, rows.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The second difference of n points has the eigenvalues 2 - 2 cos(k pi/(n + 1)).
    #[test]
    fn eigenvalues_of_a_chain() {
        const N: usize = 7;
        let mut matrix = vec![0.0; N * N];
        for i in 0..N {
            matrix[i * N + i] = 2.0;
            if i + 1 < N {
                matrix[i * N + i + 1] = -1.0;
                matrix[(i + 1) * N + i] = -1.0;
            }
        }
        let (values, vectors) = eigen(&mut matrix, N);
        for (k, value) in (1..=N).rev().zip(&values) {
            let expected = 2.0 - 2.0 * (k as f64 * std::f64::consts::PI / (N + 1) as f64).cos();
            assert!((value - expected).abs() < 1e-13, "{value} {expected}");
        }
        for (row, value) in vectors.chunks(N).zip(&values) {
            for i in 0..N {
                let around = |j: Option<usize>| j.and_then(|j| row.get(j)).copied().unwrap_or(0.0);
                let product = 2.0 * row[i] - around(i.checked_sub(1)) - around(Some(i + 1));
                assert!((product - value * row[i]).abs() < 1e-12);
            }
        }
    }
}
