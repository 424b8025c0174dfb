//! Invariants without change of volume.

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::tensor::Tensor;

/// Values cached per deformation gradient by laws in the invariants without change of volume.
#[derive(Clone, Copy, Debug)]
pub struct Isochoric<N> {
    /// 1/J.
    pub(super) over: N,
    /// `J^-2/3`.
    pub(super) scale: N,
    /// `F'F - I`.
    pub(super) strain: Tensor<N>,
    /// `I1 - 3`.
    pub(super) first: N,
    /// `I2 - 3`.
    pub(super) second: N,
}

impl<N: Number> Isochoric<N> {
    #[inline(always)]
    pub(super) fn at(deformation: &Deformation<N>) -> Self {
        let strain = deformation.twice_green_strain();
        let first = deformation.first_invariant_change();
        let quadratic = first.mul_add(first, -strain.squared());
        let cubic_root = deformation.volume_ratio.cbrt();
        Self {
            over: deformation.volume_ratio.recip(),
            scale: (cubic_root * cubic_root).recip(),
            strain,
            first,
            second: N::of(2.0).mul_add(first, N::of(0.5) * quadratic),
        }
    }

    /// I1.
    #[inline(always)]
    pub(super) fn i1(&self) -> N {
        self.first + N::of(3.0)
    }

    /// I2.
    #[inline(always)]
    pub(super) fn i2(&self) -> N {
        self.second + N::of(3.0)
    }

    /// `I / J - 3` for an invariant I.
    #[inline(always)]
    pub(super) fn beyond_rest(&self, invariant_change: N, volume_change: N) -> N {
        N::of(-3.0).mul_add(volume_change, invariant_change) * self.over
    }

    /// `B = I1 F - F C`, half of dI2/dF.
    #[inline(always)]
    pub(super) fn second_gradient(&self, gradient: Tensor<N>) -> Tensor<N> {
        gradient.scaled(self.first + N::of(2.0)) - gradient * self.strain
    }
}
