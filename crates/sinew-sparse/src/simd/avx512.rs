//! 512-bit vectors.

#![allow(unsafe_code, reason = "the contract stands at `Lanes`")]
#![allow(
    clippy::undocumented_unsafe_blocks,
    reason = "each block is one instruction, under the contract of `Lanes`"
)]

use std::arch::x86_64::*;

use super::lanes::{Lanes, MOST};
use super::real::bits;

/// A 512-bit vector.
#[derive(Clone, Copy)]
pub(crate) struct Avx512<V>(V);

/// Two rows side by side.
///
/// # Safety
/// As for the methods of [`Lanes`].
#[inline(always)]
unsafe fn pair(low: *const [f64; 4], high: *const [f64; 4]) -> __m512d {
    unsafe {
        let low = _mm512_castpd256_pd512(_mm256_loadu_pd(low.cast()));
        _mm512_insertf64x4::<1>(low, _mm256_loadu_pd(high.cast()))
    }
}

/// Writes two rows that are stored side by side.
///
/// # Safety
/// As for the methods of [`Lanes`].
#[inline(always)]
unsafe fn store_pair(rows: __m512d, low: *mut [f64; 4], high: *mut [f64; 4]) {
    unsafe {
        _mm256_storeu_pd(low.cast(), _mm512_castpd512_pd256(rows));
        _mm256_storeu_pd(high.cast(), _mm512_extractf64x4_pd::<1>(rows));
    }
}

/// Every fourth of sixteen rows, side by side.
///
/// # Safety
/// As for the methods of [`Lanes`].
#[inline(always)]
unsafe fn quarter(rows: &[*const [f32; 4]; MOST], first: usize) -> __m512 {
    unsafe {
        let all = _mm512_castps128_ps512(_mm_loadu_ps(rows[first].cast()));
        let all = _mm512_insertf32x4::<1>(all, _mm_loadu_ps(rows[first + 4].cast()));
        let all = _mm512_insertf32x4::<2>(all, _mm_loadu_ps(rows[first + 8].cast()));
        _mm512_insertf32x4::<3>(all, _mm_loadu_ps(rows[first + 12].cast()))
    }
}

/// Every fourth of sixteen rows, side by side, given by the positions of their first numbers.
///
/// # Safety
/// As for the methods of [`Lanes`].
#[inline(always)]
unsafe fn quarter_at(from: *const f32, places: *const u32, first: usize) -> __m512 {
    unsafe {
        let row = |lane: usize| _mm_loadu_ps(from.add(*places.add(lane) as usize));
        let all = _mm512_castps128_ps512(row(first));
        let all = _mm512_insertf32x4::<1>(all, row(first + 4));
        let all = _mm512_insertf32x4::<2>(all, row(first + 8));
        _mm512_insertf32x4::<3>(all, row(first + 12))
    }
}

/// The first three columns of sixteen rows, from every fourth of them side by side.
///
/// # Safety
/// As for the methods of [`Lanes`].
#[inline(always)]
unsafe fn columns_of([a, b, c, d]: [__m512; 4]) -> [Avx512<__m512>; 3] {
    unsafe {
        let (xy_ab, xy_cd) = (_mm512_unpacklo_ps(a, b), _mm512_unpacklo_ps(c, d));
        let (z_ab, z_cd) = (_mm512_unpackhi_ps(a, b), _mm512_unpackhi_ps(c, d));
        [
            Avx512(_mm512_shuffle_ps::<0x44>(xy_ab, xy_cd)),
            Avx512(_mm512_shuffle_ps::<0xee>(xy_ab, xy_cd)),
            Avx512(_mm512_shuffle_ps::<0x44>(z_ab, z_cd)),
        ]
    }
}

/// Writes rows that are stored side by side, each `stride` rows after the one before.
///
/// # Safety
/// As for the methods of [`Lanes`].
#[inline(always)]
unsafe fn store_quarter(rows: __m512, to: *mut [f32; 4], stride: usize) {
    unsafe {
        _mm_storeu_ps(to.cast(), _mm512_castps512_ps128(rows));
        _mm_storeu_ps(to.add(stride).cast(), _mm512_extractf32x4_ps::<1>(rows));
        _mm_storeu_ps(to.add(2 * stride).cast(), _mm512_extractf32x4_ps::<2>(rows));
        _mm_storeu_ps(to.add(3 * stride).cast(), _mm512_extractf32x4_ps::<3>(rows));
    }
}

