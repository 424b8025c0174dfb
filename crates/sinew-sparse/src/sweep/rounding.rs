//! Rows in fewer digits.

use crate::BlockMatrix;
use crate::simd::Real;

/// Entries of a block of three layers.
const MOST_ENTRIES: usize = 9;

/// Precision (relative) from which each entry is rounded separately: the rounding error of a sum of them is then far
/// below any measured error.
const FINE: f64 = 1e-12;

/// Margin for a diagonal entry, which grows by the rounding errors of all others of its row.
const ROOM: f64 = 1.0 + 1e-4;

/// The units of the cells of a matrix in few digits: powers of two of which numbers up to the largest entry of a cell's
/// row are multiples. Empty if digits are fine.
#[derive(Clone, Debug)]
pub(super) struct Units(Vec<f64>);

impl Units {
    /// The units for numbers of a precision.
    pub(super) fn of<T: Real>(matrix: &BlockMatrix) -> Self {
        if T::ROUNDING < FINE {
            return Self(Vec::new());
        }
        let cells = 0..matrix.pattern().cells();
        Self(cells.map(|cell| unit::<T>(matrix, cell)).collect())
    }

    /// True if the precision is fine, so that entries stay unchanged.
    pub(super) fn are_fine(&self) -> bool {
        self.0.is_empty()
    }

    /// The unit of the block between two cells, the larger of theirs; 0 without units.
    pub(super) fn between(&self, cell: usize, other: usize) -> f64 {
        let of = |cell: usize| self.0.get(cell).copied().unwrap_or(0.0);
        of(cell).max(of(other))
    }
}

/// Rounds a row of blocks, each to its unit, and keeps its sum: `write(block, entry, value)` receives each entry.
///
/// A translation of the whole body causes no strain, since the blocks of a row add up to zero. The sum of entries that
/// are rounded one by one is not zero: it acts like springs to the ground, whose stiffness is a rounding error of the
/// diagonal, and thus large compared to the stiffness with which a body resists its slow motions. Here the sums are
/// exact, and the block on the diagonal (`own`) takes the rounding errors of the others. The matrix stays symmetric,
/// because motions would gain energy otherwise: two cells use one unit in the block between them, and the diagonal
/// block takes only the symmetric part of the rounding errors. The rest does no work in a translation.
pub(super) fn round_row<'a, T: Real>(
    row: impl Iterator<Item = (&'a [f64], f64)> + Clone,
    own: usize,
    layers: usize,
    mut write: impl FnMut(usize, usize, T),
) {
    let entries = layers * layers;
    if T::ROUNDING < FINE || entries > MOST_ENTRIES {
        for (block, (of_block, _)) in row.enumerate() {
            for (entry, value) in of_block.iter().enumerate() {
                write(block, entry, T::of(*value));
            }
        }
        return;
    }
    let rounded = |value: f64, unit: f64| match unit > 0.0 {
        true => (value / unit).round_ties_even() * unit,
        false => 0.0,
    };
    // What a row's sum loses by rounding.
    let mut lost = [0.0; MOST_ENTRIES];
    let mut finest = 0.0;
    for (block, (of_block, unit)) in row.clone().enumerate() {
        for (lost, value) in lost.iter_mut().zip(of_block) {
            *lost += value;
        }
        if block == own {
            finest = unit;
        }
    }
    for lost in &mut lost {
        *lost = rounded(*lost, finest);
    }
    let mut diagonal = [0.0; MOST_ENTRIES];
    for (block, (of_block, unit)) in row.enumerate() {
        for (entry, value) in of_block.iter().enumerate() {
            let value = rounded(*value, unit);
            lost[entry] -= value;
            match block == own {
                true => diagonal[entry] = value,
                false => write(block, entry, T::of(value)),
            }
        }
    }
    for entry in 0..entries {
        let mirrored = entry % layers * layers + entry / layers;
        let symmetric = 0.5 * (lost[entry] + lost[mirrored]);
        write(own, entry, T::of(diagonal[entry] + symmetric));
    }
}

