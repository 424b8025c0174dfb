//! Pairs of 256-bit vectors.

#![allow(unsafe_code, reason = "the contract stands at `Lanes`")]
#![allow(
    clippy::undocumented_unsafe_blocks,
    reason = "each block is one or two instructions, under the contract of `Lanes`"
)]

use std::arch::x86_64::*;

use super::lanes::{Lanes, MOST};
use super::real::bits;

/// Two 256-bit vectors.
#[derive(Clone, Copy)]
pub(crate) struct Avx2<V>(V, V);

/// The first three columns of four rows.
///
/// # Safety
/// As for the methods of [`Lanes`].
#[inline(always)]
unsafe fn columns(
    a: *const [f64; 4],
    b: *const [f64; 4],
    c: *const [f64; 4],
    d: *const [f64; 4],
) -> [__m256d; 3] {
    unsafe {
        let (a, b) = (_mm256_loadu_pd(a.cast()), _mm256_loadu_pd(b.cast()));
        let (c, d) = (_mm256_loadu_pd(c.cast()), _mm256_loadu_pd(d.cast()));
        let (xz_ab, xz_cd) = (_mm256_unpacklo_pd(a, b), _mm256_unpacklo_pd(c, d));
        let (yw_ab, yw_cd) = (_mm256_unpackhi_pd(a, b), _mm256_unpackhi_pd(c, d));
        [
            _mm256_permute2f128_pd::<0x20>(xz_ab, xz_cd),
            _mm256_permute2f128_pd::<0x20>(yw_ab, yw_cd),
            _mm256_permute2f128_pd::<0x31>(xz_ab, xz_cd),
        ]
    }
}

/// Writes three columns and one of zeros as four rows.
///
/// # Safety
/// As for the methods of [`Lanes`].
#[inline(always)]
unsafe fn rows([x, y, z]: [__m256d; 3], to: *mut [f64; 4], stride: usize) {
    unsafe {
        let zero = _mm256_setzero_pd();
        let (xy_even, xy_odd) = (_mm256_unpacklo_pd(x, y), _mm256_unpackhi_pd(x, y));
        let (z_even, z_odd) = (_mm256_unpacklo_pd(z, zero), _mm256_unpackhi_pd(z, zero));
        _mm256_storeu_pd(to.cast(), _mm256_permute2f128_pd::<0x20>(xy_even, z_even));
        _mm256_storeu_pd(
            to.add(stride).cast(),
            _mm256_permute2f128_pd::<0x20>(xy_odd, z_odd),
        );
        _mm256_storeu_pd(
            to.add(2 * stride).cast(),
            _mm256_permute2f128_pd::<0x31>(xy_even, z_even),
        );
        _mm256_storeu_pd(
            to.add(3 * stride).cast(),
            _mm256_permute2f128_pd::<0x31>(xy_odd, z_odd),
        );
    }
}

/// A row and the fourth after it.
///
/// # Safety
/// As for the methods of [`Lanes`].
#[inline(always)]
unsafe fn single_pair(rows: &[*const [f32; 4]; MOST], first: usize) -> __m256 {
    unsafe {
        let low = _mm256_castps128_ps256(_mm_loadu_ps(rows[first].cast()));
        _mm256_insertf128_ps::<1>(low, _mm_loadu_ps(rows[first + 4].cast()))
    }
}

/// The first three columns of eight rows.
///
/// # Safety
/// As for the methods of [`Lanes`].
#[inline(always)]
unsafe fn single_columns(rows: &[*const [f32; 4]; MOST], first: usize) -> [__m256; 3] {
    unsafe {
        let (a, b) = (single_pair(rows, first), single_pair(rows, first + 1));
        let (c, d) = (single_pair(rows, first + 2), single_pair(rows, first + 3));
        let (xy_ab, xy_cd) = (_mm256_unpacklo_ps(a, b), _mm256_unpacklo_ps(c, d));
        let (z_ab, z_cd) = (_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d));
        [
            _mm256_shuffle_ps::<0x44>(xy_ab, xy_cd),
            _mm256_shuffle_ps::<0xee>(xy_ab, xy_cd),
            _mm256_shuffle_ps::<0x44>(z_ab, z_cd),
        ]
    }
}