impl Lanes<f64> for Avx512<__m512d> {
    #[inline(always)]
    unsafe fn splat(value: f64) -> Self {
        unsafe { Self(_mm512_set1_pd(value)) }
    }

    #[inline(always)]
    unsafe fn load(from: *const f64) -> Self {
        unsafe { Self(_mm512_loadu_pd(from)) }
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut f64) {
        unsafe { _mm512_storeu_pd(to, self.0) }
    }

    #[inline(always)]
    unsafe fn gather(from: *const f64, index: *const u32) -> Self {
        unsafe {
            let index = _mm256_loadu_si256(index.cast());
            Self(_mm512_i32gather_pd::<8>(index, from))
        }
    }

    #[inline(always)]
    unsafe fn from_rows(rows: [*const [f64; 4]; MOST]) -> [Self; 3] {
        unsafe {
            let (a, b) = (pair(rows[0], rows[4]), pair(rows[1], rows[5]));
            let (c, d) = (pair(rows[2], rows[6]), pair(rows[3], rows[7]));
            let (xz_ab, xz_cd) = (_mm512_unpacklo_pd(a, b), _mm512_unpacklo_pd(c, d));
            let (yw_ab, yw_cd) = (_mm512_unpackhi_pd(a, b), _mm512_unpackhi_pd(c, d));
            let first = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
            let second = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
            [
                Self(_mm512_permutex2var_pd(xz_ab, first, xz_cd)),
                Self(_mm512_permutex2var_pd(yw_ab, first, yw_cd)),
                Self(_mm512_permutex2var_pd(xz_ab, second, xz_cd)),
            ]
        }
    }

