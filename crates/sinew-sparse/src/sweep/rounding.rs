//! Rows in fewer digits.

use crate::simd::Real;

/// Entries of a block of three layers.
const MOST_ENTRIES: usize = 9;

/// Digits (relative) from which entries are rounded each by itself: what rounding adds to a sum of them is
/// then far below any error that is measured.
const FINE: f64 = 1e-12;

/// Room for a diagonal entry that is larger than before by what all others of its row lost.
const ROOM: f64 = 1.0 + 1e-4;

/// Rounds a row of blocks and keeps its sum: `write(block, entry, value)` is told each entry.
///
/// A translation of the whole body strains nothing, since the blocks of a row add up to zero. Entries that are
/// rounded one by one add up to something else: springs to the ground, whose stiffness is a rounding error of the
/// diagonal, and thus large beside the stiffness with which a body resists its slow motions. Here all entries of a
/// row are multiples of one number, so that their sums are exact, and the block on the diagonal (`own`) takes what
/// the others lost.
pub(super) fn round_row<'a, T: Real>(
    row: impl Iterator<Item = &'a [f64]> + Clone,
    own: usize,
    layers: usize,
    mut write: impl FnMut(usize, usize, T),
) {
    let entries = layers * layers;
    if T::ROUNDING < FINE || entries > MOST_ENTRIES {
        for (block, of_block) in row.enumerate() {
            for (entry, value) in of_block.iter().enumerate() {
                write(block, entry, T::of(*value));
            }
        }
        return;
    }
    let mut largest = [0.0_f64; MOST_ENTRIES];
    let mut sums = [0.0; MOST_ENTRIES];
    for of_block in row.clone() {
        for (entry, value) in of_block.iter().enumerate() {
            let largest = &mut largest[entry / layers];
            *largest = value.abs().max(*largest);
            sums[entry] += value;
        }
    }
    let units = largest.map(unit::<T>);
    let rounded = |entry: usize, value: f64| match units[entry / layers] {
        0.0 => 0.0,
        unit => (value / unit).round_ties_even() * unit,
    };
    for (entry, sum) in sums[..entries].iter_mut().enumerate() {
        *sum = rounded(entry, *sum);
    }
    for (block, of_block) in row.enumerate().filter(|(block, _)| *block != own) {
        for (entry, value) in of_block.iter().enumerate() {
            let value = rounded(entry, *value);
            sums[entry] -= value;
            write(block, entry, T::of(value));
        }
    }
    for (entry, rest) in sums[..entries].iter().enumerate() {
        write(own, entry, T::of(*rest));
    }
}

/// The smallest power of two of which numbers up to `largest` are multiples in the digits of T; 0 for 0.
fn unit<T: Real>(largest: f64) -> f64 {
    if largest == 0.0 {
        return 0.0;
    }
    (2.0 * T::ROUNDING) * (largest * ROOM).log2().floor().exp2()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows as f32 holds them, from entries without a pattern.
    fn rounded(blocks: usize, layers: usize, own: usize) -> (Vec<Vec<f64>>, Vec<Vec<f32>>) {
        let entries = layers * layers;
        let value =
            |block: usize, entry: usize| ((12.9898 * (block * 9 + entry) as f64).sin()) / 3.0;
        let mut row: Vec<Vec<f64>> = (0..blocks)
            .map(|block| (0..entries).map(|entry| value(block, entry)).collect())
            .collect();
        for entry in 0..entries {
            let others: f64 = (0..blocks)
                .filter(|block| *block != own)
                .map(|block| row[block][entry])
                .sum();
            row[own][entry] = -others;
        }
        let mut found = vec![vec![f32::NAN; entries]; blocks];
        round_row(
            row.iter().map(Vec::as_slice),
            own,
            layers,
            |block, entry, value| {
                found[block][entry] = value;
            },
        );
        (row, found)
    }

    #[test]
    fn a_translation_stays_without_force_and_entries_move_by_a_rounding() {
        for (blocks, layers, own) in [(15, 3, 7), (40, 3, 0), (7, 1, 6), (1, 3, 0)] {
            let (row, found) = rounded(blocks, layers, own);
            for entry in 0..layers * layers {
                let of = |block: usize| f64::from(found[block][entry]);
                let sum: f64 = (0..blocks).map(of).sum();
                assert_eq!(sum, 0.0, "{blocks} blocks, entry {entry}");
                let line = entry / layers * layers..(entry / layers + 1) * layers;
                let largest = row.iter().flat_map(|block| &block[line.clone()]);
                let largest = largest.fold(0.0_f64, |most, x| x.abs().max(most));
                for block in 0..blocks {
                    let lost = if block == own { blocks } else { 1 } as f64;
                    let off = (of(block) - row[block][entry]).abs();
                    assert!(off <= lost * largest * f64::from(f32::EPSILON), "{off}");
                }
            }
        }
    }

    #[test]
    fn a_row_that_adds_up_to_something_keeps_its_sum() {
        let row = [[3.0, 0.1], [-1.0 / 3.0, 0.2]].map(|pair| pair.map(|x| x * 1e6));
        let blocks: Vec<Vec<f64>> = row.concat().into_iter().map(|x| vec![x]).collect();
        let mut sum = 0.0;
        round_row(
            blocks.iter().map(Vec::as_slice),
            0,
            1,
            |_, _, value: f32| {
                sum += f64::from(value);
            },
        );
        let exact: f64 = row.concat().iter().sum();
        assert!((sum - exact).abs() <= 0.5 * 0.25, "{sum} {exact}");
    }

    #[test]
    fn zeros_and_double_precision_stay_as_they_are() {
        let row = [[0.0; 9], [0.0; 9]];
        round_row(
            row.iter().map(|block| &block[..]),
            1,
            3,
            |_, _, value: f32| assert_eq!(value, 0.0),
        );
        let row = [[0.1; 9], [-0.2; 9]];
        round_row(
            row.iter().map(|block| &block[..]),
            0,
            3,
            |block, entry, value: f64| {
                assert_eq!(value, row[block][entry]);
            },
        );
    }
}
