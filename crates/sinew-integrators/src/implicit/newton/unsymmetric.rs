//! Equations whose matrix is symmetric except for a part that is known by its products.

use sinew_core::vectors::{add_scaled, dot, norm, scale};

use crate::implicit::factor::Factor;

/// Largest number of vectors of the basis.
const MOST: usize = 30;

/// Residual, as a share of that of the symmetric solution, at which the solution is accurate enough for an iteration of
/// Newton's method.
const NEAR: f64 = 1e-3;

/// Scratch space for solutions.
#[derive(Debug, Default)]
pub(super) struct Unsymmetric {
    basis: Vec<Vec<f64>>,
    product: Vec<f64>,
}

/// Vectors of the basis that are allocated beforehand: enough for a skew part of a tenth of the matrix.
const USUAL: usize = 5;

impl Unsymmetric {
    /// Allocates vectors of `entries` entries.
    pub(super) fn reserve(&mut self, entries: usize) {
        self.product.resize(entries, 0.0);
        self.basis.resize_with(USUAL, || vec![0.0; entries]);
    }

    /// Replaces the solution `x` of `K x = b` by that of `(K + S) x = b`, by the generalised minimal residual method
    /// with the factor of K as the preconditioner (Saad and Schultz, SIAM J. Sci. Stat. Comput. 7, 1986); returns the
    /// number of solutions with the factor. `skew` writes S times a vector; returns false if there is no S.
    pub(super) fn solve(
        &mut self,
        factor: &mut Factor,
        mut skew: impl FnMut(&[f64], &mut [f64]) -> bool,
        x: &mut [f64],
    ) -> u64 {
        self.product.resize(x.len(), 0.0);
        let size = norm(x);
        let is_there = skew(x, &mut self.product) && size > 0.0 && size.is_finite();
        if !is_there {
            return 0;
        }
        self.keep(0, x, size);
        // Columns of the Hessenberg matrix turned triangular, the turns, and the right-hand side.
        let mut columns = [[0.0; MOST]; MOST];
        let mut turns = [[0.0; 2]; MOST];
        let mut right = [0.0; MOST + 1];
        right[0] = size;
        let (mut solves, mut count) = (0, 0);
        for j in 0..MOST {
            let column = &mut columns[j];
            skew(&self.basis[j], &mut self.product);
            factor.solve(&mut self.product);
            solves += 1;
            add_scaled(1.0, &self.basis[j], &mut self.product);
            for (entry, vector) in column.iter_mut().zip(&self.basis[..=j]) {
                *entry = dot(vector, &self.product);
                add_scaled(-*entry, vector, &mut self.product);
            }
            let left = norm(&self.product);
            if !left.is_finite() {
                break;
            }
            for (k, [cosine, sine]) in turns[..j].iter().enumerate() {
                let [a, b] = [column[k], column[k + 1]];
                column[k] = cosine * a + sine * b;
                column[k + 1] = cosine * b - sine * a;
            }
            let length = column[j].hypot(left);
            if length == 0.0 {
                break;
            }
            turns[j] = [column[j] / length, left / length];
            column[j] = length;
            right[j + 1] = -turns[j][1] * right[j];
            right[j] *= turns[j][0];
            count = j + 1;
            if count == MOST || right[j + 1].abs() <= NEAR * size || left == 0.0 {
                break;
            }
            let product = std::mem::take(&mut self.product);
            self.keep(j + 1, &product, left);
            self.product = product;
        }
        if count == 0 {
            return solves;
        }
        let mut shares = [0.0; MOST];
        for row in (0..count).rev() {
            let known: f64 = (row + 1..count).map(|k| columns[k][row] * shares[k]).sum();
            shares[row] = (right[row] - known) / columns[row][row];
        }
        x.fill(0.0);
        for (share, vector) in shares[..count].iter().zip(&self.basis) {
            add_scaled(*share, vector, x);
        }
        solves
    }

    /// Stores a vector, divided by its size, as number `place` of the basis.
    fn keep(&mut self, place: usize, vector: &[f64], size: f64) {
        if self.basis.len() == place {
            self.basis.push(vec![0.0; vector.len()]);
        }
        self.basis[place].copy_from_slice(vector);
        scale(&mut self.basis[place], size.recip());
    }
}
