//! Kernels for each precision and instruction set.

#![allow(unsafe_code, reason = "a kernel; ARCHITECTURE.md names it")]

use std::ops::Range;

use super::chunk::{Outcome, Precision, Sweep, run};
#[cfg(target_arch = "x86_64")]
use super::peak::{AVX2, AVX512};
use super::peak::{PORTABLE, chains, sum_all};
use crate::simd::{Array, InstructionSet, Vectors, WithReal};
#[cfg(target_arch = "x86_64")]
use crate::simd::{Avx2, Avx512};

macro_rules! precision {
    ($number:ty, $name:literal, $lanes:literal, $of256:ident, $of512:ident) => {
        impl Precision for $number {
            const NAME: &'static str = $name;

            unsafe fn run(
                sweep: &Sweep<'_, Self>,
                set: InstructionSet,
                chunks: Range<usize>,
            ) -> Outcome {
                type Portable = Array<$number, $lanes>;
                #[cfg(target_arch = "x86_64")]
                type Wide = Avx2<std::arch::x86_64::$of256>;
                #[cfg(target_arch = "x86_64")]
                type Widest = Avx512<std::arch::x86_64::$of512>;

                #[cfg(target_arch = "x86_64")]
                #[target_feature(enable = "avx2,fma")]
                unsafe fn avx2<const L: usize>(
                    sweep: &Sweep<'_, $number>,
                    chunks: Range<usize>,
                ) -> Outcome {
                    // SAFETY: promised by the caller of this function.
                    unsafe { run::<$number, Wide, L>(sweep, chunks) }
                }

                #[cfg(target_arch = "x86_64")]
                #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma")]
                unsafe fn avx512<const L: usize>(
                    sweep: &Sweep<'_, $number>,
                    chunks: Range<usize>,
                ) -> Outcome {
                    // SAFETY: promised by the caller of this function.
                    unsafe { run::<$number, Widest, L>(sweep, chunks) }
                }

                // SAFETY: promised by the caller of this function; the set is available.
                unsafe {
                    match (set, sweep.fields.layers()) {
                        #[cfg(target_arch = "x86_64")]
                        (InstructionSet::Avx512, 1) => avx512::<1>(sweep, chunks),
                        #[cfg(target_arch = "x86_64")]
                        (InstructionSet::Avx512, _) => avx512::<3>(sweep, chunks),
                        #[cfg(target_arch = "x86_64")]
                        (InstructionSet::Avx2, 1) => avx2::<1>(sweep, chunks),
                        #[cfg(target_arch = "x86_64")]
                        (InstructionSet::Avx2, _) => avx2::<3>(sweep, chunks),
                        (_, 1) => run::<$number, Portable, 1>(sweep, chunks),
                        (_, _) => run::<$number, Portable, 3>(sweep, chunks),
                    }
                }
            }

            unsafe fn multiply_adds(set: InstructionSet, rounds: u32) -> Self {
                #[cfg(target_arch = "x86_64")]
                #[target_feature(enable = "avx2,fma")]
                unsafe fn avx2(rounds: u32) -> $number {
                    // SAFETY: promised by the caller of this function.
                    unsafe { chains::<$number, Avx2<std::arch::x86_64::$of256>, AVX2>(rounds) }
                }

                #[cfg(target_arch = "x86_64")]
                #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma")]
                unsafe fn avx512(rounds: u32) -> $number {
                    // SAFETY: promised by the caller of this function.
                    unsafe { chains::<$number, Avx512<std::arch::x86_64::$of512>, AVX512>(rounds) }
                }

                // SAFETY: promised by the caller of this function.
                unsafe {
                    match set {
                        #[cfg(target_arch = "x86_64")]
                        InstructionSet::Avx512 => avx512(rounds),
                        #[cfg(target_arch = "x86_64")]
                        InstructionSet::Avx2 => avx2(rounds),
                        _ => chains::<$number, Array<$number, $lanes>, PORTABLE>(rounds),
                    }
                }
            }

            fn with_vectors<W: WithReal<Self>>(set: InstructionSet, work: W) -> W::Output {
                Self::with_vectors_or_numbers(set, work)
            }

            unsafe fn read_all(set: InstructionSet, values: &[Self]) -> Self {
                #[cfg(target_arch = "x86_64")]
                #[target_feature(enable = "avx2,fma")]
                unsafe fn avx2(values: &[$number]) -> $number {
                    // SAFETY: promised by the caller of this function.
                    unsafe { sum_all::<$number, Avx2<std::arch::x86_64::$of256>, AVX2>(values) }
                }

                #[cfg(target_arch = "x86_64")]
                #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma")]
                unsafe fn avx512(values: &[$number]) -> $number {
                    // SAFETY: promised by the caller of this function.
                    unsafe { sum_all::<$number, Avx512<std::arch::x86_64::$of512>, AVX512>(values) }
                }

                // SAFETY: promised by the caller of this function.
                unsafe {
                    match set {
                        #[cfg(target_arch = "x86_64")]
                        InstructionSet::Avx512 => avx512(values),
                        #[cfg(target_arch = "x86_64")]
                        InstructionSet::Avx2 => avx2(values),
                        _ => sum_all::<$number, Array<$number, $lanes>, PORTABLE>(values),
                    }
                }
            }
        }
    };
}

precision!(f64, "f64", 8, __m256d, __m512d);
precision!(f32, "f32", 16, __m256, __m512);