    #[inline(always)]
    unsafe fn to_rows([x, y, z]: [Self; 3], to: *mut [f64; 4], stride: usize) {
        unsafe {
            if stride == 1 {
                // x and y of each row, then z and 0 behind them.
                let low = _mm512_setr_epi64(0, 8, 1, 9, 2, 10, 3, 11);
                let high = _mm512_setr_epi64(4, 12, 5, 13, 6, 14, 7, 15);
                let xy_low = _mm512_permutex2var_pd(x.0, low, y.0);
                let xy_high = _mm512_permutex2var_pd(x.0, high, y.0);
                let rows = |xy, [a, b, c, d]: [i64; 4], place: usize| {
                    let index =
                        _mm512_setr_epi64(a, b, 8 + place as i64, 0, c, d, 9 + place as i64, 0);
                    let rows = _mm512_maskz_permutex2var_pd(0x77, xy, index, z.0);
                    _mm512_storeu_pd(to.add(place).cast(), rows);
                };
                rows(xy_low, [0, 1, 2, 3], 0);
                rows(xy_low, [4, 5, 6, 7], 2);
                rows(xy_high, [0, 1, 2, 3], 4);
                rows(xy_high, [4, 5, 6, 7], 6);
                return;
            }
            let zero = _mm512_setzero_pd();
            let (xy_even, xy_odd) = (_mm512_unpacklo_pd(x.0, y.0), _mm512_unpackhi_pd(x.0, y.0));
            let (z_even, z_odd) = (_mm512_unpacklo_pd(z.0, zero), _mm512_unpackhi_pd(z.0, zero));
            let first = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11);
            let second = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
            let (even, odd) = (
                _mm512_permutex2var_pd(xy_even, first, z_even),
                _mm512_permutex2var_pd(xy_odd, first, z_odd),
            );
            store_pair(even, to, to.add(2 * stride));
            store_pair(odd, to.add(stride), to.add(3 * stride));
            let (even, odd) = (
                _mm512_permutex2var_pd(xy_even, second, z_even),
                _mm512_permutex2var_pd(xy_odd, second, z_odd),
            );
            store_pair(even, to.add(4 * stride), to.add(6 * stride));
            store_pair(odd, to.add(5 * stride), to.add(7 * stride));
        }
    }

    #[inline(always)]
    unsafe fn prefetch(from: *const f64) {
        unsafe { _mm_prefetch::<_MM_HINT_T0>(from.cast()) }
    }

    #[inline(always)]
    unsafe fn add(self, other: Self) -> Self {
        unsafe { Self(_mm512_add_pd(self.0, other.0)) }
    }

    #[inline(always)]
    unsafe fn sub(self, other: Self) -> Self {
        unsafe { Self(_mm512_sub_pd(self.0, other.0)) }
    }

    #[inline(always)]
    unsafe fn mul(self, other: Self) -> Self {
        unsafe { Self(_mm512_mul_pd(self.0, other.0)) }
    }

    #[inline(always)]
    unsafe fn div(self, other: Self) -> Self {
        unsafe { Self(_mm512_div_pd(self.0, other.0)) }
    }

    #[inline(always)]
    unsafe fn sqrt(self) -> Self {
        unsafe { Self(_mm512_sqrt_pd(self.0)) }
    }

    #[inline(always)]
    unsafe fn two_to_it(self) -> Self {
        unsafe {
            let of = |x| {
                let biased = _mm512_add_pd(x, _mm512_set1_pd(bits::BIASED_DOUBLE));
                let shifted = _mm512_slli_epi64::<{ bits::OF_DOUBLE }>(_mm512_castpd_si512(biased));
                _mm512_castsi512_pd(shifted)
            };
            Self(of(self.0))
        }
    }

    #[inline(always)]
    unsafe fn parts(self) -> [Self; 2] {
        unsafe {
            let of = |x| {
                let own = _mm512_castpd_si512(x);
                let root = _mm512_set1_epi64(bits::ROOT_OF_DOUBLE as i64);
                let exponent =
                    _mm512_srli_epi64::<{ bits::OF_DOUBLE }>(_mm512_sub_epi64(own, root));
                let shifted = _mm512_slli_epi64::<{ bits::OF_DOUBLE }>(exponent);
                let mantissa = _mm512_sub_epi64(
                    _mm512_add_epi64(own, _mm512_set1_epi64(1_i64 << 62)),
                    shifted,
                );
                let ones = _mm512_castpd_si512(_mm512_set1_pd(bits::WHOLE_DOUBLE));
                let whole = _mm512_castsi512_pd(_mm512_or_si512(exponent, ones));
                let offset = _mm512_set1_pd(bits::WHOLE_DOUBLE + 1024.0);
                (_mm512_castsi512_pd(mantissa), _mm512_sub_pd(whole, offset))
            };
            let (a, b) = of(self.0);
            [Self(a), Self(b)]
        }
    }

    #[inline(always)]
    unsafe fn at_most(self, other: Self) -> u32 {
        unsafe { _mm512_cmp_pd_mask::<_CMP_LE_OQ>(self.0, other.0).into() }
    }

    #[inline(always)]
    unsafe fn select_le(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        unsafe {
            let chosen = _mm512_cmp_pd_mask::<_CMP_LE_OQ>(a.0, b.0);
            Self(_mm512_mask_blend_pd(chosen, otherwise.0, then.0))
        }
    }

    #[inline(always)]
    unsafe fn mul_add(self, factor: Self, other: Self) -> Self {
        unsafe { Self(_mm512_fmadd_pd(self.0, factor.0, other.0)) }
    }

    #[inline(always)]
    unsafe fn clamp(self, limit: Self) -> Self {
        unsafe {
            // The second operand is kept where one is not a number.
            let least = _mm512_sub_pd(_mm512_setzero_pd(), limit.0);
            Self(_mm512_max_pd(least, _mm512_min_pd(limit.0, self.0)))
        }
    }

    #[inline(always)]
    unsafe fn flush(self, tiny: Self) -> Self {
        unsafe {
            let kept = _mm512_cmp_pd_mask::<_CMP_NLT_UQ>(_mm512_abs_pd(self.0), tiny.0);
            Self(_mm512_maskz_mov_pd(kept, self.0))
        }
    }

    #[inline(always)]
    unsafe fn reaches(self, limit: Self) -> u32 {
        unsafe { _mm512_cmp_pd_mask::<_CMP_GE_OQ>(_mm512_abs_pd(self.0), limit.0).into() }
    }

    #[inline(always)]
    unsafe fn exceeds(self, limit: Self) -> u32 {
        unsafe { _mm512_cmp_pd_mask::<_CMP_NLE_UQ>(_mm512_abs_pd(self.0), limit.0).into() }
    }
}

