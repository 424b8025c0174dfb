//! Arrays that the threads of a sweep share.

#![allow(unsafe_code, reason = "memory that the threads of a sweep share")]

use std::cell::UnsafeCell;
use std::marker::PhantomData;
use std::ops::Range;

use super::aligned::Aligned;

/// Numbers that threads write at the same time, each thread in its own places.
pub struct Shared<T> {
    first: *mut T,
    /// The memory that `first` points to, used only through that pointer.
    owner: Aligned<T>,
}

// SAFETY: nothing but `SharedSlice::read` and `SharedSlice::write` gives the numbers away while they are shared, and whoever calls
// these promises that nobody writes what another one uses.
unsafe impl<T: Send + Sync> Send for Shared<T> {}
// SAFETY: as above.
unsafe impl<T: Send + Sync> Sync for Shared<T> {}

impl<T: Copy> Shared<T> {
    /// `count` copies of this number, to be shared.
    #[must_use]
    pub fn filled(value: T, count: usize) -> Self {
        let mut owner = Aligned::filled(value, count);
        Self {
            first: owner.as_mut_ptr(),
            owner,
        }
    }

    /// View of the numbers, through which threads read and write them.
    #[inline(always)]
    #[must_use]
    pub fn slice(&self) -> SharedSlice<'_, T> {
        SharedSlice {
            first: self.first,
            count: self.owner.count(),
            cells: PhantomData,
        }
    }
}

impl<T> std::fmt::Debug for Shared<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Shared")
            .field("count", &self.owner.count())
            .finish_non_exhaustive()
    }
}

/// View of numbers that threads write in different places at the same time.
#[derive(Debug)]
pub struct SharedSlice<'a, T> {
    first: *mut T,
    count: usize,
    cells: PhantomData<&'a [UnsafeCell<T>]>,
}

impl<T> Clone for SharedSlice<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for SharedSlice<'_, T> {}

// SAFETY: as for `Shared`.
unsafe impl<T: Send + Sync> Send for SharedSlice<'_, T> {}
// SAFETY: as for `Shared`.
unsafe impl<T: Send + Sync> Sync for SharedSlice<'_, T> {}

impl<'a, T: Copy> SharedSlice<'a, T> {
    /// The numbers of a slice, which no other code uses in the meantime.
    #[inline(always)]
    #[must_use]
    pub fn of(values: &'a mut [T]) -> Self {
        Self {
            first: values.as_mut_ptr(),
            count: values.len(),
            cells: PhantomData,
        }
    }

    /// Number of numbers.
    #[inline(always)]
    #[must_use]
    pub fn count(self) -> usize {
        self.count
    }

    /// Some of the numbers, to be read.
    ///
    /// # Safety
    /// No code writes any of them as long as the slice is used.
    ///
    /// # Panics
    /// If the range goes beyond the numbers.
    #[inline(always)]
    #[must_use]
    pub unsafe fn read(self, range: Range<usize>) -> &'a [T] {
        assert!(range.start <= range.end && range.end <= self.count);
        // SAFETY: the range lies within the allocation, and the rest is the caller's promise.
        unsafe { std::slice::from_raw_parts(self.first.add(range.start), range.len()) }
    }

    /// One of the numbers. Its place is not checked: in a loop that mostly fetches numbers, a check cost 7 % of its
    /// time.
    ///
    /// # Safety
    /// The place is below [`Self::count`], and no code writes the number in the meantime.
    #[inline(always)]
    #[must_use]
    pub unsafe fn get(self, place: usize) -> &'a T {
        debug_assert!(place < self.count);
        // SAFETY: the caller's promise.
        unsafe { &*self.first.add(place) }
    }

    /// Some of the numbers, to be written.
    ///
    /// # Safety
    /// No other code uses any of them as long as the slice is used.
    ///
    /// # Panics
    /// If the range goes beyond the numbers.
    #[inline(always)]
    #[must_use]
    #[allow(clippy::mut_from_ref, reason = "that is what the promise is for")]
    pub unsafe fn write(self, range: Range<usize>) -> &'a mut [T] {
        assert!(range.start <= range.end && range.end <= self.count);
        // SAFETY: the range lies within the allocation, and the rest is the caller's promise.
        unsafe { std::slice::from_raw_parts_mut(self.first.add(range.start), range.len()) }
    }
}

#[cfg(test)]
mod tests {
    use std::panic::{AssertUnwindSafe, catch_unwind};

    use super::*;

    #[test]
    fn threads_write_in_different_places() {
        let all = Shared::filled(0_u32, 100);
        std::thread::scope(|scope| {
            for part in 0..4 {
                let slice = all.slice();
                // SAFETY: each thread has a part of its own.
                scope.spawn(move || unsafe { slice.write(25 * part..25 * part + 25) }.fill(7));
            }
        });
        // SAFETY: all threads have come to their end.
        assert_eq!(unsafe { all.slice().read(0..100) }, [7; 100]);
    }

    #[test]
    fn nothing_beyond_the_end_is_given() {
        let mut values = [1, 2, 3];
        let slice = SharedSlice::of(&mut values);
        // SAFETY: nobody else uses them.
        let beyond = catch_unwind(AssertUnwindSafe(|| unsafe { slice.read(1..4) }.len()));
        assert!(beyond.is_err());
        // SAFETY: as above.
        assert_eq!(unsafe { (slice.get(2), slice.count()) }, (&3, 3));
    }
}
