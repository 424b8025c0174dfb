//! 3x3 tensors over any number.

use std::ops::{Add, Mul, Sub};

use sinew_sparse::simd::Number;

/// A 3x3 tensor by rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tensor<N>(pub [[N; 3]; 3]);

// Written out nine times, since a closure is not always inlined where vectors need it.
macro_rules! entries {
    (|$i:ident, $j:ident| $entry:expr) => {
        Tensor([
            entries!(row 0, $i, $j, $entry),
            entries!(row 1, $i, $j, $entry),
            entries!(row 2, $i, $j, $entry),
        ])
    };
    (row $row:literal, $i:ident, $j:ident, $entry:expr) => {{
        let $i = $row;
        [
            { let $j = 0; $entry },
            { let $j = 1; $entry },
            { let $j = 2; $entry },
        ]
    }};
}

impl<N: Number> Tensor<N> {
    /// The tensor of zeros.
    #[inline(always)]
    #[must_use]
    pub fn zero() -> Self {
        Self([[N::of(0.0); 3]; 3])
    }

    /// A multiple of the identity.
    #[inline(always)]
    #[must_use]
    pub fn diagonal(value: N) -> Self {
        let zero = N::of(0.0);
        Self([
            [value, zero, zero],
            [zero, value, zero],
            [zero, zero, value],
        ])
    }

    /// The identity.
    #[inline(always)]
    #[must_use]
    pub fn identity() -> Self {
        Self::diagonal(N::of(1.0))
    }

    /// The tensor that has these entries in every lane.
    #[inline(always)]
    #[must_use]
    pub fn of(rows: [[f64; 3]; 3]) -> Self {
        entries!(|i, j| N::of(rows[i][j]))
    }

    /// The outer product of two vectors.
    #[inline(always)]
    #[must_use]
    pub fn outer(a: [N; 3], b: [N; 3]) -> Self {
        entries!(|i, j| a[i] * b[j])
    }

    /// A tensor from its columns.
    #[inline(always)]
    #[must_use]
    pub fn from_columns([a, b, c]: [[N; 3]; 3]) -> Self {
        Self([a, b, c]).transposed()
    }

    /// The tensor whose product with a vector is the cross product of `[x, y, z]` with it.
    #[inline(always)]
    #[must_use]
    pub fn cross_product_with([x, y, z]: [N; 3]) -> Self {
        let zero = N::of(0.0);
        Self([[zero, -z, y], [z, zero, -x], [-y, x, zero]])
    }

    /// The columns.
    #[inline(always)]
    #[must_use]
    pub fn columns(self) -> [[N; 3]; 3] {
        self.transposed().0
    }

    /// The tensor with rows and columns exchanged.
    #[inline(always)]
    #[must_use]
    pub fn transposed(self) -> Self {
        let a = self.0;
        entries!(|i, j| a[j][i])
    }

    /// A multiple.
    #[inline(always)]
    #[must_use]
    pub fn scaled(self, factor: N) -> Self {
        let a = self.0;
        entries!(|i, j| a[i][j] * factor)
    }

    /// This tensor and a multiple of another.
    #[inline(always)]
    #[must_use]
    pub fn plus(self, factor: N, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        entries!(|i, j| b[i][j].mul_add(factor, a[i][j]))
    }

    /// The product with the transpose of `other` on the right.
    #[inline(always)]
    #[must_use]
    pub fn times_transposed(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        entries!(|i, j| dot(a[i], b[j]))
    }

    /// The product of the transpose of this tensor with `other`.
    #[inline(always)]
    #[must_use]
    pub fn transposed_times(self, other: Self) -> Self {
        self.transposed() * other
    }

    /// The tensor in perpendicular axes, given by the rows of `axes`.
    #[inline(always)]
    #[must_use]
    pub fn in_axes(self, axes: Self) -> Self {
        (axes * self).times_transposed(axes)
    }