impl Lanes<f32> for Avx512<__m512> {
    #[inline(always)]
    unsafe fn splat(value: f32) -> Self {
        unsafe { Self(_mm512_set1_ps(value)) }
    }

    #[inline(always)]
    unsafe fn load(from: *const f32) -> Self {
        unsafe { Self(_mm512_loadu_ps(from)) }
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut f32) {
        unsafe { _mm512_storeu_ps(to, self.0) }
    }

    #[inline(always)]
    unsafe fn gather(from: *const f32, index: *const u32) -> Self {
        unsafe {
            let index = _mm512_loadu_si512(index.cast());
            Self(_mm512_i32gather_ps::<4>(index, from))
        }
    }

    #[inline(always)]
    unsafe fn from_rows(rows: [*const [f32; 4]; MOST]) -> [Self; 3] {
        unsafe {
            columns_of([
                quarter(&rows, 0),
                quarter(&rows, 1),
                quarter(&rows, 2),
                quarter(&rows, 3),
            ])
        }
    }

    #[inline(always)]
    unsafe fn gather_rows(from: *const f32, places: *const u32) -> [Self; 3] {
        unsafe {
            columns_of([
                quarter_at(from, places, 0),
                quarter_at(from, places, 1),
                quarter_at(from, places, 2),
                quarter_at(from, places, 3),
            ])
        }
    }

    #[inline(always)]
    unsafe fn to_rows([x, y, z]: [Self; 3], to: *mut [f32; 4], stride: usize) {
        unsafe {
            if stride == 1 {
                // x and y of each row, then z and 0 behind them.
                let low = _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
                let high =
                    _mm512_setr_epi32(8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31);
                let xy_low = _mm512_permutex2var_ps(x.0, low, y.0);
                let xy_high = _mm512_permutex2var_ps(x.0, high, y.0);
                let rows = |xy, first: i32, place: usize| {
                    let (a, z_first) = (first, 16 + place as i32);
                    let index = _mm512_setr_epi32(
                        a,
                        a + 1,
                        z_first,
                        0,
                        a + 2,
                        a + 3,
                        z_first + 1,
                        0,
                        a + 4,
                        a + 5,
                        z_first + 2,
                        0,
                        a + 6,
                        a + 7,
                        z_first + 3,
                        0,
                    );
                    let rows = _mm512_maskz_permutex2var_ps(0x7777, xy, index, z.0);
                    _mm512_storeu_ps(to.add(place).cast(), rows);
                };
                rows(xy_low, 0, 0);
                rows(xy_low, 8, 4);
                rows(xy_high, 0, 8);
                rows(xy_high, 8, 12);
                return;
            }
            let zero = _mm512_setzero_ps();
            let (xy, z_low) = (_mm512_unpacklo_ps(x.0, y.0), _mm512_unpacklo_ps(z.0, zero));
            store_quarter(_mm512_shuffle_ps::<0x44>(xy, z_low), to, 4 * stride);
            let second = _mm512_shuffle_ps::<0xee>(xy, z_low);
            store_quarter(second, to.add(stride), 4 * stride);
            let (xy, z_high) = (_mm512_unpackhi_ps(x.0, y.0), _mm512_unpackhi_ps(z.0, zero));
            let third = _mm512_shuffle_ps::<0x44>(xy, z_high);
            store_quarter(third, to.add(2 * stride), 4 * stride);
            let fourth = _mm512_shuffle_ps::<0xee>(xy, z_high);
            store_quarter(fourth, to.add(3 * stride), 4 * stride);
        }
    }

    #[inline(always)]
    unsafe fn prefetch(from: *const f32) {
        unsafe { _mm_prefetch::<_MM_HINT_T0>(from.cast()) }
    }

