//! Symmetric tensors without their negative eigenvalues.

use sinew_sparse::simd::Number;

use super::decomposition::SingularValues;
use super::tensor::Tensor;

/// Computes [`semidefinite`] plus its rounding error, which matters if negative eigenvalues are the larger ones: the
/// own block of a node for a tangent that may be indefinite.
#[inline(always)]
pub(super) fn surely_semidefinite<N: Number>(block: Tensor<N>) -> Tensor<N> {
    let rounding = block.largest() * N::of(8.0 * N::EPSILON);
    semidefinite(block.symmetric()) + Tensor::diagonal(rounding)
}

/// A symmetric tensor without its negative eigenvalues: half the sum of the tensor and its absolute value `V |s| V'`.
#[inline(always)]
pub(crate) fn semidefinite<N: Number>(tensor: Tensor<N>) -> Tensor<N> {
    let SingularValues { values, right, .. } = SingularValues::of(tensor);
    let half = N::of(0.5);
    let mut sum = tensor.scaled(half);
    for (value, axis) in values.into_iter().zip(right) {
        sum = sum.plus(half * value.abs(), Tensor::outer(axis, axis));
    }
    sum
}
