//! Factors of one small matrix per cell.

/// Factors `L D L'` of symmetric positive definite blocks, one for each cell, `layers` x `layers`.
///
/// Each block is the sum of a positive diagonal and a positive semidefinite part, so that no pivot is below its entry
/// of the diagonal (a Schur complement is monotone in the matrix). Where rounding of a stiff part makes one smaller,
/// that entry replaces the pivot: a light node on stiff springs still moves in every direction.
#[derive(Debug)]
pub(crate) struct CellFactors {
    layers: usize,
    entries: Vec<f64>,
}

impl CellFactors {
    /// Storage for the blocks of `dofs` degrees of freedom.
    pub(crate) fn new(layers: usize, dofs: usize) -> Self {
        Self {
            layers,
            entries: vec![0.0; dofs * layers],
        }
    }

    /// The entries of the positive semidefinite parts, to be written before [`CellFactors::factorise`].
    pub(crate) fn entries_mut(&mut self) -> &mut [f64] {
        &mut self.entries
    }

    /// Adds `diagonal` and factorises.
    pub(crate) fn factorise(&mut self, diagonal: impl Fn(usize) -> f64) {
        let n = self.layers;
        for (cell, block) in self.entries.chunks_exact_mut(n * n).enumerate() {
            for k in 0..n {
                let own = diagonal(cell * n + k);
                let mut pivot = own + block[k * n + k];
                for j in 0..k {
                    pivot -= block[k * n + j].powi(2) * block[j * n + j];
                }
                let pivot = pivot.max(own);
                block[k * n + k] = pivot;
                for i in k + 1..n {
                    let mut entry = block[i * n + k];
                    for j in 0..k {
                        entry -= block[i * n + j] * block[k * n + j] * block[j * n + j];
                    }
                    block[i * n + k] = entry / pivot;
                }
            }
        }
    }

    /// Returns `x'B y` for the blocks B.
    pub(crate) fn product(&self, x: &[f64], y: &[f64]) -> f64 {
        let n = self.layers;
        let cells = x.chunks_exact(n).zip(y.chunks_exact(n));
        let of_cell = |(block, (x, y)): (&[f64], (&[f64], &[f64]))| {
            let of_row = |i: usize| {
                let whole = |x: &[f64]| {
                    let below: f64 = (i + 1..n).map(|j| block[j * n + i] * x[j]).sum();
                    x[i] + below
                };
                block[i * n + i] * whole(x) * whole(y)
            };
            (0..n).map(of_row).sum::<f64>()
        };
        self.entries
            .chunks_exact(n * n)
            .zip(cells)
            .map(of_cell)
            .sum()
    }

    /// Writes the inverse blocks, `factor` times, row by row.
    pub(crate) fn write_inverse(&self, factor: f64, out: &mut [f64]) {
        let n = self.layers;
        out.fill(0.0);
        let blocks = self.entries.chunks_exact(n * n);
        for (block, out) in blocks.zip(out.chunks_exact_mut(n * n)) {
            // Rows are columns, as the inverse is symmetric.
            for (k, row) in out.chunks_exact_mut(n).enumerate() {
                row[k] = factor;
                solve_by(block, row);
            }
        }
    }

    /// Replaces `x` by the solution with each cell's block.
    pub(crate) fn solve(&self, x: &mut [f64]) {
        let n = self.layers;
        for (block, x) in self.entries.chunks_exact(n * n).zip(x.chunks_exact_mut(n)) {
            solve_by(block, x);
        }
    }
}

/// Replaces `x` by the solution with one block's factors.
#[inline]
fn solve_by(block: &[f64], x: &mut [f64]) {
    let n = x.len();
    for i in 0..n {
        for j in 0..i {
            x[i] -= block[i * n + j] * x[j];
        }
    }
    for i in (0..n).rev() {
        x[i] /= block[i * n + i];
        for j in i + 1..n {
            x[i] -= block[j * n + i] * x[j];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_solution_fits_its_block() {
        let block = [4.0, 1.0, 0.5, 1.0, 3.0, -0.25, 0.5, -0.25, 2.0];
        let mut factors = CellFactors::new(3, 3);
        factors.entries_mut().copy_from_slice(&block);
        factors.factorise(|dof| dof as f64 + 1.0);
        let right = [1.0, -2.0, 0.5];
        let mut x = right;
        factors.solve(&mut x);
        for i in 0..3 {
            let row: f64 = (0..3).map(|j| block[3 * i + j] * x[j]).sum();
            let found = row + (i as f64 + 1.0) * x[i];
            assert!((found - right[i]).abs() < 1e-14, "{found}");
        }
        let mut inverse = [0.0; 9];
        factors.write_inverse(2.0, &mut inverse);
        let rows = inverse.as_chunks::<3>().0;
        let by_inverse = rows
            .iter()
            .map(|row| (0..3).map(|j| row[j] * right[j]).sum());
        for (by_inverse, x) in by_inverse.zip(x) {
            let by_inverse: f64 = by_inverse;
            assert!((by_inverse - 2.0 * x).abs() < 1e-14, "{by_inverse}");
        }
        let expected: f64 = (0..3).map(|i| x[i] * right[i]).sum();
        assert!((factors.product(&x, &x) - expected).abs() < 1e-14);
    }

    #[test]
    fn a_light_node_on_a_stiff_spring_moves_across_it() {
        // 1e9 N/m along (.6, .64, .48), and 1e-8 kg/s^2 in all directions.
        let along = [0.6, 0.64, 0.48];
        let mut factors = CellFactors::new(3, 3);
        for (at, entry) in factors.entries_mut().iter_mut().enumerate() {
            *entry = 1e9 * along[at / 3] * along[at % 3];
        }
        factors.factorise(|_| 1e-8);
        let mut x = [0.64, -0.6, 0.0];
        factors.solve(&mut x);
        assert!(x.iter().all(|x| x.is_finite()));
        assert!(0.64 * x[0] - 0.6 * x[1] > 0.0, "{x:?}");
    }
}
