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

/// Largest number of sweeps of Jacobi rotations; at most six were observed.
const SWEEPS: usize = 16;

impl<N: Number> SingularValues<N> {
    /// The singular values of any tensor, by one-sided Jacobi rotations (Hestenes 1958), which keep the relative
    /// precision of small ones. If two of them add up to 0, the rotations are not unique.
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

/// Rotates columns P and Q so that they are orthogonal; returns true if they already were, in all lanes.
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

/// Exchanges columns P and Q if the second is the longer one, with a sign that keeps V proper.
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

/// The direction of a vector, or `otherwise` if its square is not above `negligible`.
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
/// Volume ratio below which singular values are used immediately.
const FLAT: f64 = 0.05;

/// The proper rotation R of F = R S, also where J < 0.
///
/// Newton's iteration Q <- (Q + Q^-T)/2 (Higham, SIAM J. Sci. Stat. Comput. 7, 1986) until Q no longer changes;
/// singular values if the element is nearly flat or inverted, and if 12 iterations do not suffice. It starts from F
/// itself, so that the result is a function of F.
#[inline(always)]
#[must_use]
pub(crate) fn rotation<N: Number>(gradient: Tensor<N>, volume_ratio: N) -> Tensor<N> {
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
    if N::all_le(moved, tolerance) && !N::any_le(volume_ratio, N::of(FLAT)) {
        return rotation;
    }
    // A lane that still moves is one to be mended.
    let volume_ratio = N::select_le(moved, tolerance, volume_ratio, N::of(0.0));
    mended(gradient, rotation, volume_ratio)
}

/// Largest number of lanes of any [`Number`].
pub(super) const MOST_LANES: usize = 16;

/// The rotations of lanes with a volume ratio above [`FLAT`]; those of the other lanes follow from singular values,
/// lane by lane. This is rare, and too long to be inlined.
#[cold]
#[inline(never)]
fn mended<N: Number>(gradient: Tensor<N>, rotation: Tensor<N>, volume_ratio: N) -> Tensor<N> {
    const { assert!(N::LANES <= MOST_LANES) };
    let mut lanes = [[[0.0; 3]; 3]; MOST_LANES];
    for (lane, found) in lanes.iter_mut().enumerate().take(N::LANES) {
        let of = |tensor: Tensor<N>| Tensor(tensor.0.map(|row| row.map(|entry| entry.lane(lane))));
        *found = if volume_ratio.lane(lane) > FLAT {
            of(rotation).0
        } else {
            nearest(of(gradient)).0
        };
    }
    let indices = [0, 1, 2].map(|i| [0, 1, 2].map(|j| (i, j)));
    Tensor(indices.map(|row| row.map(|(i, j)| N::from_lanes(|lane| lanes[lane][i][j]))))
}

#[inline(never)]
fn nearest(gradient: Tensor<f64>) -> Tensor<f64> {
    SingularValues::of(gradient).rotation()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_rotation(tensor: Tensor<f64>) -> bool {
        let product = tensor.times_transposed(tensor) - Tensor::identity();
        let determinant = dot(tensor.0[0], tensor.cofactor().0[0]);
        product.largest() < 1e-14 && (determinant - 1.0).abs() < 1e-14
    }

    /// A tensor of these stretches with a rotation on both sides.
    fn turned(stretches: [f64; 3]) -> Tensor<f64> {
        let left = Tensor([[0.3, -0.8, 0.1], [0.5, 0.2, 0.9], [-0.7, 0.4, 0.6]]);
        let right = Tensor([[0.9, 0.2, -0.3], [-0.1, 0.4, 0.8], [0.5, -0.6, 0.3]]);
        let [left, right] = [left, right].map(|tensor| SingularValues::of(tensor).rotation());
        let mut middle = Tensor::zero();
        for (axis, stretch) in stretches.into_iter().enumerate() {
            middle.0[axis][axis] = stretch;
        }
        (left * middle).times_transposed(right)
    }

    #[test]
    fn singular_values_come_back_with_the_sign_of_the_determinant() {
        let cases = [
            [1.0, 1.0, 1.0],
            [3.0, 1.0, 1e-9],
            [3.0, 1.0, 0.0],
            [2.0, 0.0, 0.0],
            [0.0, 0.0, 0.0],
            [3.0, 2.0, -0.5],
            [1.0, 1.0, -1.0],
            [1.0, 1e-8, 1e-12],
        ];
        for stretches in cases {
            let tensor = turned(stretches);
            let found = SingularValues::of(tensor);
            let (left, right) = (
                Tensor::from_columns(found.left),
                Tensor::from_columns(found.right),
            );
            assert!(is_rotation(left) && is_rotation(right), "{stretches:?}");
            for (value, stretch) in found.values.into_iter().zip(stretches) {
                assert!((value - stretch).abs() < 1e-14, "{stretches:?}: {found:?}");
            }
            let mut middle = Tensor::zero();
            for (axis, value) in found.values.into_iter().enumerate() {
                middle.0[axis][axis] = value;
            }
            let again = (left * middle).times_transposed(right);
            assert!((again - tensor).largest() < 1e-14, "{stretches:?}");
        }
    }

    #[test]
    fn both_ways_to_the_rotation_agree_and_make_the_stretch_symmetric() {
        for stretches in [
            [1.0, 1.0, 1.0],
            [1.2, 1.0, 0.7],
            [3.0, 0.4, 0.1],
            [1e3, 1.0, 1e-4],
            [0.3, 0.3, 0.2],
            [1.5, 0.7, -0.3],
        ] {
            let tensor = turned(stretches);
            let ratio = stretches.into_iter().product();
            let found = rotation(tensor, ratio);
            assert!(is_rotation(found), "{stretches:?}");
            let stretch = found.transposed_times(tensor);
            let skew = (stretch - stretch.transposed()).largest();
            assert!(skew < 1e-14 * stretches[0], "{stretches:?}: {skew:e}");
            let other = SingularValues::of(tensor).rotation();
            // Rotations are as sure as the sum of the two smallest stretches.
            let sure = 1e-14 * stretches[0] / (stretches[1] + stretches[2]);
            assert!((found - other).largest() < sure, "{stretches:?}");
        }
    }
}