/// The power of two of which the entries of a cell's row are made multiples; 0 if the row has no other entries.
fn unit<T: Real>(matrix: &BlockMatrix, cell: usize) -> f64 {
    let entries = matrix.row_blocks(cell).flat_map(|(_, block)| block);
    let largest = entries.fold(0.0, |most: f64, entry| entry.abs().max(most));
    if largest == 0.0 {
        return 0.0;
    }
    2.0 * T::ROUNDING * (largest * ROOM).log2().floor().exp2()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{Layers, Pattern};

    /// A symmetric matrix with entries without a pattern, of which every row adds up to zero, with stiffnesses that
    /// grow from cell to cell by `growth`.
    fn matrix(cells: u32, layers: Layers, growth: f64) -> BlockMatrix {
        let pairs =
            || (0..cells).flat_map(move |i| (i + 1..(i + 4).min(cells)).map(move |j| [i, j]));
        let own = (0..cells).map(|i| vec![i]);
        let pattern =
            Pattern::from_elements(cells as usize, own.chain(pairs().map(Vec::from))).unwrap();
        let mut matrix = BlockMatrix::zeros(Arc::new(pattern), layers);
        let (n, entries) = (layers.count(), layers.block_len());
        for [i, j] in pairs() {
            let value = |a: usize, b: usize| {
                let (a, b) = (a.min(b), a.max(b));
                let size = growth.powf(f64::from(i.min(j)));
                size * (12.9898 * f64::from(i * 37 + j * 11 + (a * 3 + b) as u32)).sin() / 3.0
            };
            let block: Vec<f64> = (0..entries).map(|at| value(at / n, at % n)).collect();
            let less: Vec<f64> = block.iter().map(|x| -x).collect();
            for (row, column, block) in
                [(i, i, &less), (j, j, &less), (i, j, &block), (j, i, &block)]
            {
                matrix.add_block(row, column, block).unwrap();
            }
        }
        matrix
    }

    /// The blocks of each row rounded to f32, by column.
    fn rounded(matrix: &BlockMatrix) -> Vec<Vec<(usize, Vec<f32>)>> {
        let units = Units::of::<f32>(matrix);
        let layers = matrix.layers();
        let row = |cell: usize| {
            let blocks = matrix.row_blocks(cell);
            let row = blocks
                .clone()
                .map(|(column, block)| (block, units.between(cell, column)));
            let columns: Vec<usize> = blocks.map(|(column, _)| column).collect();
            let own = columns.iter().position(|column| *column == cell).unwrap();
            let mut found = vec![vec![f32::NAN; layers.block_len()]; columns.len()];
            round_row(row, own, layers.count(), |block, entry, value| {
                found[block][entry] = value;
            });
            columns.into_iter().zip(found).collect()
        };
        (0..matrix.pattern().cells()).map(row).collect()
    }

    #[test]
    fn a_matrix_stays_symmetric_and_its_translations_without_work() {
        for (layers, growth) in [
            (Layers::Three, 1.0),
            (Layers::Three, 1.7),
            (Layers::Three, 30.0),
            (Layers::One, 3.0),
        ] {
            let exact = matrix(12, layers, growth);
            let found = rounded(&exact);
            let n = layers.count();
            for (cell, row) in found.iter().enumerate() {
                let largest = exact.row_blocks(cell).flat_map(|(_, block)| block);
                let largest = largest.fold(0.0, |most: f64, x| x.abs().max(most));
                for (column, block) in row {
                    let (_, other) = found[*column].iter().find(|(of, _)| *of == cell).unwrap();
                    for entry in 0..n * n {
                        let mirrored = entry % n * n + entry / n;
                        assert_eq!(block[entry], other[mirrored], "{cell}, {column}, {growth}");
                    }
                }
                for entry in 0..n * n {
                    let mirrored = entry % n * n + entry / n;
                    let sum = |entry: usize| -> f64 {
                        row.iter().map(|(_, block)| f64::from(block[entry])).sum()
                    };
                    assert_eq!(
                        sum(entry) + sum(mirrored),
                        0.0,
                        "{cell}, entry {entry}, {growth}"
                    );
                    assert!(sum(entry).abs() <= 20.0 * growth * largest * f64::from(f32::EPSILON));
                }
            }
        }
    }

    #[test]
    fn entries_move_by_a_rounding_of_the_larger_of_two_rows() {
        let exact = matrix(12, Layers::Three, 1.0);
        for (cell, row) in rounded(&exact).iter().enumerate() {
            for ((column, block), (_, before)) in row.iter().zip(exact.row_blocks(cell)) {
                let lost = if *column == cell { 8.0 } else { 1.0 };
                for (value, before) in block.iter().zip(before) {
                    let off = (f64::from(*value) - before).abs();
                    assert!(off <= lost * 2.0 * f64::from(f32::EPSILON), "{off:e}");
                }
            }
        }
    }

    #[test]
    fn a_row_that_adds_up_to_something_keeps_its_sum() {
        let row = [3.0, 0.1, -1.0 / 3.0, 0.2].map(|x| [x * 1e6]);
        let row = || row.iter().map(|block| (&block[..], 0.25));
        let mut sum = 0.0;
        round_row(row(), 0, 1, |_, _, value: f32| sum += f64::from(value));
        let exact: f64 = row().map(|(block, _)| block[0]).sum();
        assert!((sum - exact).abs() <= 0.5 * 0.25, "{sum} {exact}");
    }

    #[test]
    fn zeros_and_double_precision_stay_as_they_are() {
        let zeros = [[0.0; 9], [0.0; 9]];
        let row = zeros.iter().map(|block| (&block[..], 0.0));
        round_row(row, 1, 3, |_, _, value: f32| assert_eq!(value, 0.0));
        let exact = [[0.1; 9], [-0.2; 9]];
        let row = exact.iter().map(|block| (&block[..], 0.0));
        round_row(row, 0, 3, |block, entry, value: f64| {
            assert_eq!(value, exact[block][entry]);
        });
    }
}
