//! Principal stretches and their axes.

use sinew_sparse::simd::Number;

use super::deformation::Deformation;
use super::powers::{NEAR, artanh_share, ln_1p};
use super::tensor::{Tensor, add, dot, scale};

/// Principal stretches of a deformation, as quantities that are small near rest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretches<N> {
    /// Axes in the material: orthogonal unit vectors, in no order and of either hand.
    pub(super) axes: [[N; 3]; 3],
    /// F on each axis: vectors of the length of the stretch.
    pub(super) images: [[N; 3]; 3],
    /// `g = l^2 - 1` of each stretch l.
    pub(super) strains: [N; 3],
    /// `1/l^2`.
    pub(super) over: [N; 3],
    /// `e = ln l` less the mean of all three: of the stretch without change of volume.
    pub(super) logs: [N; 3],
}

/// Largest number of sweeps of rotations; at most five were observed.
const SWEEPS: usize = 12;

impl<N: Number> Stretches<N> {
    /// The stretches of a deformation: Jacobi rotations diagonalise Green's strain, and each strain follows from the
    /// displacement along its axis, so that neither a small one nor a small stretch loses digits.
    #[inline(always)]
    pub(super) fn of(deformation: &Deformation<N>) -> Self {
        let axes = axes_of(deformation.twice_green_strain());
        let h = deformation.displacement_gradient;
        let moved = [h.on(axes[0]), h.on(axes[1]), h.on(axes[2])];
        let strains = [
            strain_of(axes[0], moved[0]),
            strain_of(axes[1], moved[1]),
            strain_of(axes[2], moved[2]),
        ];
        let logs = [ln_1p(strains[0]), ln_1p(strains[1]), ln_1p(strains[2])];
        let (half, mean) = (N::of(0.5), (logs[0] + logs[1] + logs[2]) * N::of(1.0 / 6.0));
        let one = N::of(1.0);
        Self {
            axes,
            images: [
                add(axes[0], moved[0]),
                add(axes[1], moved[1]),
                add(axes[2], moved[2]),
            ],
            strains,
            over: [
                (strains[0] + one).recip(),
                (strains[1] + one).recip(),
                (strains[2] + one).recip(),
            ],
            logs: [
                half.mul_add(logs[0], -mean),
                half.mul_add(logs[1], -mean),
                half.mul_add(logs[2], -mean),
            ],
        }
    }

    /// `(e_a - e_b)/(g_a - g_b)` for a pair, with its limit if both are equal.
    #[inline(always)]
    pub(super) fn slope_of_logs(&self, a: usize, b: usize) -> N {
        let (g, e) = (self.strains, self.logs);
        let difference = g[a] - g[b];
        let over = (g[a] + g[b] + N::of(2.0)).recip();
        let share = difference * over;
        let near = artanh_share(share * share) * over;
        let apart = (e[a] - e[b]) / difference;
        N::select_le(share.abs(), N::of(NEAR), near, apart)
    }
}

/// `l^2 - 1` along a unit vector that a displacement changes by `moved`.
#[inline(always)]
fn strain_of<N: Number>(axis: [N; 3], moved: [N; 3]) -> N {
    N::of(2.0).mul_add(dot(axis, moved), dot(moved, moved))
}

/// The axes of a symmetric tensor, by rotations in Jacobi's order until all lanes are done; a lane that is done is no
/// longer rotated.
#[inline(always)]
fn axes_of<N: Number>(tensor: Tensor<N>) -> [[N; 3]; 3] {
    // Entries of 1 at most, so that squares of squares are numbers too.
    let largest = tensor.largest().max(N::of(smallest::<N>()));
    let tensor = tensor.scaled(largest.recip());
    let [[xx, xy, xz], [_, yy, yz], [.., zz]] = tensor.0;
    let mut turning = Turning {
        diagonal: [xx, yy, zz],
        beside: [xy, xz, yz],
        axes: Tensor::identity().0,
    };
    let negligible = N::of(2.0 * N::EPSILON);
    for _ in 0..SWEEPS {
        turning.turn::<0, 0, 1>();
        turning.turn::<1, 0, 2>();
        turning.turn::<2, 1, 2>();
        let [xy, xz, yz] = turning.beside;
        if N::all_le(xy.abs().max(xz.abs()).max(yz.abs()), negligible) {
            break;
        }
    }
    turning.axes
}

/// A symmetric tensor during diagonalisation.
struct Turning<N> {
    diagonal: [N; 3],
    /// Entries of the axes (0, 1), (0, 2) and (1, 2).
    beside: [N; 3],
    axes: [[N; 3]; 3],
}

