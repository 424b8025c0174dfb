//! Minimum degree order of small graphs.

use crate::Pattern;

/// Orders some cells; the next one is always the one with the fewest remaining neighbours (Rose, Graph Theory and
/// Computing, 1972). Neighbours outside, which are eliminated later, also count.
///
/// The graph of eliminated cells is kept as rows of bits, exactly: for graphs of some hundred cells that is the
/// fastest. `number` is scratch space: one entry per cell of the pattern, all [`NONE`](super::graph::NONE) before and
/// after.
pub(super) fn minimum_degree(
    pattern: &Pattern,
    cells: &[u32],
    number: &mut [u32],
    order: &mut Vec<u32>,
) {
    let mut all = cells.to_vec();
    for (cell, new) in cells.iter().zip(0..) {
        number[*cell as usize] = new;
    }
    for cell in cells {
        for other in pattern.neighbours(*cell as usize) {
            if number[*other as usize] == super::graph::NONE {
                number[*other as usize] = all.len() as u32;
                all.push(*other);
            }
        }
    }
    let words = all.len().div_ceil(64);
    let mut rows = vec![vec![0u64; words]; cells.len()];
    for (cell, own) in cells.iter().zip(0..) {
        for other in pattern.neighbours(*cell as usize) {
            let other = number[*other as usize] as usize;
            if other != own {
                rows[own][other / 64] |= 1 << (other % 64);
            }
        }
    }
    for cell in &all {
        number[*cell as usize] = super::graph::NONE;
    }
    let count = |row: &[u64]| row.iter().map(|word| word.count_ones()).sum::<u32>();
    let mut degrees: Vec<u32> = rows.iter().map(|row| count(row)).collect();
    for _ in 0..cells.len() {
        let left = degrees.iter().zip(0..);
        let Some((_, next)) = left.min() else {
            break;
        };
        order.push(cells[next]);
        degrees[next] = u32::MAX;
        let pivot = std::mem::take(&mut rows[next]);
        let inside = (0..cells.len()).filter(|other| pivot[other / 64] >> (other % 64) & 1 == 1);
        for other in inside {
            let row = &mut rows[other];
            for (word, pivot) in row.iter_mut().zip(&pivot) {
                *word |= pivot;
            }
            row[next / 64] &= !(1 << (next % 64));
            row[other / 64] &= !(1 << (other % 64));
            degrees[other] = count(row);
        }
    }
}
