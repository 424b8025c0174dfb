//! Addresses that carry, in debug builds, the bounds of the memory that they may access.

#![allow(unsafe_code, reason = "the contract stands at `At`")]

use super::lanes::Lanes;
use super::real::Real;

/// The address of a number in an array: a plain pointer in release builds. With debug assertions it
/// keeps the bounds of the array (or of the part of it that a thread may use), and everything that is read or
/// written through it is checked against them first.
///
/// # Safety
/// Same as for pointers: all that a method reads or writes has to be within the array of the address, which must still
/// exist, and which no other thread writes in the meantime. Vectors need the instruction set of their type.
#[derive(Clone, Copy, Debug)]
pub(crate) struct At<T> {
    pointer: *mut T,
    #[cfg(debug_assertions)]
    bounds: [*mut T; 2],
}

impl<T> PartialEq for At<T> {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.pointer, other.pointer)
    }
}

#[allow(unsafe_code, reason = "one contract for all methods stands above")]
impl<T: Copy> At<T> {
    /// An address from which `before` numbers in front of it and `after` numbers from it on may be used.
    #[inline(always)]
    pub(crate) fn new(pointer: *mut T, before: usize, after: usize) -> Self {
        #[cfg(not(debug_assertions))]
        let _ = (before, after);
        Self {
            pointer,
            #[cfg(debug_assertions)]
            bounds: [pointer.wrapping_sub(before), pointer.wrapping_add(after)],
        }
    }

    /// The first number of a slice, which is only read.
    #[inline(always)]
    pub(crate) fn start_of(values: &[T]) -> Self {
        Self::new(values.as_ptr().cast_mut(), 0, values.len())
    }

    /// The address `count` numbers further; it may be outside the array if nothing is accessed through it.
    #[inline(always)]
    #[must_use]
    pub(crate) fn add(self, count: usize) -> Self {
        Self {
            pointer: self.pointer.wrapping_add(count),
            ..self
        }
    }

    /// The address `count` numbers further, or back.
    #[inline(always)]
    #[must_use]
    pub(crate) fn offset(self, count: isize) -> Self {
        Self {
            pointer: self.pointer.wrapping_offset(count),
            ..self
        }
    }

    /// The same address, from which only `count` numbers may be used.
    #[inline(always)]
    #[must_use]
    pub(crate) fn first(self, count: usize) -> Self {
        self.check(0, count);
        Self::new(self.pointer, 0, count)
    }

    #[inline(always)]
    pub(crate) unsafe fn read(self) -> T {
        self.check(0, 1);
        // SAFETY: the caller's promise.
        unsafe { *self.pointer }
    }

    #[inline(always)]
    pub(crate) unsafe fn write(self, value: T) {
        self.check(0, 1);
        // SAFETY: the caller's promise.
        unsafe { *self.pointer = value }
    }

    /// Checks that the numbers `from..to` from here are within bounds.
    #[inline(always)]
    fn check(self, from: usize, to: usize) {
        #[cfg(debug_assertions)]
        {
            let [first, end] = self.bounds;
            let within =
                self.pointer.wrapping_add(from) >= first && self.pointer.wrapping_add(to) <= end;
            assert!(within, "a kernel uses memory that is not its own");
        }
        #[cfg(not(debug_assertions))]
        let _ = (from, to);
    }
}

#[allow(unsafe_code, reason = "one contract for all methods stands above")]
impl<T: Real> At<T> {
    #[inline(always)]
    pub(crate) unsafe fn load<V: Lanes<T>>(self) -> V {
        self.check(0, T::LANES);
        // SAFETY: the caller's promise.
        unsafe { V::load(self.pointer) }
    }

    #[inline(always)]
    pub(crate) unsafe fn store<V: Lanes<T>>(self, value: V) {
        self.check(0, T::LANES);
        // SAFETY: the caller's promise.
        unsafe { value.store(self.pointer) }
    }

    /// The numbers at this address and the indices that are stored at `index`.
    #[inline(always)]
    pub(crate) unsafe fn gather<V: Lanes<T>>(self, index: At<u32>) -> V {
        index.check(0, T::LANES);
        #[cfg(debug_assertions)]
        for lane in 0..T::LANES {
            // SAFETY: checked just before.
            let at = unsafe { index.add(lane).read() } as usize;
            self.check(at, at + 1);
        }
        // SAFETY: the caller's promise.
        unsafe { V::gather(self.pointer, index.pointer) }
    }

    /// Prefetches the 64 bytes at this address, which may be outside the array, into the first cache.
    #[inline(always)]
    pub(crate) unsafe fn prefetch<V: Lanes<T>>(self) {
        // SAFETY: the instruction set is there; no address is wrong.
        unsafe { V::prefetch(self.pointer) }
    }
}

impl At<u32> {
    /// Prefetches the 64 bytes at this address, which may be outside the array, into the first cache.
    #[inline(always)]
    pub(crate) unsafe fn prefetch_index<T: Real, V: Lanes<T>>(self) {
        // SAFETY: the instruction set is there; no address is wrong.
        unsafe { V::prefetch(self.pointer.cast()) }
    }
}

#[cfg(all(test, debug_assertions))]
mod tests {
    use std::panic::{AssertUnwindSafe, catch_unwind};

    use super::*;
    use crate::simd::Array;

    type Vector = Array<f64, 8>;

    fn refused<R>(of: impl FnOnce() -> R) -> bool {
        catch_unwind(AssertUnwindSafe(of)).is_err()
    }

    #[test]
    fn nothing_outside_an_array_is_read_or_written_in_a_debug_build() {
        let mut values = [1.0; 24];
        let at = At::new(values.as_mut_ptr().wrapping_add(8), 8, 8);
        // SAFETY: the array has 8 numbers before and 16 from there on, of which 8 may be used.
        unsafe {
            assert_eq!(at.offset(-8).read(), 1.0);
            at.store(Vector::splat(2.0));
            assert!(refused(|| at.offset(-9).read()));
            assert!(refused(|| at.add(8).write(0.0)));
            assert!(refused(|| at.add(1).load::<Vector>()));
            assert!(refused(|| at.offset(1).store(Vector::splat(0.0))));
            assert!(refused(|| at.first(9)));
            assert!(refused(|| at.first(8).offset(-1).write(0.0)));
        }
        assert_eq!(values[16..], [1.0; 8]);
    }

    #[test]
    fn an_index_outside_an_array_is_not_followed_in_a_debug_build() {
        let values = [0.0, 1.0, 2.0];
        let at = At::start_of(&values);
        let good = [0_u32, 1, 2, 0, 1, 2, 0, 1];
        let bad = [0_u32, 1, 2, 3, 1, 2, 0, 1];
        // SAFETY: the good indices lie within the array, the bad ones are refused before they are used.
        unsafe {
            let _: Vector = at.gather(At::start_of(&good));
            assert!(refused(|| at.gather::<Vector>(At::start_of(&bad))));
            assert!(refused(|| at.gather::<Vector>(At::start_of(&good[1..]))));
        }
    }
}
