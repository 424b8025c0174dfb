//! The volumetric energy `bulk/2 (J - 1)^2`, added to an isochoric one.

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::tensor::Tensor;

/// An energy density with that of volume.
#[inline(always)]
pub(super) fn energy<N: Number>(deformation: &Deformation<N>, bulk: N, local: N) -> N {
    let change = deformation.volume_change;
    (N::of(0.5) * bulk * change).mul_add(change, local)
}

/// A stress with that of volume.
#[inline(always)]
pub(super) fn stress<N: Number>(
    deformation: &Deformation<N>,
    bulk: N,
    local: Tensor<N>,
) -> Tensor<N> {
    local.plus(bulk * deformation.volume_change, deformation.cofactor)
}

/// The change of a stress with that of volume by a change of F.
#[inline(always)]
pub(super) fn tangent<N: Number>(
    deformation: &Deformation<N>,
    bulk: N,
    local: Tensor<N>,
    change: Tensor<N>,
) -> Tensor<N> {
    let cofactor = deformation.cofactor;
    local
        .plus(bulk * cofactor.contracted(change), cofactor)
        .plus(
            bulk * deformation.volume_change,
            deformation.cofactor_change(change),
        )
}
