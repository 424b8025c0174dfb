//! Plain arrays, which the compiler turns into the build's own vectors.

#![allow(unsafe_code, reason = "the contract stands at `Lanes`")]

use super::lanes::Lanes;
use super::real::Real;

/// Numbers in an array of `N = T::LANES`.
#[derive(Clone, Copy)]
pub(crate) struct Array<T, const N: usize>([T; N]);

/// True if the build itself has a fused multiply-add instruction; without one the call would be a library function.
pub(super) const FUSES: bool = cfg!(any(target_feature = "fma", target_arch = "aarch64"));

macro_rules! array {
    ($number:ty, $lanes:literal) => {
        impl Array<$number, $lanes> {
            #[inline(always)]
            fn each(self, other: Self, of: impl Fn($number, $number) -> $number) -> Self {
                Self(std::array::from_fn(|i| of(self.0[i], other.0[i])))
            }

            #[inline(always)]
            fn bits(self, holds: impl Fn($number) -> bool) -> u32 {
                let mut bits = 0;
                for (i, value) in self.0.iter().enumerate() {
                    bits |= u32::from(holds(*value)) << i;
                }
                bits
            }
        }

        impl Lanes<$number> for Array<$number, $lanes> {
            #[inline(always)]
            unsafe fn splat(value: $number) -> Self {
                Self([value; $lanes])
            }

            #[inline(always)]
            unsafe fn load(from: *const $number) -> Self {
                // SAFETY: `from` is valid for as many numbers as the array has.
                unsafe { from.cast::<Self>().read_unaligned() }
            }

            #[inline(always)]
            unsafe fn store(self, to: *mut $number) {
                // SAFETY: `to` is valid for as many numbers as the array has.
                unsafe { to.cast::<Self>().write_unaligned(self) }
            }

            #[inline(always)]
            unsafe fn gather(from: *const $number, index: *const u32) -> Self {
                Self(std::array::from_fn(|i| {
                    // SAFETY: `index` is valid for as many indices as the array has numbers, and
                    // `from` for a number at each of them.
                    unsafe { *from.add(*index.add(i) as usize) }
                }))
            }

            #[inline(always)]
            unsafe fn prefetch(_from: *const $number) {}

            #[inline(always)]
            unsafe fn add(self, other: Self) -> Self {
                self.each(other, |a, b| a + b)
            }

            #[inline(always)]
            unsafe fn sub(self, other: Self) -> Self {
                self.each(other, |a, b| a - b)
            }

            #[inline(always)]
            unsafe fn mul(self, other: Self) -> Self {
                self.each(other, |a, b| a * b)
            }

            #[inline(always)]
            unsafe fn div(self, other: Self) -> Self {
                self.each(other, |a, b| a / b)
            }

            #[inline(always)]
            unsafe fn sqrt(self) -> Self {
                Self(self.0.map(<$number>::sqrt))
            }

            #[inline(always)]
            unsafe fn two_to_it(self) -> Self {
                Self(self.0.map(Real::two_to_it))
            }

            #[inline(always)]
            unsafe fn parts(self) -> [Self; 2] {
                [0, 1].map(|part| Self(self.0.map(|value| value.parts()[part])))
            }

            #[inline(always)]
            unsafe fn at_most(self, other: Self) -> u32 {
                let mut bits = 0;
                for (i, (a, b)) in self.0.iter().zip(&other.0).enumerate() {
                    bits |= u32::from(a <= b) << i;
                }
                bits
            }

            #[inline(always)]
            unsafe fn select_le(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
                Self(std::array::from_fn(|i| {
                    if a.0[i] <= b.0[i] {
                        then.0[i]
                    } else {
                        otherwise.0[i]
                    }
                }))
            }

            #[inline(always)]
            unsafe fn mul_add(self, factor: Self, other: Self) -> Self {
                Self(std::array::from_fn(|i| {
                    if FUSES {
                        self.0[i].mul_add(factor.0[i], other.0[i])
                    } else {
                        self.0[i] * factor.0[i] + other.0[i]
                    }
                }))
            }

            #[inline(always)]
            unsafe fn clamp(self, limit: Self) -> Self {
                self.each(limit, |a, limit| {
                    if a > limit {
                        limit
                    } else if a < -limit {
                        -limit
                    } else {
                        a
                    }
                })
            }

            #[inline(always)]
            unsafe fn flush(self, tiny: Self) -> Self {
                self.each(tiny, |a, tiny| if a.abs() < tiny { 0.0 } else { a })
            }

            #[inline(always)]
            unsafe fn reaches(self, limit: Self) -> u32 {
                self.bits(|value| value.abs() >= limit.0[0])
            }

            #[inline(always)]
            unsafe fn exceeds(self, limit: Self) -> u32 {
                self.bits(|value| value.is_nan() || value.abs() > limit.0[0])
            }
        }
    };
}

array!(f64, 8);
array!(f32, 16);
