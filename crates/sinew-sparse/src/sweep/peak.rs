//! Reading and multiply-adds at the peak rate of a processor, for comparison.

#![allow(unsafe_code, reason = "a kernel; ARCHITECTURE.md names it")]

use super::chunk::Precision;
use crate::simd::{At, InstructionSet, Lanes};

/// Number of independent sums, in 12 registers of any width: enough to hide the latency of a multiply-add, and not more
/// than the registers allow.
const fn sums(set: InstructionSet) -> usize {
    match set {
        InstructionSet::Portable => PORTABLE,
        InstructionSet::Avx2 => AVX2,
        InstructionSet::Avx512 => AVX512,
    }
}

/// Sums on registers of 128 bits, four a vector.
pub(super) const PORTABLE: usize = 3;
/// Sums on registers of 256 bits, two a vector.
pub(super) const AVX2: usize = 6;
/// Sums on registers of 512 bits.
pub(super) const AVX512: usize = 12;

/// Runs multiply-adds in registers alone, as fast as an instruction set can; returns the number of floating-point
/// operations, two for each, and their result.
///
/// # Panics
/// If the machine lacks the instruction set.
#[must_use]
pub fn multiply_adds<T: Precision>(set: InstructionSet, rounds: u32) -> (f64, T) {
    assert!(set.is_available(), "an instruction set of this machine");
    // SAFETY: the set is available.
    let result = unsafe { T::multiply_adds(set, rounds) };
    let operations = 2.0 * f64::from(rounds) * (sums(set) * T::LANES) as f64;
    (operations, result)
}

/// # Safety
/// The instruction set of `V` is available.
#[inline(always)]
pub(super) unsafe fn chains<T: Precision, V: Lanes<T>, const N: usize>(rounds: u32) -> T {
    // SAFETY: the set is available; the buffer holds a vector.
    unsafe {
        let (factor, term) = (V::splat(T::of(0.999)), V::splat(T::of(0.001)));
        // Numbers that the compiler does not know: it would compute equal sums once.
        let starts: [[T; 16]; N] = std::array::from_fn(|sum| {
            std::array::from_fn(|lane| T::of(0.5 + 0.01 * (16 * sum + lane) as f64))
        });
        let starts = std::hint::black_box(starts);
        let mut sums: [V; N] = std::array::from_fn(|sum| At::start_of(&starts[sum]).load::<V>());
        for _ in 0..rounds {
            for sum in &mut sums {
                *sum = sum.mul_add(factor, term);
            }
        }
        let mut all = sums[0];
        for sum in &sums[1..] {
            all = all.mul_add(factor, *sum);
        }
        let mut buffer = [T::default(); 16];
        let at = At::new(buffer.as_mut_ptr(), 0, buffer.len());
        at.store(all);
        at.read()
    }
}

/// Reads all numbers, as fast as an instruction set can; returns their sum, of whole vectors only.
///
/// # Panics
/// If the machine lacks the instruction set.
#[must_use]
pub fn read_all<T: Precision>(set: InstructionSet, values: &[T]) -> T {
    assert!(set.is_available(), "an instruction set of this machine");
    // SAFETY: the set is available.
    unsafe { T::read_all(set, values) }
}

/// # Safety
/// The instruction set of `V` is available.
#[inline(always)]
pub(super) unsafe fn sum_all<T: Precision, V: Lanes<T>, const N: usize>(values: &[T]) -> T {
    let first = At::start_of(values);
    // SAFETY: the set is available; vectors lie within the slice, and within the buffer.
    unsafe {
        let one = V::splat(T::of(1.0));
        let mut sums = [V::splat(T::default()); N];
        for part in 0..values.len() / (N * T::LANES) {
            for (sum, index) in sums.iter_mut().zip(0..N) {
                let at = first.add((part * N + index) * T::LANES);
                *sum = at.load::<V>().mul_add(one, *sum);
            }
        }
        let mut buffer = [T::default(); 16];
        let at = At::new(buffer.as_mut_ptr(), 0, buffer.len());
        for sum in sums {
            at.store(sum.mul_add(one, at.load::<V>()));
        }
        buffer.iter().fold(T::default(), |sum, value| sum + *value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::Real;

    /// Each chain tends to 1, so the sum to 1 + .999 (1 + .999 (..)).
    #[test]
    #[cfg_attr(miri, ignore = "many steps")]
    fn chains_converge_to_their_fixed_point() {
        for set in InstructionSet::available() {
            let expected = (1.0 - 0.999_f64.powi(sums(set) as i32)) / (1.0 - 0.999);
            let (operations, result) = multiply_adds::<f64>(set, 50_000);
            assert!(
                (result - expected).abs() < 1e-9 * expected,
                "{set:?}: {result}"
            );
            assert_eq!(operations, 2.0 * 50_000.0 * (8 * sums(set)) as f64);
            let (_, result) = multiply_adds::<f32>(set, 50_000);
            assert!(
                (result.to_f64() - expected).abs() < 1e-3 * expected,
                "{set:?}: {result}"
            );
        }
    }

    #[test]
    fn every_number_is_read() {
        let values: Vec<f64> = (0..96 * 5).map(f64::from).collect();
        for set in InstructionSet::available() {
            let expected = (480 * 479 / 2) as f64;
            assert_eq!(read_all(set, &values), expected, "{set:?}");
        }
    }
}
