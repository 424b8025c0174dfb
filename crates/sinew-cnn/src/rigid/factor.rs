//! Factors of matrices over the motions of a part.

use super::{Coefficients, MOST};

/// Pivot, as a share of its diagonal entry, below which motions depend on each other.
const DEPENDENT: f64 = 1e-14;

/// The lower factor L of a symmetric positive definite matrix `L L'`.
#[derive(Clone, Debug, Default)]
pub(super) struct Factor {
    rows: [Coefficients; MOST],
    count: usize,
}

impl Factor {
    /// Cholesky factor of the first `count` rows and columns; `None` if they are singular.
    pub(super) fn of(matrix: &[Coefficients; MOST], count: usize) -> Option<Self> {
        let mut rows = [[0.0; MOST]; MOST];
        for i in 0..count {
            for j in 0..=i {
                let known: f64 = (0..j).map(|k| rows[i][k] * rows[j][k]).sum();
                let left = matrix[i][j] - known;
                if i > j {
                    rows[i][j] = left / rows[j][j];
                } else if left > DEPENDENT * matrix[i][i] && left.is_finite() {
                    rows[i][i] = left.sqrt();
                } else {
                    return None;
                }
            }
        }
        Some(Self { rows, count })
    }

    /// Replaces x by `L^-1 x`.
    pub(super) fn forward(&self, x: &mut Coefficients) {
        for i in 0..self.count {
            let known: f64 = (0..i).map(|k| self.rows[i][k] * x[k]).sum();
            x[i] = (x[i] - known) / self.rows[i][i];
        }
    }

    /// Replaces x by `L^-T x`.
    pub(super) fn back(&self, x: &mut Coefficients) {
        for i in (0..self.count).rev() {
            let known: f64 = (i + 1..self.count).map(|k| self.rows[k][i] * x[k]).sum();
            x[i] = (x[i] - known) / self.rows[i][i];
        }
    }

    /// Replaces x by the solution.
    pub(super) fn solve(&self, x: &mut Coefficients) {
        self.forward(x);
        self.back(x);
    }
}
