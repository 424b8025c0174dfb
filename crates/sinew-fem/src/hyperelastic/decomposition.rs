//! Singular values and polar factors.

use sinew_sparse::simd::Number;

use super::tensor::{Tensor, add, cross, dot, scale};

/// F = U diag(s) V' with proper rotations U and V, so that the last singular value has the sign of det F.
#[derive(Clone, Copy, Debug)]
pub struct SingularValues<N> {
    /// U, by columns.
    pub left: [[N; 3]; 3],
    /// s; by size, the largest first.
    pub values: [N; 3],
    /// V, by columns.
    pub right: [[N; 3]; 3],
}

/// Sweeps of Jacobi rotations at most; six are seen.
const SWEEPS: usize = 16;

impl<N: Number> SingularValues<N> {
    /// The singular values of any tensor, by one-sided Jacobi rotations (Hestenes 1958), which keep the relative
    /// precision of small ones. Where two add up to 0, the rotations are one choice among many.
    #[inline(always)]
    #[must_use]
    pub fn of(tensor: Tensor<N>) -> Self {
        let mut a = tensor.columns();
        let mut v = Tensor::<N>::identity().0;
        for _ in 0..SWEEPS {
            let first = orthogonalise::<N, 0, 1>(&mut a, &mut v);
            let second = orthogonalise::<N, 0, 2>(&mut a, &mut v);
            let third = orthogonalise::<N, 1, 2>(&mut a, &mut v);
            if first && second && third {
                break;
            }
        }
        order::<N, 0, 1>(&mut a, &mut v);
        order::<N, 1, 2>(&mut a, &mut v);
        order::<N, 0, 1>(&mut a, &mut v);
        // The directions of the two largest columns; the third follows, and so U is proper.
        let first = direction(a[0], v[0], N::of(0.0));
        let rest = add(a[1], scale(first, -dot(a[1], first)));
        let negligible = dot(a[0], a[0]) * N::of(N::EPSILON * N::EPSILON);
        let second = direction(rest, perpendicular(first), negligible);
        let third = cross(first, second);
        Self {
            left: [first, second, third],
            values: [dot(first, a[0]), dot(second, a[1]), dot(third, a[2])],
            right: v,
        }
    }

    /// The proper rotation nearest to the tensor, U V'.
    #[inline(always)]
    #[must_use]
    pub fn rotation(&self) -> Tensor<N> {
        Tensor::from_columns(self.left).times_transposed(Tensor::from_columns(self.right))
    }
}

/// Rotates columns P and Q so that they are orthogonal; whether they had been, in all lanes.
#[inline(always)]
fn orthogonalise<N: Number, const P: usize, const Q: usize>(
    a: &mut [[N; 3]; 3],
    v: &mut [[N; 3]; 3],
) -> bool {
    let (p, q) = (dot(a[P], a[P]), dot(a[Q], a[Q]));
    let product = dot(a[P], a[Q]);
    let squared = product * product;
    let negligible = p * q * N::of(N::EPSILON * N::EPSILON);
    let difference = q - p;
    let root = (difference * difference + N::of(4.0) * squared).sqrt();
    let zero = N::of(0.0);
    let twice = N::select_le(difference, zero, N::of(-2.0), N::of(2.0)) * product;
    let tangent = twice / (difference.abs() + root);
    let tangent = N::select_le(squared, negligible, zero, tangent);
    let cosine = tangent.mul_add(tangent, N::of(1.0)).sqrt().recip();
    let sine = tangent * cosine;
    for columns in [&mut *a, &mut *v] {
        let (x, y) = (columns[P], columns[Q]);
        columns[P] = add(scale(x, cosine), scale(y, -sine));
        columns[Q] = add(scale(x, sine), scale(y, cosine));
    }
    N::all_le(squared, negligible)
}

/// Exchanges columns P and Q where the second is the longer one, with a sign that keeps V proper.
#[inline(always)]
fn order<N: Number, const P: usize, const Q: usize>(a: &mut [[N; 3]; 3], v: &mut [[N; 3]; 3]) {
    let (p, q) = (dot(a[P], a[P]), dot(a[Q], a[Q]));
    for columns in [&mut *a, &mut *v] {
        let (x, y) = (columns[P], columns[Q]);
        columns[P] = choose(q, p, x, y);
        columns[Q] = choose(q, p, y, scale(x, N::of(-1.0)));
    }
}

#[inline(always)]
fn choose<N: Number>(a: N, b: N, then: [N; 3], otherwise: [N; 3]) -> [N; 3] {
    let entry = |i: usize| N::select_le(a, b, then[i], otherwise[i]);
    [entry(0), entry(1), entry(2)]
}

/// The direction of a vector, or `otherwise` where its square is not above `negligible`.
#[inline(always)]
fn direction<N: Number>(vector: [N; 3], otherwise: [N; 3], negligible: N) -> [N; 3] {
    let squared = dot(vector, vector);
    let unit = scale(vector, squared.sqrt().recip());
    choose(squared, negligible, otherwise, unit)
}

/// A unit vector perpendicular to another.
#[inline(always)]
fn perpendicular<N: Number>(unit: [N; 3]) -> [N; 3] {
    let zero = N::of(0.0);
    let one = N::of(1.0);
    // Away from the axis that it is nearest to.
    let axis = choose(
        unit[0].abs(),
        N::of(0.6),
        [one, zero, zero],
        [zero, one, zero],
    );
    let found = cross(unit, axis);
    scale(found, dot(found, found).sqrt().recip())
}

/// Iterations of the polar decomposition before singular values are taken.
const ITERATIONS: usize = 12;
/// Volume ratio below which they are taken at once.
const FLAT: f64 = 0.05;

/// The proper rotation R of F = R S, also where J < 0.
///
/// Newton's iteration Q <- (Q + Q^-T)/2 (Higham, SIAM J. Sci. Stat. Comput. 7, 1986) until it moves no more; singular values
/// where the element is nearly flat or inverted, and where 12 iterations do not do. It starts from F itself, so that the result is a function of F.
#[inline(always)]
#[must_use]
pub(super) fn rotation<N: Number>(gradient: Tensor<N>, volume_ratio: N) -> Tensor<N> {
    // The error after a step is about the square of what moved, so that single precision is reached long before.
    let tolerance = N::of((32.0 * N::EPSILON).max(1e-12));
    let mut rotation = gradient;
    let mut moved = N::of(1e30);
    for _ in 0..ITERATIONS {
        let cofactor = rotation.cofactor();
        let half = N::of(0.5);
        let over = half / dot(rotation.0[0], cofactor.0[0]);
        let next = rotation.scaled(half).plus(over, cofactor);
        let step = (next - rotation).largest();
        // A lane that is done stays, whatever its neighbours do.
        rotation = Tensor::select_le(moved, tolerance, rotation, next);
        moved = N::select_le(moved, tolerance, moved, step);
        if N::all_le(moved, tolerance) {
            break;
        }
    }
    let flat = N::of(FLAT);
    if N::all_le(moved, tolerance) && !N::any_le(volume_ratio, flat) {
        return rotation;
    }
    let nearest = SingularValues::of(gradient).rotation();
    let found = Tensor::select_le(moved, tolerance, rotation, nearest);
    Tensor::select_le(volume_ratio, flat, nearest, found)
}
