//! Rows that repeat on a lattice.

#![allow(unsafe_code, reason = "a kernel; ARCHITECTURE.md names it")]

use std::ops::Range;

use super::CHUNK;
use crate::simd::{At, Lanes, Real};

/// Rows of a matrix on the positions of a lattice, each template stored once: the offsets and blocks of
/// neighbours are the same for all rows of a template, so that neither blocks nor columns are read from
/// memory.
#[derive(Clone, Debug)]
pub struct Lattice<T> {
    pub(super) layers: usize,
    pub(super) positions: usize,
    /// Longest offset.
    pub(super) reach: usize,
    /// First block of each template; one more at the end.
    pub(super) starts: Vec<u32>,
    /// Distance (positions) to the neighbour of each block.
    pub(super) offsets: Vec<i32>,
    /// Entries of each block, row by row.
    pub(super) blocks: Vec<T>,
    /// First run of each chunk; one more at the end.
    pub(super) first_run: Vec<u32>,
    pub(super) runs: Vec<Run>,
}

/// Consecutive positions with the same template.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Run {
    pub(super) template: u32,
    /// First position.
    pub(super) first: u32,
    /// Vectors of positions; the last may reach beyond the run, into positions of a later run.
    pub(super) vectors: u32,
}

impl<T: Real> Lattice<T> {
    /// Number of templates.
    #[must_use]
    pub fn templates(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of layers.
    #[must_use]
    pub fn layers(&self) -> usize {
        self.layers
    }

    /// Vectors of blocks that a product multiplies with: short runs and empty places among them are multiplied too.
    #[must_use]
    pub fn vectors_of_blocks(&self) -> usize {
        let of_run = |run: &Run| {
            let template = run.template as usize;
            let blocks = self.starts[template + 1] - self.starts[template];
            run.vectors as usize * blocks as usize
        };
        self.runs.iter().map(of_run).sum()
    }

    /// Vectors of positions in chunks that have rows.
    #[must_use]
    pub fn vectors_of_positions(&self) -> usize {
        let chunks = 0..self.first_run.len() - 1;
        CHUNK * chunks.filter(|chunk| !self.is_empty(*chunk)).count()
    }

    pub(super) fn is_empty(&self, chunk: usize) -> bool {
        self.first_run[chunk] == self.first_run[chunk + 1]
    }

    pub(super) fn is_on(&self, positions: usize, layers: usize) -> bool {
        self.positions == positions && self.layers == layers
    }

    /// Bytes that a product reads of the matrix.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(&self.blocks[..]) + size_of_val(&self.offsets[..]) + size_of_val(&self.runs[..])
    }

    /// `out = A source` for a chunk.
    ///
    /// # Safety
    /// The instruction set of `V` is available. `source` and `out` are the first positions of their layers, `out` that
    /// of the chunk: `source` valid for all positions and as far before and after them as the largest offset, `out` for
    /// the chunk and one vector more. L is the number of layers.
    #[inline(always)]
    pub(super) unsafe fn product<V: Lanes<T>, const L: usize>(
        &self,
        chunk: usize,
        first: usize,
        source: [At<T>; L],
        out: [At<T>; L],
    ) {
        debug_assert!(L == self.layers);
        let runs = self.first_run[chunk] as usize..self.first_run[chunk + 1] as usize;
        for run in &self.runs[runs] {
            let template = run.template as usize;
            let blocks = self.starts[template] as usize..self.starts[template + 1] as usize;
            let (mut at, mut left) = (run.first as usize, run.vectors as usize);
            // SAFETY: as for this function; runs end within a vector after their chunk.
            unsafe {
                while left > 0 {
                    let from = source.map(|source| source.add(at));
                    let to = out.map(|out| out.add(at - first));
                    let taken = match left {
                        1 => self.vectors::<V, L, 1>(blocks.clone(), from, to),
                        2 => self.vectors::<V, L, 2>(blocks.clone(), from, to),
                        _ => self.vectors::<V, L, 3>(blocks.clone(), from, to),
                    };
                    at += taken * T::LANES;
                    left -= taken;
                }
            }
        }
    }

    /// N vectors of positions at a time, so that each block is read once for all of them; returns N.
    ///
    /// # Safety
    /// As for [`Lattice::product`], for the positions from `from` and `to` on.
    #[inline(always)]
    unsafe fn vectors<V: Lanes<T>, const L: usize, const N: usize>(
        &self,
        blocks: Range<usize>,
        from: [At<T>; L],
        to: [At<T>; L],
    ) -> usize {
        // SAFETY: blocks have L L entries and an offset each; pointers as for this function.
        unsafe {
            let mut sum = [[V::splat(T::default()); N]; L];
            let mut entry = At::start_of(&self.blocks).add(blocks.start * L * L);
            let offsets = At::start_of(&self.offsets);
            for block in blocks {
                let offset = offsets.add(block).read() as isize;
                let mut x = [[V::splat(T::default()); N]; L];
                for j in 0..L {
                    for n in 0..N {
                        x[j][n] = from[j].offset(offset).add(n * T::LANES).load::<V>();
                    }
                }
                for sum in &mut sum {
                    for x in &x {
                        let factor = V::splat(entry.read());
                        entry = entry.add(1);
                        for n in 0..N {
                            sum[n] = x[n].mul_add(factor, sum[n]);
                        }
                    }
                }
            }
            for i in 0..L {
                for n in 0..N {
                    to[i].add(n * T::LANES).store(sum[i][n]);
                }
            }
        }
        N
    }
}