/// Writes three columns and one of zeros as eight rows.
///
/// # Safety
/// As for the methods of [`Lanes`].
#[inline(always)]
unsafe fn single_rows([x, y, z]: [__m256; 3], to: *mut [f32; 4], stride: usize) {
    unsafe {
        let zero = _mm256_setzero_ps();
        let (xy_low, z_low) = (_mm256_unpacklo_ps(x, y), _mm256_unpacklo_ps(z, zero));
        let (xy_high, z_high) = (_mm256_unpackhi_ps(x, y), _mm256_unpackhi_ps(z, zero));
        let rows = [
            _mm256_shuffle_ps::<0x44>(xy_low, z_low),
            _mm256_shuffle_ps::<0xee>(xy_low, z_low),
            _mm256_shuffle_ps::<0x44>(xy_high, z_high),
            _mm256_shuffle_ps::<0xee>(xy_high, z_high),
        ];
        for (n, row) in rows.into_iter().enumerate() {
            _mm_storeu_ps(to.add(n * stride).cast(), _mm256_castps256_ps128(row));
            let high = _mm256_extractf128_ps::<1>(row);
            _mm_storeu_ps(to.add((n + 4) * stride).cast(), high);
        }
    }
}

impl Lanes<f64> for Avx2<__m256d> {
    #[inline(always)]
    unsafe fn splat(value: f64) -> Self {
        unsafe {
            let value = _mm256_set1_pd(value);
            Self(value, value)
        }
    }

    #[inline(always)]
    unsafe fn load(from: *const f64) -> Self {
        unsafe { Self(_mm256_loadu_pd(from), _mm256_loadu_pd(from.add(4))) }
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut f64) {
        unsafe {
            _mm256_storeu_pd(to, self.0);
            _mm256_storeu_pd(to.add(4), self.1);
        }
    }

    #[inline(always)]
    unsafe fn gather(from: *const f64, index: *const u32) -> Self {
        unsafe {
            let first = _mm_loadu_si128(index.cast());
            let second = _mm_loadu_si128(index.add(4).cast());
            Self(
                _mm256_i32gather_pd::<8>(from, first),
                _mm256_i32gather_pd::<8>(from, second),
            )
        }
    }

    #[inline(always)]
    unsafe fn from_rows(rows: [*const [f64; 4]; MOST]) -> [Self; 3] {
        unsafe {
            let [x0, y0, z0] = columns(rows[0], rows[1], rows[2], rows[3]);
            let [x1, y1, z1] = columns(rows[4], rows[5], rows[6], rows[7]);
            [Self(x0, x1), Self(y0, y1), Self(z0, z1)]
        }
    }

    #[inline(always)]
    unsafe fn to_rows([x, y, z]: [Self; 3], to: *mut [f64; 4], stride: usize) {
        unsafe {
            rows([x.0, y.0, z.0], to, stride);
            rows([x.1, y.1, z.1], to.add(4 * stride), stride);
        }
    }

    #[inline(always)]
    unsafe fn prefetch(from: *const f64) {
        unsafe { _mm_prefetch::<_MM_HINT_T0>(from.cast()) }
    }

    #[inline(always)]
    unsafe fn add(self, other: Self) -> Self {
        unsafe {
            Self(
                _mm256_add_pd(self.0, other.0),
                _mm256_add_pd(self.1, other.1),
            )
        }
    }

    #[inline(always)]
    unsafe fn sub(self, other: Self) -> Self {
        unsafe {
            Self(
                _mm256_sub_pd(self.0, other.0),
                _mm256_sub_pd(self.1, other.1),
            )
        }
    }

    #[inline(always)]
    unsafe fn mul(self, other: Self) -> Self {
        unsafe {
            Self(
                _mm256_mul_pd(self.0, other.0),
                _mm256_mul_pd(self.1, other.1),
            )
        }
    }