impl<N: Number> Turning<N> {
    /// Rotates axes P and Q, whose entry is that of `OWN`, so that this entry nearly vanishes. The tangent of half the
    /// angle is `e/(f d)` of the entry e and the difference d, with a fit of `f(e/d)` in place of roots: the first
    /// terms of its series up to 1/2, lines beyond. The remaining entry is of the fifth power of a small angle, and up
    /// to a hundredth for a large one.
    #[inline(always)]
    fn turn<const OWN: usize, const P: usize, const Q: usize>(&mut self) {
        let (zero, one) = (N::of(0.0), N::of(1.0));
        let (p, q, entry) = (self.diagonal[P], self.diagonal[Q], self.beside[OWN]);
        let difference = q - p;
        let (apart, size) = (difference.abs(), entry.abs());
        let first = size.mul_add(N::of(2.1), N::of(1.45) * apart);
        let last = size.mul_add(N::of(2.4), apart);
        let series = (apart + apart).mul_add(apart, N::of(2.5) * size * size);
        let is_small = size + size;
        let long = N::select_le(is_small, apart, series, first.max(last));
        let across = N::select_le(is_small, apart, entry * apart, entry);
        let across = N::select_le(zero, difference, across, -across);
        let squared = across * across;
        let square = long.mul_add(long, squared);
        let over = square.recip();
        let smallest = N::of(smallest::<N>());
        let cosine = long.mul_add(long, -squared) * over;
        let cosine = N::select_le(square, smallest, one, cosine);
        let sine = (long + long) * across * over;
        let sine = N::select_le(square, smallest, zero, sine);
        let (of_cosine, of_sine) = (cosine * cosine, sine * sine);
        let product = sine * cosine;
        let moved = of_sine.mul_add(difference, -((product + product) * entry));
        self.diagonal[P] = p + moved;
        self.diagonal[Q] = q - moved;
        self.beside[OWN] = (of_cosine - of_sine).mul_add(entry, -(product * difference));
        // The entries of P and of Q with the third axis.
        let (of_p, of_q) = (
            if OWN == 2 { 0 } else { 1 - OWN },
            if OWN == 2 { 1 } else { 2 },
        );
        let (x, y) = (self.beside[of_p], self.beside[of_q]);
        self.beside[of_p] = cosine.mul_add(x, -(sine * y));
        self.beside[of_q] = sine.mul_add(x, cosine * y);
        let (x, y) = (self.axes[P], self.axes[Q]);
        self.axes[P] = add(scale(x, cosine), scale(y, -sine));
        self.axes[Q] = add(scale(x, sine), scale(y, cosine));
    }
}

/// A number that counts as 0 for entries of tensors; its fourth power can still be computed.
#[inline(always)]
fn smallest<N: Number>() -> f64 {
    if N::EPSILON < 1e-10 { 1e-290 } else { 1e-36 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hyperelastic::samples::Random;

    fn stretched(h: [[f64; 3]; 3]) -> Stretches<f64> {
        Stretches::of(&Deformation::of(Tensor(h)))
    }

    fn are_axes(found: &Stretches<f64>, h: [[f64; 3]; 3]) {
        let f = Tensor(h) + Tensor::identity();
        let axes = Tensor::from_columns(found.axes);
        let product = axes.transposed_times(axes) - Tensor::identity();
        assert!(product.largest() < 1e-14, "{h:?}: {found:?}");
        let turned = axes.transposed_times(f.transposed_times(f)) * axes;
        for [a, b] in [[0, 1], [0, 2], [1, 2]] {
            let size = turned.largest();
            assert!(turned.0[a][b].abs() < 1e-14 * size, "{h:?}: {turned:?}");
        }
        for (axis, strain) in found.strains.into_iter().enumerate() {
            let error = (turned.0[axis][axis] - 1.0 - strain).abs();
            assert!(error < 1e-14 * turned.largest(), "{h:?}: {found:?}");
        }
    }

    #[test]
    fn axes_are_found_also_where_stretches_are_alike() {
        let mut random = Random::new(7);
        for _ in 0..500 {
            let h = random.tensor().0;
            are_axes(&stretched(h), h);
        }
        for h in [
            [[0.0; 3]; 3],
            [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.5]],
            [[0.5, 0.0, 0.0], [0.0, -0.5, 0.0], [0.0, 0.0, 0.5]],
            [[0.0, 1.0, 0.0], [0.0; 3], [0.0; 3]],
            [[1e-9, 2e-9, 0.0], [2e-9, 1e-9, 0.0], [0.0, 0.0, 3e-9]],
            [[0.2, 1e-12, 0.0], [1e-12, 0.2, 1e-13], [0.0, 1e-13, 0.2]],
        ] {
            are_axes(&stretched(h), h);
        }
    }

    #[test]
    fn small_strains_keep_their_digits_in_single_precision() {
        let h = [[1e-6, 3e-6, -2e-6], [2e-6, -5e-6, 1e-6], [4e-6, 0.0, 2e-6]];
        let rows = h.map(|row| row.map(|entry: f64| f64::from(entry as f32)));
        let sorted = |mut values: [f64; 3]| {
            values.sort_by(f64::total_cmp);
            values
        };
        let single = Stretches::of(&Deformation::of(Tensor::<f32>::of(rows)));
        let found = sorted(single.logs.map(f64::from));
        let expected = sorted(stretched(rows).logs);
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 1e-6, "{found}, {expected}");
        }
    }
}
