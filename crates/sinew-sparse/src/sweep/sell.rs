//! Rows of any matrix in slices.

#![allow(unsafe_code, reason = "a kernel; ARCHITECTURE.md names it")]

use std::ops::Range;

use super::numbering::Numbering;
use super::rounding::{Units, round_row};
use crate::BlockMatrix;
use crate::simd::{At, Lanes, Real};

/// Number of bytes above which a matrix is in memory rather than in a cache.
const IN_CACHE: usize = 32 << 20;

/// A block matrix in sliced ELLPACK form, SELL-C-sigma (Kreutzer et al., SIAM J. Sci. Comput. 36, 2014): as many rows
/// as a vector has lanes are stored side by side, entry by entry, so that one instruction works on all of them. Short
/// rows of a slice are filled up with zeros; the numbering has sorted the rows by length, so that there are few such
/// zeros.
#[derive(Clone, Debug)]
pub struct Sell<T> {
    layers: usize,
    /// First block of each slice, in blocks of all lanes together; one more at the end.
    starts: Vec<u32>,
    /// Position of each block's column, lane by lane.
    columns: Vec<u32>,
    /// Entries of each block, entry by entry and lane by lane.
    values: Vec<T>,
    units: Units,
    /// Number of blocks by which memory is prefetched: a product streams through it.
    ahead: usize,
}

impl<T: Real> Sell<T> {
    /// The rows of a matrix at the positions of a numbering.
    #[must_use]
    pub fn new(matrix: &BlockMatrix, numbering: &Numbering) -> Self {
        let lanes = T::LANES;
        let layers = matrix.layers().count();
        let slices = numbering.positions() / lanes;
        let mut starts = Vec::with_capacity(slices + 1);
        let mut blocks = 0;
        starts.push(0);
        for slice in 0..slices {
            let cells = (0..lanes).filter_map(|lane| numbering.cell(slice * lanes + lane));
            let widest = cells.map(|cell| matrix.pattern().neighbours(cell as usize).len());
            blocks += widest.max().unwrap_or(0) as u32;
            starts.push(blocks);
        }
        let entries = layers * layers * lanes;
        let mut sell = Self {
            layers,
            starts,
            columns: vec![0; blocks as usize * lanes],
            values: vec![T::default(); blocks as usize * entries],
            units: Units::of::<T>(matrix),
            ahead: 4,
        };
        if sell.bytes() > IN_CACHE {
            sell.ahead = 8;
        }
        for position in 0..numbering.positions() {
            // Filling reads the row's own position.
            let (slice, lane) = (position / lanes, position % lanes);
            for block in sell.blocks(slice) {
                sell.columns[block * lanes + lane] = position as u32;
            }
            if let Some(cell) = numbering.cell(position) {
                sell.set_row(matrix, numbering, cell);
            }
        }
        sell
    }

    fn set_row(&mut self, matrix: &BlockMatrix, numbering: &Numbering, cell: u32) {
        let lanes = T::LANES;
        let position = numbering.position(cell);
        let (slice, lane) = (position / lanes, position % lanes);
        let entries = self.layers * self.layers;
        let first = self.blocks(slice).start;
        let neighbours = matrix.pattern().neighbours(cell as usize);
        for (block, neighbour) in (first..).zip(neighbours) {
            self.columns[block * lanes + lane] = numbering.position(*neighbour) as u32;
        }
        if self.units.are_fine() {
            let to = self.values[first * entries * lanes..].chunks_exact_mut(entries * lanes);
            for (to, (_, block)) in to.zip(matrix.row_blocks(cell as usize)) {
                for (to, value) in to.chunks_exact_mut(lanes).zip(block) {
                    to[lane] = T::of(*value);
                }
            }
            return;
        }
        let own = neighbours.partition_point(|neighbour| *neighbour < cell);
        let cell = cell as usize;
        let row = matrix.row_blocks(cell);
        let row = row.map(|(column, block)| (block, self.units.between(cell, column)));
        let values = &mut self.values;
        round_row(row, own, self.layers, |block, entry, value| {
            values[((first + block) * entries + entry) * lanes + lane] = value;
        });
    }

    /// Bytes that a product reads of the matrix.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(&self.values[..]) + size_of_val(&self.columns[..])
    }

    pub(super) fn is_on(&self, positions: usize, layers: usize) -> bool {
        (self.starts.len() - 1) * T::LANES == positions && self.layers == layers
    }

    fn blocks(&self, slice: usize) -> Range<usize> {
        self.starts[slice] as usize..self.starts[slice + 1] as usize
    }

    /// `out = A source` for a range of slices.
    ///
    /// # Safety
    /// The instruction set of `V` is available. `source` and `out` are the first positions of their
    /// layers: `source` valid for all positions of the numbering that this was made with, `out`
    /// for those of the range, counted from its beginning. L is the number of layers.
    #[inline(always)]
    pub(super) unsafe fn product<V: Lanes<T>, const L: usize>(
        &self,
        slices: Range<usize>,
        source: [At<T>; L],
        out: [At<T>; L],
    ) {
        debug_assert!(slices.end < self.starts.len() && L == self.layers);
        let lanes = T::LANES;
        let first = slices.start;
        for slice in slices {
            let blocks = self.blocks(slice);
            // SAFETY: `columns` and `values` have as many vectors as the last start says, and each
            // column is a position.
            unsafe {
                let mut column = At::start_of(&self.columns).add(blocks.start * lanes);
                let mut value = At::start_of(&self.values).add(blocks.start * L * L * lanes);
                let mut sum = [V::splat(T::default()); L];
                for _ in blocks {
                    let x: [V; L] = std::array::from_fn(|j| source[j].gather(column));
                    column.add(self.ahead * lanes).prefetch_index::<T, V>();
                    for sum in &mut sum {
                        for x in x {
                            value.add(L * L * self.ahead * lanes).prefetch::<V>();
                            *sum = value.load::<V>().mul_add(x, *sum);
                            value = value.add(lanes);
                        }
                    }
                    column = column.add(lanes);
                }
                for (sum, out) in sum.into_iter().zip(out) {
                    out.add((slice - first) * lanes).store(sum);
                }
            }
        }
    }
}