    #[inline(always)]
    unsafe fn div(self, other: Self) -> Self {
        unsafe {
            Self(
                _mm256_div_pd(self.0, other.0),
                _mm256_div_pd(self.1, other.1),
            )
        }
    }

    #[inline(always)]
    unsafe fn sqrt(self) -> Self {
        unsafe { Self(_mm256_sqrt_pd(self.0), _mm256_sqrt_pd(self.1)) }
    }

    #[inline(always)]
    unsafe fn two_to_it(self) -> Self {
        unsafe {
            let of = |x| {
                let biased = _mm256_add_pd(x, _mm256_set1_pd(bits::BIASED_DOUBLE));
                let shifted =
                    _mm256_slli_epi64::<{ bits::OF_DOUBLE as i32 }>(_mm256_castpd_si256(biased));
                _mm256_castsi256_pd(shifted)
            };
            Self(of(self.0), of(self.1))
        }
    }

    #[inline(always)]
    unsafe fn parts(self) -> [Self; 2] {
        unsafe {
            let of = |x| {
                let own = _mm256_castpd_si256(x);
                let root = _mm256_set1_epi64x(bits::ROOT_OF_DOUBLE as i64);
                let exponent =
                    _mm256_srli_epi64::<{ bits::OF_DOUBLE as i32 }>(_mm256_sub_epi64(own, root));
                let shifted = _mm256_slli_epi64::<{ bits::OF_DOUBLE as i32 }>(exponent);
                let mantissa = _mm256_sub_epi64(
                    _mm256_add_epi64(own, _mm256_set1_epi64x(1_i64 << 62)),
                    shifted,
                );
                let ones = _mm256_castpd_si256(_mm256_set1_pd(bits::WHOLE_DOUBLE));
                let whole = _mm256_castsi256_pd(_mm256_or_si256(exponent, ones));
                let offset = _mm256_set1_pd(bits::WHOLE_DOUBLE + 1024.0);
                (_mm256_castsi256_pd(mantissa), _mm256_sub_pd(whole, offset))
            };
            let ((a, b), (c, d)) = (of(self.0), of(self.1));
            [Self(a, c), Self(b, d)]
        }
    }

    #[inline(always)]
    unsafe fn at_most(self, other: Self) -> u32 {
        unsafe {
            let of = |a, b| _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(a, b)) as u32;
            of(self.0, other.0) | of(self.1, other.1) << 4
        }
    }

    #[inline(always)]
    unsafe fn select_le(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        unsafe {
            let of = |a, b, then, otherwise| {
                _mm256_blendv_pd(otherwise, then, _mm256_cmp_pd::<_CMP_LE_OQ>(a, b))
            };
            Self(
                of(a.0, b.0, then.0, otherwise.0),
                of(a.1, b.1, then.1, otherwise.1),
            )
        }
    }

    #[inline(always)]
    unsafe fn mul_add(self, factor: Self, other: Self) -> Self {
        unsafe {
            Self(
                _mm256_fmadd_pd(self.0, factor.0, other.0),
                _mm256_fmadd_pd(self.1, factor.1, other.1),
            )
        }
    }

    #[inline(always)]
    unsafe fn clamp(self, limit: Self) -> Self {
        unsafe {
            // The second operand is kept where one is not a number.
            let least = _mm256_sub_pd(_mm256_setzero_pd(), limit.0);
            Self(
                _mm256_max_pd(least, _mm256_min_pd(limit.0, self.0)),
                _mm256_max_pd(least, _mm256_min_pd(limit.0, self.1)),
            )
        }
    }

    #[inline(always)]
    unsafe fn flush(self, tiny: Self) -> Self {
        unsafe {
            let sign = _mm256_set1_pd(-0.0);
            let of = |x| {
                let size = _mm256_andnot_pd(sign, x);
                _mm256_and_pd(x, _mm256_cmp_pd::<_CMP_NLT_UQ>(size, tiny.0))
            };
            Self(of(self.0), of(self.1))
        }
    }

    #[inline(always)]
    unsafe fn reaches(self, limit: Self) -> u32 {
        unsafe {
            let sign = _mm256_set1_pd(-0.0);
            let of = |x| {
                let size = _mm256_andnot_pd(sign, x);
                _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_GE_OQ>(size, limit.0)) as u32
            };
            of(self.0) | of(self.1) << 4
        }
    }

    #[inline(always)]
    unsafe fn exceeds(self, limit: Self) -> u32 {
        unsafe {
            let sign = _mm256_set1_pd(-0.0);
            let of = |x| {
                let size = _mm256_andnot_pd(sign, x);
                _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_NLE_UQ>(size, limit.0)) as u32
            };
            of(self.0) | of(self.1) << 4
        }
    }
}