    #[inline(always)]
    unsafe fn add(self, other: Self) -> Self {
        unsafe { Self(_mm512_add_ps(self.0, other.0)) }
    }

    #[inline(always)]
    unsafe fn sub(self, other: Self) -> Self {
        unsafe { Self(_mm512_sub_ps(self.0, other.0)) }
    }

    #[inline(always)]
    unsafe fn mul(self, other: Self) -> Self {
        unsafe { Self(_mm512_mul_ps(self.0, other.0)) }
    }

    #[inline(always)]
    unsafe fn div(self, other: Self) -> Self {
        unsafe { Self(_mm512_div_ps(self.0, other.0)) }
    }

    #[inline(always)]
    unsafe fn sqrt(self) -> Self {
        unsafe { Self(_mm512_sqrt_ps(self.0)) }
    }

    #[inline(always)]
    unsafe fn two_to_it(self) -> Self {
        unsafe {
            let of = |x| {
                let biased = _mm512_add_ps(x, _mm512_set1_ps(bits::BIASED_SINGLE));
                let shifted = _mm512_slli_epi32::<{ bits::OF_SINGLE }>(_mm512_castps_si512(biased));
                _mm512_castsi512_ps(shifted)
            };
            Self(of(self.0))
        }
    }

    #[inline(always)]
    unsafe fn parts(self) -> [Self; 2] {
        unsafe {
            let of = |x| {
                let own = _mm512_castps_si512(x);
                let root = _mm512_set1_epi32(bits::ROOT_OF_SINGLE as i32);
                let exponent =
                    _mm512_srli_epi32::<{ bits::OF_SINGLE }>(_mm512_sub_epi32(own, root));
                let shifted = _mm512_slli_epi32::<{ bits::OF_SINGLE }>(exponent);
                let mantissa = _mm512_sub_epi32(
                    _mm512_add_epi32(own, _mm512_set1_epi32(1_i32 << 30)),
                    shifted,
                );
                let ones = _mm512_castps_si512(_mm512_set1_ps(bits::WHOLE_SINGLE));
                let whole = _mm512_castsi512_ps(_mm512_or_si512(exponent, ones));
                let offset = _mm512_set1_ps(bits::WHOLE_SINGLE + 128.0);
                (_mm512_castsi512_ps(mantissa), _mm512_sub_ps(whole, offset))
            };
            let (a, b) = of(self.0);
            [Self(a), Self(b)]
        }
    }

    #[inline(always)]
    unsafe fn at_most(self, other: Self) -> u32 {
        unsafe { _mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, other.0).into() }
    }

    #[inline(always)]
    unsafe fn select_le(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        unsafe {
            let chosen = _mm512_cmp_ps_mask::<_CMP_LE_OQ>(a.0, b.0);
            Self(_mm512_mask_blend_ps(chosen, otherwise.0, then.0))
        }
    }

    #[inline(always)]
    unsafe fn mul_add(self, factor: Self, other: Self) -> Self {
        unsafe { Self(_mm512_fmadd_ps(self.0, factor.0, other.0)) }
    }

    #[inline(always)]
    unsafe fn clamp(self, limit: Self) -> Self {
        unsafe {
            // The second operand is kept where one is not a number.
            let least = _mm512_sub_ps(_mm512_setzero_ps(), limit.0);
            Self(_mm512_max_ps(least, _mm512_min_ps(limit.0, self.0)))
        }
    }

    #[inline(always)]
    unsafe fn flush(self, tiny: Self) -> Self {
        unsafe {
            let kept = _mm512_cmp_ps_mask::<_CMP_NLT_UQ>(_mm512_abs_ps(self.0), tiny.0);
            Self(_mm512_maskz_mov_ps(kept, self.0))
        }
    }

    #[inline(always)]
    unsafe fn reaches(self, limit: Self) -> u32 {
        unsafe { _mm512_cmp_ps_mask::<_CMP_GE_OQ>(_mm512_abs_ps(self.0), limit.0).into() }
    }

    #[inline(always)]
    unsafe fn exceeds(self, limit: Self) -> u32 {
        unsafe { _mm512_cmp_ps_mask::<_CMP_NLE_UQ>(_mm512_abs_ps(self.0), limit.0).into() }
    }
}
