//! Arrays that begin at a cache line.

#![allow(unsafe_code, reason = "numbers in memory of another type")]

use std::marker::PhantomData;
use std::mem::MaybeUninit;
use std::ops::{Deref, DerefMut};

/// 64 bytes, aligned to a cache line.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
struct Line([MaybeUninit<u8>; 64]);

/// Plain values whose first begins at a cache line, so that a vector of them is in one line and not in two.
pub struct Aligned<T> {
    lines: Vec<Line>,
    count: usize,
    values: PhantomData<T>,
}

impl<T: Copy> Aligned<T> {
    /// `count` copies of this value. An allocation beyond the available memory panics, as with vectors of the standard
    /// library.
    #[must_use]
    pub fn filled(value: T, count: usize) -> Self {
        const { assert!(align_of::<T>() <= 64, "values that fit a line") };
        let bytes = count.saturating_mul(size_of::<T>());
        let lines = bytes.div_ceil(size_of::<Line>());
        let mut lines = vec![Line([MaybeUninit::uninit(); 64]); lines];
        let first = lines.as_mut_ptr().cast::<T>();
        for place in 0..count {
            // SAFETY: the lines have space for `count` values, and begin where one may.
            unsafe { first.add(place).write(value) };
        }
        Self {
            lines,
            count,
            values: PhantomData,
        }
    }
}

impl<T> Aligned<T> {
    /// Number of values.
    pub(super) fn count(&self) -> usize {
        self.count
    }
}

impl<T: Copy> Deref for Aligned<T> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        // SAFETY: `count` values were written when this was made.
        unsafe { std::slice::from_raw_parts(self.lines.as_ptr().cast(), self.count) }
    }
}

impl<T: Copy> DerefMut for Aligned<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        // SAFETY: `count` values were written when this was made.
        unsafe { std::slice::from_raw_parts_mut(self.lines.as_mut_ptr().cast(), self.count) }
    }
}

impl<T: Copy> From<&[T]> for Aligned<T> {
    fn from(values: &[T]) -> Self {
        match values.first() {
            None => Self {
                lines: Vec::new(),
                count: 0,
                values: PhantomData,
            },
            Some(first) => {
                let mut all = Self::filled(*first, values.len());
                all.copy_from_slice(values);
                all
            }
        }
    }
}

impl<T: Copy> Clone for Aligned<T> {
    fn clone(&self) -> Self {
        Self::from(&**self)
    }
}

impl<T> std::fmt::Debug for Aligned<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Aligned")
            .field("count", &self.count)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[should_panic(expected = "capacity overflow")]
    fn more_values_than_any_memory_holds_are_no_small_array() {
        // Their bytes are 8 more than all that can be counted.
        let _ = Aligned::filled(1.0_f64, usize::MAX / 8 + 2);
    }

    #[test]
    fn values_stay_what_they_are_and_begin_at_a_line() {
        for count in [0, 1, 3, 100] {
            let values: Vec<[f64; 3]> = (0..count).map(|n| [f64::from(n), 1.0, 2.0]).collect();
            let mut aligned = Aligned::from(&values[..]);
            assert_eq!(*aligned, values[..]);
            assert_eq!(*aligned.clone(), values[..]);
            assert!(aligned.as_ptr().cast::<u8>().addr() % 64 == 0);
            aligned.fill([7.0; 3]);
            assert!(aligned.iter().all(|value| *value == [7.0; 3]));
        }
    }
}
