//! Products. Each row is summed in column order by one thread, so results do not depend on the number of threads.

use crate::{BlockMatrix, Layers, Pattern};

/// Number of blocks below which a product stays on the calling thread: forking costs several microseconds.
#[cfg(feature = "rayon")]
const SERIAL_BLOCKS: usize = 200_000;

impl BlockMatrix {
    /// `out = K x`. Both vectors have length [`BlockMatrix::dofs`].
    pub fn multiply(&self, x: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.rows(out, 1.0, |j| x[j]);
    }

    /// `out -= K x`.
    pub fn subtract_product(&self, x: &[f64], out: &mut [f64]) {
        self.rows(out, -1.0, |j| x[j]);
    }

    /// `out -= K (u + beta v)`: the one product that proportional damping needs.
    pub fn subtract_product_combined(&self, u: &[f64], beta: f64, v: &[f64], out: &mut [f64]) {
        self.rows(out, -1.0, |j| u[j] + beta * v[j]);
    }

    /// `out -= beta K v`.
    pub fn subtract_scaled_product(&self, beta: f64, v: &[f64], out: &mut [f64]) {
        self.rows(out, -beta, |j| v[j]);
    }

    fn rows(&self, out: &mut [f64], scale: f64, x: impl Fn(usize) -> f64 + Sync) {
        match self.layers() {
            Layers::One => self.rows_of::<1>(out, scale, &x),
            Layers::Three => self.rows_of::<3>(out, scale, &x),
        }
    }

    fn rows_of<const L: usize>(
        &self,
        out: &mut [f64],
        scale: f64,
        x: &(impl Fn(usize) -> f64 + Sync),
    ) {
        let (pattern, values) = (self.pattern().as_ref(), self.values());
        let (rows, _) = out.as_chunks_mut::<L>();
        #[cfg(feature = "rayon")]
        if pattern.blocks() >= SERIAL_BLOCKS && rayon::current_num_threads() > 1 {
            use rayon::prelude::*;
            rows.par_iter_mut()
                .enumerate()
                .with_min_len(1024)
                .for_each(|(cell, row)| add_row(pattern, values, cell, scale, x, row));
            return;
        }
        for (cell, row) in rows.iter_mut().enumerate() {
            add_row(pattern, values, cell, scale, x, row);
        }
    }
}

#[inline(always)]
fn add_row<const L: usize>(
    pattern: &Pattern,
    values: &[f64],
    cell: usize,
    scale: f64,
    x: &impl Fn(usize) -> f64,
    out: &mut [f64; L],
) {
    let range = pattern.row(cell);
    let mut sum = [0.0; L];
    let blocks = values[range.start * L * L..range.end * L * L].chunks_exact(L * L);
    for (block, &column) in blocks.zip(pattern.neighbours(cell)) {
        let first = column as usize * L;
        let entries: [f64; L] = std::array::from_fn(|j| x(first + j));
        for (row, total) in block.chunks_exact(L).zip(&mut sum) {
            for (entry, value) in row.iter().zip(&entries) {
                *total += entry * value;
            }
        }
    }
    for (value, total) in out.iter_mut().zip(sum) {
        *value += scale * total;
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;

    /// A ring of `cells` cells with entries that depend on every index.
    fn ring(cells: u32, layers: Layers) -> BlockMatrix {
        let pairs = (0..cells).map(|cell| [cell, (cell + 1) % cells]);
        let pattern = Arc::new(Pattern::from_elements(cells as usize, pairs).unwrap());
        let mut matrix = BlockMatrix::zeros(pattern, layers);
        for row in 0..cells {
            for column in matrix.pattern().neighbours(row as usize).to_vec() {
                let block: Vec<f64> = (0..layers.block_len())
                    .map(|k| ((row * 7 + column * 3) as f64 + k as f64).sin())
                    .collect();
                matrix.add_block(row, column, &block).unwrap();
            }
        }
        matrix
    }

    fn dense_product(matrix: &BlockMatrix, x: &[f64]) -> Vec<f64> {
        let layers = matrix.layers().count();
        let mut out = vec![0.0; x.len()];
        for i in 0..x.len() {
            for j in 0..x.len() {
                if let Some(block) = matrix.block(i / layers, j / layers) {
                    out[i] += block[(i % layers) * layers + j % layers] * x[j];
                }
            }
        }
        out
    }

    #[test]
    fn the_product_is_the_dense_product() {
        for layers in [Layers::One, Layers::Three] {
            let matrix = ring(7, layers);
            let x: Vec<f64> = (0..matrix.dofs()).map(|i| (i as f64).cos()).collect();
            let mut out = vec![f64::NAN; x.len()];
            matrix.multiply(&x, &mut out);
            for (value, expected) in out.iter().zip(dense_product(&matrix, &x)) {
                assert!((value - expected).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn the_combined_product_is_the_product_of_the_combination() {
        let matrix = ring(5, Layers::Three);
        let u: Vec<f64> = (0..15).map(|i| f64::from(i).cos()).collect();
        let v: Vec<f64> = (0..15).map(|i| f64::from(i).sin()).collect();
        let w: Vec<f64> = u.iter().zip(&v).map(|(u, v)| u + 0.25 * v).collect();
        let (mut combined, mut plain) = (vec![1.0; 15], vec![1.0; 15]);
        matrix.subtract_product_combined(&u, 0.25, &v, &mut combined);
        matrix.subtract_product(&w, &mut plain);
        assert_eq!(combined, plain);
    }

    #[cfg(feature = "rayon")]
    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let matrix = ring(70_000, Layers::Three);
        assert!(matrix.pattern().blocks() >= SERIAL_BLOCKS);
        let x: Vec<f64> = (0..matrix.dofs()).map(|i| (i as f64).cos()).collect();
        let product_with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            let mut out = vec![0.0; x.len()];
            pool.install(|| matrix.multiply(&x, &mut out));
            out
        };
        assert_eq!(product_with(1), product_with(3));
    }
}