impl Lanes<f32> for Avx2<__m256> {
    #[inline(always)]
    unsafe fn splat(value: f32) -> Self {
        unsafe {
            let value = _mm256_set1_ps(value);
            Self(value, value)
        }
    }

    #[inline(always)]
    unsafe fn load(from: *const f32) -> Self {
        unsafe { Self(_mm256_loadu_ps(from), _mm256_loadu_ps(from.add(8))) }
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut f32) {
        unsafe {
            _mm256_storeu_ps(to, self.0);
            _mm256_storeu_ps(to.add(8), self.1);
        }
    }

    #[inline(always)]
    unsafe fn gather(from: *const f32, index: *const u32) -> Self {
        unsafe {
            let first = _mm256_loadu_si256(index.cast());
            let second = _mm256_loadu_si256(index.add(8).cast());
            Self(
                _mm256_i32gather_ps::<4>(from, first),
                _mm256_i32gather_ps::<4>(from, second),
            )
        }
    }

    #[inline(always)]
    unsafe fn from_rows(rows: [*const [f32; 4]; MOST]) -> [Self; 3] {
        unsafe {
            let [x0, y0, z0] = single_columns(&rows, 0);
            let [x1, y1, z1] = single_columns(&rows, 8);
            [Self(x0, x1), Self(y0, y1), Self(z0, z1)]
        }
    }

    #[inline(always)]
    unsafe fn to_rows([x, y, z]: [Self; 3], to: *mut [f32; 4], stride: usize) {
        unsafe {
            single_rows([x.0, y.0, z.0], to, stride);
            single_rows([x.1, y.1, z.1], to.add(8 * stride), stride);
        }
    }

    #[inline(always)]
    unsafe fn prefetch(from: *const f32) {
        unsafe { _mm_prefetch::<_MM_HINT_T0>(from.cast()) }
    }

    #[inline(always)]
    unsafe fn add(self, other: Self) -> Self {
        unsafe {
            Self(
                _mm256_add_ps(self.0, other.0),
                _mm256_add_ps(self.1, other.1),
            )
        }
    }

    #[inline(always)]
    unsafe fn sub(self, other: Self) -> Self {
        unsafe {
            Self(
                _mm256_sub_ps(self.0, other.0),
                _mm256_sub_ps(self.1, other.1),
            )
        }
    }

    #[inline(always)]
    unsafe fn mul(self, other: Self) -> Self {
        unsafe {
            Self(
                _mm256_mul_ps(self.0, other.0),
                _mm256_mul_ps(self.1, other.1),
            )
        }
    }

    #[inline(always)]
    unsafe fn div(self, other: Self) -> Self {
        unsafe {
            Self(
                _mm256_div_ps(self.0, other.0),
                _mm256_div_ps(self.1, other.1),
            )
        }
    }

    #[inline(always)]
    unsafe fn sqrt(self) -> Self {
        unsafe { Self(_mm256_sqrt_ps(self.0), _mm256_sqrt_ps(self.1)) }
    }

