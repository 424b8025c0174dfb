//! Numbers for which formulas are written.

#![allow(unsafe_code, reason = "a kernel; ARCHITECTURE.md names it")]

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::portable::FUSES;
use super::real::Real;

/// A number, or a vector of them that one instruction works on: a formula is written once and compiled for each.
///
/// All arithmetic is lane by lane. Branches are choices between two values ([`Number::select_le`]); iterations check if
/// all lanes are done ([`Number::all_le`]).
pub trait Number:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The number of a lane.
    type Real: Real;
    /// Numbers side by side.
    const LANES: usize;
    /// Distance from 1 to the next larger number of a lane.
    const EPSILON: f64;

    /// The number nearest to `value`, in every lane.
    fn of(value: f64) -> Self;

    /// The number of a lane, exactly.
    fn lane(self, lane: usize) -> f64;

    /// Numbers by their lanes, each rounded to the nearest.
    fn from_lanes(of: impl FnMut(usize) -> f64) -> Self;

    /// The first numbers of a slice, which has at least one for each lane.
    fn load(from: &[Self::Real]) -> Self;

    /// Writes the lanes to the beginning of a slice, which has space for them.
    fn store(self, to: &mut [Self::Real]);

    /// The first three numbers of some rows, one row per lane: each of `places` is the index of a row's first number
    /// among the numbers of all rows, four times the row, so that no address needs a separate instruction. The bounds
    /// of `from` are not checked: with a check before each row, compilers keep all places on the stack.
    ///
    /// # Safety
    /// All places are four times a number below the length of `from`.
    unsafe fn gather_rows(from: &[[Self::Real; 4]], places: &[u32]) -> [Self; 3];

    /// The first three numbers of each of some rows, `stride` rows apart from the first.
    fn load_rows(from: &[[Self::Real; 4]], stride: usize) -> [Self; 3];

    /// Writes three numbers and 0 to a row for each lane, `stride` rows apart from the first.
    fn store_rows(columns: [Self; 3], to: &mut [[Self::Real; 4]], stride: usize);

    /// `self factor + other`, rounded once if the processor can.
    #[must_use]
    fn mul_add(self, factor: Self, other: Self) -> Self;

    /// The square root.
    #[must_use]
    fn sqrt(self) -> Self;

    /// 2 to the power of the number, which is whole and within the range of exponents.
    #[must_use]
    fn two_to_it(self) -> Self;

    /// m and e of `m 2^e`, for a number above 0: m from the root of 1/2 to that of 2, e whole.
    #[must_use]
    fn parts(self) -> [Self; 2];

    /// `then` if `a <= b`, else `otherwise`, also if one of them is NaN.
    #[must_use]
    fn select_le(a: Self, b: Self, then: Self, otherwise: Self) -> Self;

    /// The lanes in which `a <= b`, one bit each, the lowest first; not those with a NaN.
    fn lanes_le(a: Self, b: Self) -> u32;

    /// True if `a <= b` in every lane; false if one of the values is NaN.
    #[inline(always)]
    fn all_le(a: Self, b: Self) -> bool {
        Self::lanes_le(a, b) == (1 << Self::LANES) - 1
    }

    /// True if `a <= b` in any lane.
    #[inline(always)]
    fn any_le(a: Self, b: Self) -> bool {
        Self::lanes_le(a, b) != 0
    }

    /// The absolute value.
    #[inline(always)]
    #[must_use]
    fn abs(self) -> Self {
        Self::select_le(self, Self::of(0.0), -self, self)
    }

    /// The larger one.
    #[inline(always)]
    #[must_use]
    fn max(self, other: Self) -> Self {
        Self::select_le(self, other, other, self)
    }

    /// The smaller one.
    #[inline(always)]
    #[must_use]
    fn min(self, other: Self) -> Self {
        Self::select_le(self, other, self, other)
    }

    /// A function of a number, lane by lane.
    #[inline(always)]
    #[must_use]
    fn map(self, of: impl Fn(f64) -> f64) -> Self {
        Self::from_lanes(|lane| of(self.lane(lane)))
    }

    /// `1 / self`.
    #[inline(always)]
    #[must_use]
    fn recip(self) -> Self {
        Self::of(1.0) / self
    }

    /// The natural logarithm of `1 + self`, exact for small numbers.
    #[inline(always)]
    #[must_use]
    fn ln_1p(self) -> Self {
        self.map(f64::ln_1p)
    }

    /// `e` to the power of the number.
    #[inline(always)]
    #[must_use]
    fn exp(self) -> Self {
        self.map(f64::exp)
    }

    /// `exp(self) - 1`, exact for small numbers.
    #[inline(always)]
    #[must_use]
    fn exp_m1(self) -> Self {
        self.map(f64::exp_m1)
    }

    /// The cubic root.
    #[inline(always)]
    #[must_use]
    fn cbrt(self) -> Self {
        self.map(f64::cbrt)
    }
}

macro_rules! scalar {
    ($number:ident) => {
        impl Number for $number {
            type Real = Self;
            const LANES: usize = 1;
            const EPSILON: f64 = $number::EPSILON as f64;

            #[inline(always)]
            fn of(value: f64) -> Self {
                value as Self
            }

            #[inline(always)]
            fn lane(self, _lane: usize) -> f64 {
                self.into()
            }

            #[inline(always)]
            fn from_lanes(mut of: impl FnMut(usize) -> f64) -> Self {
                of(0) as Self
            }

            #[inline(always)]
            fn load(from: &[Self]) -> Self {
                from[0]
            }

            #[inline(always)]
            fn store(self, to: &mut [Self]) {
                to[0] = self;
            }

            #[inline(always)]
            unsafe fn gather_rows(from: &[[Self; 4]], places: &[u32]) -> [Self; 3] {
                Self::load_rows(&from[places[0] as usize / 4..], 1)
            }

            #[inline(always)]
            fn load_rows(from: &[[Self; 4]], _stride: usize) -> [Self; 3] {
                let [x, y, z, _] = from[0];
                [x, y, z]
            }

            #[inline(always)]
            fn store_rows([x, y, z]: [Self; 3], to: &mut [[Self; 4]], _stride: usize) {
                to[0] = [x, y, z, 0.0];
            }

            #[inline(always)]
            fn mul_add(self, factor: Self, other: Self) -> Self {
                if FUSES {
                    $number::mul_add(self, factor, other)
                } else {
                    self * factor + other
                }
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                $number::sqrt(self)
            }

            #[inline(always)]
            fn two_to_it(self) -> Self {
                Real::two_to_it(self)
            }

            #[inline(always)]
            fn parts(self) -> [Self; 2] {
                Real::parts(self)
            }

            #[inline(always)]
            fn select_le(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
                if a <= b { then } else { otherwise }
            }

            #[inline(always)]
            fn lanes_le(a: Self, b: Self) -> u32 {
                u32::from(a <= b)
            }
        }
    };
}

scalar!(f64);
scalar!(f32);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_a_number_is_never_at_most_another() {
        let nan = f64::NAN;
        assert!(!f64::all_le(nan, 1.0) && !f64::any_le(1.0, nan));
        assert_eq!(f64::select_le(nan, 1.0, 2.0, 3.0), 3.0);
        assert_eq!(f64::select_le(1.0, 1.0, 2.0, 3.0), 2.0);
    }

    #[test]
    fn functions_of_single_precision_are_rounded_from_double() {
        let x: f32 = 1e-6;
        assert_eq!(Number::ln_1p(x), f64::from(x).ln_1p() as f32);
        assert_eq!(Number::cbrt(27.0_f32), 3.0);
    }
}
