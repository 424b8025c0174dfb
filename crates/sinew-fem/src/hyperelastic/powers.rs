//! Exponentials and logarithms of all lanes together.

use sinew_sparse::simd::Number;

/// The largest size of x for [`exp_m1`]: the largest number is reached a little beyond it.
#[inline(always)]
fn largest_exponent<N: Number>() -> f64 {
    if is_double::<N>() { 700.0 } else { 86.0 }
}

/// The largest exponent of laws that grow exponentially: up to it the squares of stresses and tangents are finite; in
/// single precision, which computes forces only, the stresses themselves.
#[inline(always)]
pub(super) fn largest_lawful_exponent<N: Number>() -> f64 {
    let share = if is_double::<N>() { 0.25 } else { 0.5 };
    share * largest_exponent::<N>()
}

#[inline(always)]
fn is_double<N: Number>() -> bool {
    N::EPSILON < 1e-10
}

/// The high and the low part of ln 2; a multiple of the first by any exponent is exact in its precision.
const LN_2_OF_DOUBLE: [f64; 2] = [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10];
const LN_2_OF_SINGLE: [f64; 2] = [0.693_359_375, -2.121_944_400_546_905_8e-4];

/// The factors 1/n! from the last to that of x^2.
const OF_EXPONENTIAL: [f64; 13] = [
    1.0 / 87_178_291_200.0,
    1.0 / 6_227_020_800.0,
    1.0 / 479_001_600.0,
    1.0 / 39_916_800.0,
    1.0 / 3_628_800.0,
    1.0 / 362_880.0,
    1.0 / 40_320.0,
    1.0 / 5040.0,
    1.0 / 720.0,
    1.0 / 120.0,
    1.0 / 24.0,
    1.0 / 6.0,
    0.5,
];

/// Terms of an exponential that single precision leaves out.
const LEFT_OUT_OF_EXPONENTIAL: usize = 6;

/// `exp(x) - 1`, to one or two roundings of the result also for small x, for x up to [`largest_exponent`] in size;
/// beyond that the value at the bound.
#[inline(always)]
pub(super) fn exp_m1<N: Number>(x: N) -> N {
    let (most, one) = (N::of(largest_exponent::<N>()), N::of(1.0));
    let x = x.min(most).max(-most);
    // The sum with it has no places after the point.
    let whole = N::of(1.5 / N::EPSILON);
    let exponent = x.mul_add(N::of(std::f64::consts::LOG2_E), whole) - whole;
    let [high, low] = if is_double::<N>() {
        LN_2_OF_DOUBLE
    } else {
        LN_2_OF_SINGLE
    };
    let rest = exponent.mul_add(N::of(-high), x);
    let rest = exponent.mul_add(N::of(-low), rest);
    let skipped = if is_double::<N>() {
        0
    } else {
        LEFT_OUT_OF_EXPONENTIAL
    };
    let mut sum = N::of(OF_EXPONENTIAL[skipped]);
    for factor in &OF_EXPONENTIAL[skipped + 1..] {
        sum = sum.mul_add(rest, N::of(*factor));
    }
    let grown = (sum * rest).mul_add(rest, rest);
    let scale = exponent.two_to_it();
    scale.mul_add(grown, scale - one)
}

/// Terms of the logarithm's series.
const OF_LOGARITHM: usize = 11;

/// Terms of a logarithm that single precision leaves out.
const LEFT_OUT_OF_LOGARITHM: usize = 6;

/// `ln(1 + x)`, to one or two roundings of the result also for small x; x is above -1.
#[inline(always)]
pub(super) fn ln_1p<N: Number>(x: N) -> N {
    let (one, zero) = (N::of(1.0), N::of(0.0));
    let [mantissa, exponent] = (x + one).parts();
    // Where 1 + x is not scaled its last digits are those of x.
    let rest = N::select_le(exponent.abs(), zero, x, mantissa - one);
    let share = rest / (rest + N::of(2.0));
    let [high, low] = if is_double::<N>() {
        LN_2_OF_DOUBLE
    } else {
        LN_2_OF_SINGLE
    };
    let scaled = exponent.mul_add(N::of(low), after_first(share * share) * share);
    // 2 s is rest - s rest, of which the first is exact.
    let near = (-share).mul_add(rest, scaled);
    exponent.mul_add(N::of(high), rest + near)
}

