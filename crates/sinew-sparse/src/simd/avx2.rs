//! Pairs of 256-bit vectors.

#![allow(unsafe_code, reason = "the contract stands at `Lanes`")]
#![allow(
    clippy::undocumented_unsafe_blocks,
    reason = "each block is one or two instructions, under the contract of `Lanes`"
)]

use std::arch::x86_64::*;

use super::lanes::Lanes;

/// Two 256-bit vectors.
#[derive(Clone, Copy)]
pub(crate) struct Avx2<V>(V, V);

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
