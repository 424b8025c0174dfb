//! The rows of a matrix, in one of the layouts.

#![allow(unsafe_code, reason = "a kernel; ARCHITECTURE.md names it")]

use std::ops::Range;

use super::fields::Fields;
use super::{CHUNK, Lattice, Sell};
use crate::simd::{At, Lanes, Real};

/// A matrix as kernels read it.
#[derive(Clone, Debug)]
pub enum Rows<T> {
    /// Every row stored separately.
    General(Sell<T>),
    /// Templates on a lattice.
    Lattice(Lattice<T>),
}

impl<T: Real> Rows<T> {
    /// Bytes that a product reads of the matrix.
    #[must_use]
    pub fn bytes(&self) -> usize {
        match self {
            Self::General(sell) => sell.bytes(),
            Self::Lattice(lattice) => lattice.bytes(),
        }
    }

    /// True if a chunk has no rows at all.
    pub(super) fn is_empty(&self, chunk: usize) -> bool {
        match self {
            Self::General(_) => false,
            Self::Lattice(lattice) => lattice.is_empty(chunk),
        }
    }

    /// True if the matrix has the positions of these vectors and reads no vector beyond its padding.
    pub(super) fn fits(&self, fields: &Fields<T>) -> bool {
        match self {
            Self::General(sell) => sell.is_on(fields.positions(), fields.layers()),
            Self::Lattice(lattice) => {
                lattice.is_on(fields.positions(), fields.layers())
                    && lattice.reach <= fields.reach()
            }
        }
    }

    /// `out = A source` for the vectors of a chunk.
    ///
    /// # Safety
    /// As for [`Sell::product`] and [`Lattice::product`].
    #[inline(always)]
    pub(super) unsafe fn product<V: Lanes<T>, const L: usize>(
        &self,
        chunk: usize,
        vectors: Range<usize>,
        source: [At<T>; L],
        out: [At<T>; L],
    ) {
        debug_assert_eq!(vectors.start, chunk * CHUNK);
        // SAFETY: as for this function.
        unsafe {
            match self {
                Self::General(sell) => sell.product::<V, L>(vectors, source, out),
                Self::Lattice(lattice) => {
                    lattice.product::<V, L>(chunk, vectors.start * T::LANES, source, out);
                }
            }
        }
    }
}
