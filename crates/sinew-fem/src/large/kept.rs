//! Storage format of tensors that force loops keep from one task to another, and lanes of vectors.

use sinew_sparse::simd::Number;

use super::chunks::LANES;
use crate::hyperelastic::Tensor;

/// A tensor, whose rows end in 0.
pub(super) type Rows<T> = [[T; 4]; 3];

/// Rows of zeros.
pub(super) fn no_rows<T: Default + Copy>() -> Rows<T> {
    [[T::default(); 4]; 3]
}

/// Tensors side by side.
#[inline(always)]
pub(super) fn load<N: Number>(from: &[Rows<N::Real>]) -> Tensor<N> {
    let rows = from.as_flattened();
    Tensor([
        N::load_rows(rows, 3),
        N::load_rows(&rows[1..], 3),
        N::load_rows(&rows[2..], 3),
    ])
}

/// Writes tensors side by side.
#[inline(always)]
pub(super) fn store<N: Number>(tensor: Tensor<N>, to: &mut [Rows<N::Real>]) {
    let rows = to.as_flattened_mut();
    let [x, y, z] = tensor.0;
    N::store_rows(x, rows, 3);
    N::store_rows(y, &mut rows[1..], 3);
    N::store_rows(z, &mut rows[2..], 3);
}

/// The tensor whose entries are stored one vector after the other.
#[inline(always)]
pub(super) fn load_entries<N: Number>(from: &[N::Real]) -> Tensor<N> {
    let from = &from[..9 * N::LANES];
    let (first, rest) = from.split_at(3 * N::LANES);
    let (second, third) = rest.split_at(3 * N::LANES);
    Tensor([load_row(first), load_row(second), load_row(third)])
}

#[inline(always)]
fn load_row<N: Number>(from: &[N::Real]) -> [N; 3] {
    [
        N::load(from),
        N::load(&from[N::LANES..]),
        N::load(&from[2 * N::LANES..]),
    ]
}

/// Writes the entries of a tensor one vector after the other.
#[inline(always)]
pub(super) fn store_entries<N: Number>(tensor: Tensor<N>, to: &mut [N::Real]) {
    let entries = tensor.0.as_flattened().iter();
    for (entry, to) in entries.zip(to.chunks_exact_mut(N::LANES)) {
        entry.store(to);
    }
}

/// All lanes; 1 beyond the last.
#[inline(always)]
pub(super) fn lanes<N: Number>(number: N) -> [f64; LANES] {
    let mut lanes = [1.0; LANES];
    for (lane, of_lane) in lanes.iter_mut().enumerate().take(N::LANES) {
        *of_lane = number.lane(lane);
    }
    lanes
}
