//! 512-bit vectors.

#![allow(unsafe_code, reason = "the contract stands at `Lanes`")]
#![allow(
    clippy::undocumented_unsafe_blocks,
    reason = "each block is one instruction, under the contract of `Lanes`"
)]

use std::arch::x86_64::*;

use super::lanes::Lanes;

/// A 512-bit vector.
#[derive(Clone, Copy)]
pub(crate) struct Avx512<V>(V);

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
