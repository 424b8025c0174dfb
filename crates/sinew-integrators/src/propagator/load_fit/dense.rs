//! Small dense systems.

/// Solves `A x = b` for a symmetric positive definite A, given by rows and overwritten, by Cholesky's factorisation
/// (Golub and Van Loan, Matrix Computations, section 4.2); x overwrites b. Returns true if A was positive definite.
pub(super) fn solve(matrix: &mut [f64], b: &mut [f64]) -> bool {
    let n = b.len();
    for i in 0..n {
        let (done, row) = matrix.split_at_mut(i * n);
        for j in 0..i {
            let other = &done[j * n..(j + 1) * n];
            let sum: f64 = (0..j).map(|k| row[k] * other[k]).sum();
            row[j] = (row[j] - sum) / other[j];
        }
        let pivot = row[i] - row[..i].iter().map(|x| x * x).sum::<f64>();
        if pivot.is_nan() || pivot <= 0.0 {
            return false;
        }
        row[i] = pivot.sqrt();
        let sum: f64 = (0..i).map(|k| row[k] * b[k]).sum();
        b[i] = (b[i] - sum) / row[i];
    }
    for i in (0..n).rev() {
        let sum: f64 = (i + 1..n).map(|k| matrix[k * n + i] * b[k]).sum();
        b[i] = (b[i] - sum) / matrix[i * n + i];
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hilberts_matrix_is_solved_and_an_indefinite_one_refused() {
        let n = 5;
        let entry = |at: usize| 1.0 / ((at / n + at % n + 1) as f64);
        let mut matrix: Vec<f64> = (0..n * n).map(entry).collect();
        // A times ones.
        let mut b: Vec<f64> = matrix.chunks(n).map(|row| row.iter().sum()).collect();
        assert!(solve(&mut matrix, &mut b));
        assert!(b.iter().all(|x| (x - 1.0).abs() < 1e-9), "{b:?}");
        assert!(!solve(&mut [1.0, 2.0, 2.0, 1.0], &mut [0.0, 0.0]));
    }
}
