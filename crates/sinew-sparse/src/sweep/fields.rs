//! Vectors of all cells in the order of a kernel.

#![allow(unsafe_code, reason = "memory that the threads of a sweep share")]

use std::cell::UnsafeCell;
use std::marker::PhantomData;
use std::ops::Range;

use crate::simd::{At, Real};

/// 64 bytes, aligned to a cache line.
#[repr(C, align(64))]
struct Line([u8; 64]);

/// Vectors with one value for each position and layer, by number, all zero at first.
///
/// Each layer of a vector is contiguous, with padding before the first and after the last position that stays zero, so
/// that kernels may read there.
pub struct Fields<T> {
    lines: Box<[UnsafeCell<Line>]>,
    layers: usize,
    /// Positions in front of position 0.
    front: usize,
    /// Positions, the padding before and after them included.
    stride: usize,
    positions: usize,
    number: PhantomData<T>,
}

// SAFETY: the cells are plain bytes; whoever shares them between threads promises in
// `Fields::at`'s contract that no position is written by one thread while another one uses it.
unsafe impl<T: Send> Send for Fields<T> {}
// SAFETY: as above.
unsafe impl<T: Sync> Sync for Fields<T> {}

impl<T: Real> Fields<T> {
    /// `count` vectors of `layers` layers on `positions` positions, a multiple of [`Real::LANES`], of
    /// which kernels read up to `reach` before the first and after the last.
    #[must_use]
    pub fn new(count: usize, layers: usize, positions: usize, reach: usize) -> Self {
        let front = reach.next_multiple_of(T::LANES);
        // Whole vectors are read from any position on.
        let stride = front + positions + front + T::LANES;
        let lines = count * layers * stride / T::LANES;
        let lines = (0..lines).map(|_| UnsafeCell::new(Line([0; 64])));
        Self {
            lines: lines.collect(),
            layers,
            front,
            stride,
            positions,
            number: PhantomData,
        }
    }

    /// Number of positions.
    #[must_use]
    pub fn positions(&self) -> usize {
        self.positions
    }

    /// Layers of a vector.
    #[must_use]
    pub fn layers(&self) -> usize {
        self.layers
    }

    /// Number of vectors.
    #[must_use]
    pub fn count(&self) -> usize {
        self.lines.len() * T::LANES / (self.layers * self.stride).max(1)
    }

    /// Positions before the first and after the last that may be read.
    pub(super) fn reach(&self) -> usize {
        self.front
    }

    /// Position 0 of a layer of a vector, with the padding around its positions. Values may be written through it while
    /// no other thread uses them.
    #[inline(always)]
    pub(super) fn at(&self, field: usize, layer: usize) -> At<T> {
        assert!(layer < self.layers, "a layer by its number");
        // SAFETY: layers lie a stride apart, and the vector has this one.
        let first = unsafe { self.pointer(field).add(layer * self.stride) };
        At::new(first, self.front, self.stride - self.front)
    }

    /// Position 0 of the first layer of a vector.
    #[inline(always)]
    fn pointer(&self, field: usize) -> *mut T {
        let at = field * self.layers * self.stride + self.front;
        assert!(field < self.count(), "a vector by its number");
        let first = UnsafeCell::raw_get(self.lines.as_ptr()).cast::<T>();
        // SAFETY: `at` lies within the allocation, since `field` is one of its vectors.
        unsafe { first.add(at) }
    }

    /// Values of a layer at some positions, to be read.
    ///
    /// # Safety
    /// No code writes any of them as long as the slice is used.
    ///
    /// # Panics
    /// If they do not exist.
    #[must_use]
    pub unsafe fn read(&self, field: usize, layer: usize, positions: Range<usize>) -> &[T] {
        let first = self.first_of(field, layer, &positions);
        // SAFETY: the positions lie within the layer, and the rest is the caller's promise.
        unsafe { std::slice::from_raw_parts(first, positions.len()) }
    }

    /// Values of a layer at some positions, to be written.
    ///
    /// # Safety
    /// No other code uses any of them as long as the slice is used.
    ///
    /// # Panics
    /// If they do not exist.
    #[must_use]
    #[allow(clippy::mut_from_ref, reason = "that is what the promise is for")]
    pub unsafe fn write(&self, field: usize, layer: usize, positions: Range<usize>) -> &mut [T] {
        let first = self.first_of(field, layer, &positions);
        // SAFETY: the positions lie within the layer, and the rest is the caller's promise.
        unsafe { std::slice::from_raw_parts_mut(first, positions.len()) }
    }

    /// The first of some positions of a layer.
    fn first_of(&self, field: usize, layer: usize, positions: &Range<usize>) -> *mut T {
        assert!(layer < self.layers, "a layer by its number");
        let within = positions.start <= positions.end && positions.end <= self.positions;
        assert!(within, "positions that there are");
        let first = self.pointer(field);
        // SAFETY: the layer lies within the allocation, and the position within the layer.
        unsafe { first.add(layer * self.stride + positions.start) }
    }

    /// The values of several layers, each given by the number of its vector and of the layer, one for each position.
    #[must_use]
    pub fn layers_of<const N: usize>(&mut self, layers: [(usize, usize); N]) -> [&[T]; N] {
        layers.map(|(field, layer)| {
            // SAFETY: `self` is borrowed for as long as the slices live, which are read alone.
            unsafe { self.read(field, layer, 0..self.positions) }
        })
    }

    /// The values of a layer, one for each position.
    #[must_use]
    pub fn layer(&mut self, field: usize, layer: usize) -> &mut [T] {
        assert!(layer < self.layers, "a layer by its number");
        let first = self.pointer(field);
        // SAFETY: the layer lies within the allocation, its bytes are numbers (all bit patterns are),
        // aligned to 64, and `self` is borrowed for as long as the slice lives.
        unsafe { std::slice::from_raw_parts_mut(first.add(layer * self.stride), self.positions) }
    }
}

impl<T> std::fmt::Debug for Fields<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Fields")
            .field("layers", &self.layers)
            .field("positions", &self.positions)
            .finish_non_exhaustive()
    }
}