    /// The tensor whose entries in perpendicular axes, given by the rows of `axes`, are these.
    #[inline(always)]
    #[must_use]
    pub fn out_of_axes(self, axes: Self) -> Self {
        axes.transposed_times(self * axes)
    }

    /// The product with a vector.
    #[inline(always)]
    #[must_use]
    pub fn on(self, x: [N; 3]) -> [N; 3] {
        [dot(self.0[0], x), dot(self.0[1], x), dot(self.0[2], x)]
    }

    /// The sum of the products of all entries, `a : b`.
    #[inline(always)]
    #[must_use]
    pub fn contracted(self, other: Self) -> N {
        let (a, b) = (self.0, other.0);
        dot(a[0], b[0]) + dot(a[1], b[1]) + dot(a[2], b[2])
    }

    /// The sum of the squares of all entries.
    #[inline(always)]
    #[must_use]
    pub fn squared(self) -> N {
        self.contracted(self)
    }

    /// The sum of the diagonal.
    #[inline(always)]
    #[must_use]
    pub fn trace(self) -> N {
        let [[xx, ..], [_, yy, _], [.., zz]] = self.0;
        xx + yy + zz
    }

    /// The symmetric part.
    #[inline(always)]
    #[must_use]
    pub fn symmetric(self) -> Self {
        (self + self.transposed()).scaled(N::of(0.5))
    }

    /// The derivative of the determinant by the tensor: rows are cross products of rows, so it exists where the
    /// determinant is 0.
    #[inline(always)]
    #[must_use]
    pub fn cofactor(self) -> Self {
        let [a, b, c] = self.0;
        Self([cross(b, c), cross(c, a), cross(a, b)])
    }

    /// The change of the cofactor by a change of the tensor, which is linear in both.
    #[inline(always)]
    #[must_use]
    pub fn cofactor_change(self, change: Self) -> Self {
        let ([a, b, c], [da, db, dc]) = (self.0, change.0);
        let row = |p, dq, dp, q| add(cross(p, dq), cross(dp, q));
        Self([row(b, dc, db, c), row(c, da, dc, a), row(a, db, da, b)])
    }

    /// Entries of `then` where `a <= b`, else of `otherwise`.
    #[inline(always)]
    #[must_use]
    pub fn select_le(a: N, b: N, then: Self, otherwise: Self) -> Self {
        let (then, otherwise) = (then.0, otherwise.0);
        entries!(|i, j| N::select_le(a, b, then[i][j], otherwise[i][j]))
    }

    /// The largest size of an entry.
    #[inline(always)]
    #[must_use]
    pub fn largest(self) -> N {
        let [x, y, z] = self.0;
        largest(x).max(largest(y)).max(largest(z))
    }
}

impl<N: Number> Add for Tensor<N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        entries!(|i, j| a[i][j] + b[i][j])
    }
}

impl<N: Number> Sub for Tensor<N> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        entries!(|i, j| a[i][j] - b[i][j])
    }
}

impl<N: Number> Mul for Tensor<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        entries!(|i, j| {
            let last = a[i][2] * b[2][j];
            a[i][0].mul_add(b[0][j], a[i][1].mul_add(b[1][j], last))
        })
    }
}

#[inline(always)]
fn largest<N: Number>(row: [N; 3]) -> N {
    row[0].abs().max(row[1].abs()).max(row[2].abs())
}

/// The scalar product.
#[inline(always)]
pub(crate) fn dot<N: Number>(a: [N; 3], b: [N; 3]) -> N {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}

#[inline(always)]
pub(super) fn cross<N: Number>(a: [N; 3], b: [N; 3]) -> [N; 3] {
    let entry = |i: usize, j: usize| a[i].mul_add(b[j], -(a[j] * b[i]));
    [entry(1, 2), entry(2, 0), entry(0, 1)]
}

#[inline(always)]
pub(super) fn add<N: Number>(a: [N; 3], b: [N; 3]) -> [N; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
pub(super) fn scale<N: Number>(a: [N; 3], factor: N) -> [N; 3] {
    [a[0] * factor, a[1] * factor, a[2] * factor]
}
