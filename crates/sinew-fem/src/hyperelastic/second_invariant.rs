//! Stresses of the second invariant without change of volume, `J^-4/3 I2`, with a factor `a = 2 C2 J^-4/3` (Pa).

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::isochoric::Isochoric;
use super::tensor::Tensor;

/// A stress with `a (B - 2 I2/(3J) c)`, `B = I1 F - F C`, by parts that are 0 at rest.
#[inline(always)]
pub(super) fn stress_with<N: Number>(
    stress: Tensor<N>,
    deformation: &Deformation<N>,
    own: &Isochoric<N>,
    a: N,
) -> Tensor<N> {
    let f = deformation.gradient;
    let second = own.beyond_rest(own.second, deformation.volume_change) * N::of(-1.0 / 3.0);
    let rest = deformation.distortion.plus(second, deformation.cofactor);
    let strained = f.scaled(own.first) - f * own.strain;
    stress.plus(a + a, rest).plus(a, strained)
}

/// The change of `B - 2 I2/(3J) c` and of its factor over it, by a change of F.
#[inline(always)]
pub(super) fn tangent<N: Number>(
    deformation: &Deformation<N>,
    own: &Isochoric<N>,
    change: Tensor<N>,
) -> Tensor<N> {
    let (f, c) = (deformation.gradient, deformation.cofactor);
    let relative = c.contracted(change) * own.over;
    let turned = deformation.cofactor_change(change);
    let along = f.contracted(change);
    let b = own.second_gradient(f);
    let one_side = f.transposed_times(change);
    let strain = one_side + one_side.transposed();
    let db = change.scaled(own.first + N::of(2.0)).plus(along + along, f)
        - change * own.strain
        - f * strain;
    let along = b.contracted(change);
    let third = N::of(1.0 / 3.0);
    let two = N::of(2.0) * third;
    let of_c = two * own.over * (N::of(7.0) * third * own.i2() * relative - (along + along));
    db.plus(N::of(-4.0) * third * relative, b)
        .plus(of_c, c)
        .plus(-(two * own.i2() * own.over), turned)
}

/// The coefficient along c g of a node's own block: exact.
pub(super) const EXACT: f64 = 14.0 / 9.0;

/// The least coefficient along c g with which the block is a square.
///
/// The quadratic form of a vector w is `|D[w g']|^2 - 8/3 (B : w g') n + 14/9 I2 n^2`, n being `c : w g'/J`. Since `B :
/// w g' = c : D[w g']` and `c : c = I2`, it is a square, and so not below 0, with 16/9; with 14/9 it may be below 0
/// (Hartmann and Neff, International Journal of Solids and Structures 40, 2003).
pub(super) const SQUARE: f64 = 16.0 / 9.0;

/// A node's own block with `a` times that of [`tangent`], with a coefficient along c g.
#[inline(always)]
pub(super) fn block_with<N: Number>(
    block: Tensor<N>,
    deformation: &Deformation<N>,
    own: &Isochoric<N>,
    (a, coefficient): (N, f64),
    gradient: [N; 3],
) -> Tensor<N> {
    let squared = own.over * own.over;
    let normal = deformation.cofactor.on(gradient);
    // |D[w g']|^2 = w . (sum over k of D[e_k g']:D[e_l g']) w.
    let mut turned = [Tensor::zero(); 3];
    for (turned, axis) in turned.iter_mut().zip(Tensor::<N>::identity().0) {
        *turned = deformation.cofactor_change(Tensor::outer(axis, gradient));
    }
    let mut turning = Tensor::zero();
    for (k, row) in turning.0.iter_mut().enumerate() {
        for (l, entry) in row.iter_mut().enumerate() {
            *entry = turned[k].contracted(turned[l]);
        }
    }
    let sloped = own.second_gradient(deformation.gradient).on(gradient);
    let mixed = Tensor::outer(sloped, normal).symmetric();
    let second = N::of(coefficient) * own.i2() * squared;
    block
        .plus(a, turning)
        .plus(N::of(-8.0 / 3.0) * a * own.over, mixed)
        .plus(a * second, Tensor::outer(normal, normal))
}