    #[inline(always)]
    unsafe fn two_to_it(self) -> Self {
        unsafe {
            let of = |x| {
                let biased = _mm256_add_ps(x, _mm256_set1_ps(bits::BIASED_SINGLE));
                let shifted =
                    _mm256_slli_epi32::<{ bits::OF_SINGLE as i32 }>(_mm256_castps_si256(biased));
                _mm256_castsi256_ps(shifted)
            };
            Self(of(self.0), of(self.1))
        }
    }

    #[inline(always)]
    unsafe fn parts(self) -> [Self; 2] {
        unsafe {
            let of = |x| {
                let own = _mm256_castps_si256(x);
                let root = _mm256_set1_epi32(bits::ROOT_OF_SINGLE as i32);
                let exponent =
                    _mm256_srli_epi32::<{ bits::OF_SINGLE as i32 }>(_mm256_sub_epi32(own, root));
                let shifted = _mm256_slli_epi32::<{ bits::OF_SINGLE as i32 }>(exponent);
                let mantissa = _mm256_sub_epi32(
                    _mm256_add_epi32(own, _mm256_set1_epi32(1_i32 << 30)),
                    shifted,
                );
                let ones = _mm256_castps_si256(_mm256_set1_ps(bits::WHOLE_SINGLE));
                let whole = _mm256_castsi256_ps(_mm256_or_si256(exponent, ones));
                let offset = _mm256_set1_ps(bits::WHOLE_SINGLE + 128.0);
                (_mm256_castsi256_ps(mantissa), _mm256_sub_ps(whole, offset))
            };
            let ((a, b), (c, d)) = (of(self.0), of(self.1));
            [Self(a, c), Self(b, d)]
        }
    }

    #[inline(always)]
    unsafe fn at_most(self, other: Self) -> u32 {
        unsafe {
            let of = |a, b| _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32;
            of(self.0, other.0) | of(self.1, other.1) << 8
        }
    }

    #[inline(always)]
    unsafe fn select_le(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        unsafe {
            let of = |a, b, then, otherwise| {
                _mm256_blendv_ps(otherwise, then, _mm256_cmp_ps::<_CMP_LE_OQ>(a, b))
            };
            Self(
                of(a.0, b.0, then.0, otherwise.0),
                of(a.1, b.1, then.1, otherwise.1),
            )
        }
    }

    #[inline(always)]
    unsafe fn mul_add(self, factor: Self, other: Self) -> Self {
        unsafe {
            Self(
                _mm256_fmadd_ps(self.0, factor.0, other.0),
                _mm256_fmadd_ps(self.1, factor.1, other.1),
            )
        }
    }

    #[inline(always)]
    unsafe fn clamp(self, limit: Self) -> Self {
        unsafe {
            // The second operand is kept where one is not a number.
            let least = _mm256_sub_ps(_mm256_setzero_ps(), limit.0);
            Self(
                _mm256_max_ps(least, _mm256_min_ps(limit.0, self.0)),
                _mm256_max_ps(least, _mm256_min_ps(limit.0, self.1)),
            )
        }
    }

    #[inline(always)]
    unsafe fn flush(self, tiny: Self) -> Self {
        unsafe {
            let sign = _mm256_set1_ps(-0.0);
            let of = |x| {
                let size = _mm256_andnot_ps(sign, x);
                _mm256_and_ps(x, _mm256_cmp_ps::<_CMP_NLT_UQ>(size, tiny.0))
            };
            Self(of(self.0), of(self.1))
        }
    }

    #[inline(always)]
    unsafe fn reaches(self, limit: Self) -> u32 {
        unsafe {
            let sign = _mm256_set1_ps(-0.0);
            let of = |x| {
                let size = _mm256_andnot_ps(sign, x);
                _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_GE_OQ>(size, limit.0)) as u32
            };
            of(self.0) | of(self.1) << 8
        }
    }

    #[inline(always)]
    unsafe fn exceeds(self, limit: Self) -> u32 {
        unsafe {
            let sign = _mm256_set1_ps(-0.0);
            let of = |x| {
                let size = _mm256_andnot_ps(sign, x);
                _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_NLE_UQ>(size, limit.0)) as u32
            };
            of(self.0) | of(self.1) << 8
        }
    }
}
