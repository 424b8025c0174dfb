//! One small symmetric matrix per cell.

use sinew_core::{BlockMatrix, Layers};

/// Share of the largest entry below which a pivot counts as zero: the cell has no stiffness in that direction.
const NEGLIGIBLE: f64 = 1e-12;

/// Symmetric blocks on the diagonal, one for each cell, each `layers` x `layers`, row-major.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CellBlocks {
    layers: usize,
    entries: Vec<f64>,
}

impl CellBlocks {
    /// A multiple of the lumped mass.
    pub(crate) fn of_mass(layers: Layers, mass: &[f64], factor: f64) -> Self {
        let n = layers.count();
        let mut entries = vec![0.0; mass.len() * n];
        for (dof, mass) in mass.iter().enumerate() {
            entries[(dof / n) * n * n + (dof % n) * (n + 1)] = factor * mass;
        }
        Self { layers: n, entries }
    }

    /// Adds a multiple of a matrix's diagonal blocks.
    pub(crate) fn add_diagonal(&mut self, matrix: &BlockMatrix, factor: f64) {
        let len = self.layers * self.layers;
        for (cell, block) in self.entries.chunks_exact_mut(len).enumerate() {
            if let Some(diagonal) = matrix.block(cell, cell) {
                for (entry, value) in block.iter_mut().zip(diagonal) {
                    *entry += factor * value;
                }
            }
        }
    }

    /// Adds a multiple of other blocks.
    pub(crate) fn add(&mut self, other: &Self, factor: f64) {
        for (entry, value) in self.entries.iter_mut().zip(&other.entries) {
            *entry += factor * value;
        }
    }

    /// The inverse of each block; directions in which a block is zero have no effect.
    pub(crate) fn inverse(&self) -> Self {
        let mut inverse = self.clone();
        for block in inverse.entries.chunks_exact_mut(self.layers * self.layers) {
            invert(self.layers, block);
        }
        inverse
    }

    /// `out = blocks x`.
    pub(crate) fn multiply(&self, x: &[f64], out: &mut [f64]) {
        match self.layers {
            1 => multiply::<1>(&self.entries, x, out),
            _ => multiply::<3>(&self.entries, x, out),
        }
    }

    /// `x = blocks x` for the cells from `first` on.
    pub fn multiply_in_place(&self, first: usize, x: &mut [f64]) {
        let from = first * self.layers * self.layers;
        match self.layers {
            1 => multiply_in_place::<1>(&self.entries[from..], x),
            _ => multiply_in_place::<3>(&self.entries[from..], x),
        }
    }

    /// Degrees of freedom of a cell: rows of a block.
    #[must_use]
    pub fn layers(&self) -> usize {
        self.layers
    }

    /// The entries of all blocks, cell by cell, each row by row.
    #[must_use]
    pub fn entries(&self) -> &[f64] {
        &self.entries
    }

    /// Replaces the block of a cell by the first entries of `block`.
    pub(crate) fn set(&mut self, cell: usize, block: &[f64]) {
        let len = self.layers * self.layers;
        self.entries[cell * len..(cell + 1) * len].copy_from_slice(&block[..len]);
    }

    /// The block of a cell.
    pub(crate) fn of_cell(&self, cell: usize) -> &[f64] {
        let len = self.layers * self.layers;
        &self.entries[cell * len..(cell + 1) * len]
    }
}

fn multiply<const L: usize>(entries: &[f64], x: &[f64], out: &mut [f64]) {
    let rows = out.chunks_exact_mut(L).zip(x.chunks_exact(L));
    for (block, (out, x)) in entries.chunks_exact(L * L).zip(rows) {
        for (row, out) in block.chunks_exact(L).zip(out) {
            *out = row.iter().zip(x).map(|(entry, x)| entry * x).sum();
        }
    }
}

fn multiply_in_place<const L: usize>(entries: &[f64], x: &mut [f64]) {
    let (cells, _) = x.as_chunks_mut::<L>();
    for (block, x) in entries.chunks_exact(L * L).zip(cells) {
        let before = *x;
        for (row, out) in block.chunks_exact(L).zip(x) {
            *out = row.iter().zip(&before).map(|(entry, x)| entry * x).sum();
        }
    }
}

/// Gauss-Jordan on a symmetric positive semidefinite block; a pivot that vanishes leaves its row
/// and column zero, which is the pseudo-inverse if the block is zero in that direction.
fn invert(n: usize, block: &mut [f64]) {
    let scale = block
        .iter()
        .fold(0.0, |max: f64, entry| max.max(entry.abs()));
    for k in 0..n {
        let pivot = block[k * n + k];
        if pivot <= NEGLIGIBLE * scale {
            for i in 0..n {
                block[k * n + i] = 0.0;
                block[i * n + k] = 0.0;
            }
            continue;
        }
        block[k * n + k] = 1.0;
        for j in 0..n {
            block[k * n + j] /= pivot;
        }
        for i in (0..n).filter(|i| *i != k) {
            let factor = block[i * n + k];
            block[i * n + k] = 0.0;
            for j in 0..n {
                block[i * n + j] -= factor * block[k * n + j];
            }
        }
    }
}

/// The largest eigenvalue of a symmetric 3x3 or 1x1 matrix, row-major, by the trigonometric
/// formula (Smith, Comm. ACM 4, 1961).
pub(crate) fn largest_eigenvalue_of_block(block: &[f64]) -> f64 {
    let &[a, b, c, _, d, e, _, _, f] = block else {
        return block.first().copied().unwrap_or(0.0);
    };
    let mean = (a + d + f) / 3.0;
    let off = b * b + c * c + e * e;
    let spread = (a - mean).powi(2) + (d - mean).powi(2) + (f - mean).powi(2) + 2.0 * off;
    let p = (spread / 6.0).sqrt();
    if p == 0.0 {
        return mean;
    }
    let (x, y, z) = ((a - mean) / p, (d - mean) / p, (f - mean) / p);
    let (b, c, e) = (b / p, c / p, e / p);
    let determinant = x * (y * z - e * e) - b * (b * z - e * c) + c * (b * e - y * c);
    let angle = (determinant / 2.0).clamp(-1.0, 1.0).acos() / 3.0;
    mean + 2.0 * p * angle.cos()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_times_block_is_the_identity() {
        let block = [4.0, 1.0, 0.5, 1.0, 3.0, -0.25, 0.5, -0.25, 2.0];
        let mut inverse = block;
        invert(3, &mut inverse);
        for i in 0..3 {
            for j in 0..3 {
                let entry: f64 = (0..3).map(|k| inverse[3 * i + k] * block[3 * k + j]).sum();
                assert!((entry - f64::from(u8::from(i == j))).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn a_held_component_stays_without_effect() {
        let mut block = [4.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 2.0];
        invert(3, &mut block);
        assert_eq!([block[1], block[3], block[4], block[5], block[7]], [0.0; 5]);
        assert!((block[0] - 2.0 / 7.0).abs() < 1e-15);
    }

    #[test]
    fn eigenvalues_of_known_blocks() {
        let close = |block: &[f64], expected: f64| {
            assert!((largest_eigenvalue_of_block(block) - expected).abs() < 1e-12);
        };
        close(&[7.0], 7.0);
        close(&[2.0, 0.0, 0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 3.0], 5.0);
        // tridiag(-1, 2, -1): 2 + sqrt 2.
        close(
            &[2.0, -1.0, 0.0, -1.0, 2.0, -1.0, 0.0, -1.0, 2.0],
            2.0 + 2.0_f64.sqrt(),
        );
        close(&[3.0, 0.0, 0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 3.0], 3.0);
    }
}