/// `2 (artanh(s)/s - 1)` of the square of s, for s of up to .172.
#[inline(always)]
fn after_first<N: Number>(squared: N) -> N {
    let skipped = if is_double::<N>() {
        0
    } else {
        LEFT_OUT_OF_LOGARITHM
    };
    let factor = |term: usize| N::of(2.0 / (2 * term + 1) as f64);
    let mut sum = factor(OF_LOGARITHM - skipped);
    for term in (1..OF_LOGARITHM - skipped).rev() {
        sum = sum.mul_add(squared, factor(term));
    }
    sum * squared
}

/// Size of s up to which [`artanh_share`] is a series.
pub(super) const NEAR: f64 = 0.1;

/// `artanh(s)/s` of the square of s, for s of up to [`NEAR`] in size.
#[inline(always)]
pub(super) fn artanh_share<N: Number>(squared: N) -> N {
    let mut sum = N::of(1.0 / 15.0);
    for divisor in [13.0, 11.0, 9.0, 7.0, 5.0, 3.0, 1.0] {
        sum = sum.mul_add(squared, N::of(1.0 / divisor));
    }
    sum
}

/// Size of x up to which [`sinh_share`] is a series.
pub(super) const SMALL: f64 = 0.25;

/// `sinh(x)/x` of the square of x, for x of up to [`SMALL`] in size.
#[inline(always)]
pub(super) fn sinh_share<N: Number>(squared: N) -> N {
    let mut sum = N::of(1.0 / 39_916_800.0);
    for divisor in [362_880.0, 5040.0, 120.0, 6.0, 1.0] {
        sum = sum.mul_add(squared, N::of(1.0 / divisor));
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_sparse::simd::{InstructionSet, WithNumber};

    struct Functions;

    impl WithNumber for Functions {
        type Output = f64;

        /// The largest error, in roundings.
        #[inline(always)]
        fn run<N: Number>(self) -> f64 {
            let mut worst = 0.0_f64;
            for step in -800..=800 {
                let size = 1.03_f64.powi(step);
                let sign = |lane: usize| if lane.is_multiple_of(2) { 1.0 } else { -1.0 };
                let x = N::from_lanes(|lane| sign(lane) * size * (1.0 + 0.01 * lane as f64));
                if size < 60.0 {
                    let found = exp_m1(x);
                    for lane in 0..N::LANES {
                        let expected = x.lane(lane).exp_m1();
                        worst = worst.max((found.lane(lane) / expected - 1.0).abs());
                    }
                }
                let x = N::select_le(x, N::of(-0.999), -x, x);
                let found = ln_1p(x);
                for lane in 0..N::LANES {
                    let expected = x.lane(lane).ln_1p();
                    worst = worst.max((found.lane(lane) / expected - 1.0).abs());
                }
            }
            worst / N::EPSILON
        }
    }

    #[test]
    fn functions_are_those_of_the_library_to_some_roundings() {
        for set in InstructionSet::available() {
            for worst in [set.with_f64(Functions), set.with_f32(Functions)] {
                let worst = worst.unwrap();
                assert!(worst < 3.0, "{set:?}: {worst} roundings");
            }
        }
        for worst in [Functions.run::<f64>(), Functions.run::<f32>()] {
            assert!(worst < 3.0, "{worst} roundings");
        }
    }

    #[test]
    fn shares_of_series_join_the_functions_where_they_end() {
        let near = NEAR.atanh() / NEAR;
        assert!((artanh_share(NEAR * NEAR) / near - 1.0).abs() < 1e-15);
        let small = SMALL.sinh() / SMALL;
        assert!((sinh_share(SMALL * SMALL) / small - 1.0).abs() < 1e-15);
    }

    #[test]
    fn what_is_too_large_is_that_of_the_bound() {
        assert_eq!(exp_m1(1e4), exp_m1(700.0));
        assert!(exp_m1(1e4_f64).is_finite() && exp_m1(1e4_f32).is_finite());
        assert!((exp_m1(-1e4_f64) + 1.0).abs() < 1e-15);
    }
}
