//! Energies of the first invariant without change of volume.

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::isochoric::Isochoric;
use super::law::{Point, block_of};
use super::tensor::Tensor;

/// First and second derivative (Pa) of an energy by `i = J^-2/3 I1 - 3`.
pub(super) type Slopes<N> = [N; 2];

/// i, 0 at rest, where `J^-2/3` is exactly 1.
#[inline(always)]
pub(super) fn beyond<N: Number>(own: &Isochoric<N>) -> N {
    N::of(3.0).mul_add(own.scale - N::of(1.0), own.scale * own.first)
}

/// i as a sum of parts of its own size, for energies: `J^-2/3 - 1` is formed without a difference of large numbers.
#[inline(always)]
pub(super) fn exactly_beyond<N: Number>(at: &Point<N, Isochoric<N>>) -> N {
    let shrink = (N::of(-2.0 / 3.0) * at.volume_change.ln_1p()).exp_m1();
    at.own.scale.mul_add(at.own.first, N::of(3.0) * shrink)
}

/// `F - I1/(3J) c`, by parts that are 0 at rest: half the gradient of i over `J^-2/3`.
#[inline(always)]
pub(super) fn half_gradient<N: Number>(
    deformation: &Deformation<N>,
    own: &Isochoric<N>,
) -> Tensor<N> {
    let beyond = own.beyond_rest(own.first, deformation.volume_change);
    deformation
        .distortion
        .plus(beyond * N::of(-1.0 / 3.0), deformation.cofactor)
}

/// The change of `J^-2/3 (F - I1/(3J) c)` by a change of F, over `J^-2/3`.
#[inline(always)]
pub(super) fn changed_half_gradient<N: Number>(
    deformation: &Deformation<N>,
    own: &Isochoric<N>,
    change: Tensor<N>,
) -> Tensor<N> {
    let (f, c) = (deformation.gradient, deformation.cofactor);
    // dJ/J.
    let relative = c.contracted(change) * own.over;
    let turned = deformation.cofactor_change(change);
    let third = N::of(1.0 / 3.0);
    let along = f.contracted(change);
    let of_c = third * own.over * (N::of(5.0) * third * own.i1() * relative - (along + along));
    change
        .plus(N::of(-2.0) * third * relative, f)
        .plus(of_c, c)
        .plus(-(third * own.i1() * own.over), turned)
}

/// `2 psi' J^-2/3 (F - I1/(3J) c)`.
#[inline(always)]
pub(super) fn stress<N: Number>(
    deformation: &Deformation<N>,
    own: &Isochoric<N>,
    slope: N,
) -> Tensor<N> {
    half_gradient(deformation, own).scaled(N::of(2.0) * slope * own.scale)
}

/// The change of [`stress`] by a change of F.
#[inline(always)]
pub(super) fn tangent<N: Number>(
    deformation: &Deformation<N>,
    own: &Isochoric<N>,
    [slope, curvature]: Slopes<N>,
    change: Tensor<N>,
) -> Tensor<N> {
    let twice = N::of(2.0) * own.scale;
    let half = half_gradient(deformation, own);
    changed_half_gradient(deformation, own, change)
        .scaled(slope * twice)
        .plus(curvature * twice * twice * half.contracted(change), half)
}

/// A node's own block of [`tangent`] and of `of_volume/2 (J - 1)^2`, exact and, unless a slope is below 0, positive
/// semidefinite: it contains the gradient of i as an outer product, and i is rank-one convex.
#[inline(always)]
pub(super) fn node_block<N: Number>(
    deformation: &Deformation<N>,
    own: &Isochoric<N>,
    [slope, curvature]: Slopes<N>,
    of_volume: N,
    gradient: [N; 3],
) -> Tensor<N> {
    let twice = N::of(2.0) * own.scale;
    let a = slope * twice;
    let squared = own.over * own.over;
    let first = a * N::of(5.0 / 9.0) * own.i1() * squared;
    let along = deformation.gradient.on(gradient);
    let normal = deformation.cofactor.on(gradient);
    let mixed = Tensor::outer(along, normal).symmetric();
    let sloped = half_gradient(deformation, own).on(gradient);
    block_of(deformation, gradient, a, first + of_volume)
        .plus(N::of(-4.0 / 3.0) * a * own.over, mixed)
        .plus(curvature * twice * twice, Tensor::outer(sloped, sloped))
}
