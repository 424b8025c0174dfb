//! Vector operations that kernels need.

use super::real::Real;

/// Largest number of lanes, for arrays.
pub(crate) const MOST: usize = 16;

/// A vector of `T::LANES` numbers: 64 bytes for every instruction set, so that layouts in memory do
/// not depend on it.
///
/// # Safety
/// Every method may be called only where the instruction set of the implementation is available. Pointers
/// have to be valid for `T::LANES` numbers (indices included), or for the rows that a method names, and need no alignment beyond that of a number.
#[allow(unsafe_code, reason = "one contract for all methods stands above")]
pub(crate) trait Lanes<T: Real>: Copy {
    unsafe fn splat(value: T) -> Self;
    unsafe fn load(from: *const T) -> Self;
    unsafe fn store(self, to: *mut T);
    /// The numbers at `from + index`.
    unsafe fn gather(from: *const T, index: *const u32) -> Self;
    unsafe fn add(self, other: Self) -> Self;
    unsafe fn sub(self, other: Self) -> Self;
    unsafe fn mul(self, other: Self) -> Self;
    unsafe fn div(self, other: Self) -> Self;
    unsafe fn sqrt(self) -> Self;
    /// [`Real::two_to_it`].
    unsafe fn two_to_it(self) -> Self;
    /// [`Real::parts`].
    unsafe fn parts(self) -> [Self; 2];
    /// Prefetches the 64 bytes at an address, which need not be valid, into the first cache.
    unsafe fn prefetch(from: *const T);
    /// `self factor + other`, rounded once if the instruction set can.
    unsafe fn mul_add(self, factor: Self, other: Self) -> Self;
    /// The number of the same sign whose size is `limit` at most; NaN stays NaN.
    unsafe fn clamp(self, limit: Self) -> Self;
    /// 0 if the size is below `tiny`.
    unsafe fn flush(self, tiny: Self) -> Self;
    /// One bit for each lane that is at most `other`; none if one of them is NaN.
    unsafe fn at_most(self, other: Self) -> u32;
    /// `then` in lanes with `a` at most `b`, else `otherwise`, also if one of the two is NaN.
    unsafe fn select_le(a: Self, b: Self, then: Self, otherwise: Self) -> Self;
    /// One bit for each lane whose size is at least `limit`.
    unsafe fn reaches(self, limit: Self) -> u32;
    /// The first three columns of the rows of four numbers at these addresses, of which the first `T::LANES` are used.
    #[inline(always)]
    unsafe fn from_rows(rows: [*const [T; 4]; MOST]) -> [Self; 3] {
        let mut columns = [[T::default(); MOST]; 3];
        for (lane, row) in rows.into_iter().enumerate().take(T::LANES) {
            for (axis, column) in columns.iter_mut().enumerate() {
                // SAFETY: the address of a row.
                column[lane] = unsafe { (*row)[axis] };
            }
        }
        // SAFETY: each column has space for the largest vector.
        unsafe {
            [
                Self::load(columns[0].as_ptr()),
                Self::load(columns[1].as_ptr()),
                Self::load(columns[2].as_ptr()),
            ]
        }
    }
    /// [`Lanes::from_rows`] of the rows whose first numbers are at `from + places`, one for each lane.
    #[inline(always)]
    unsafe fn gather_rows(from: *const T, places: *const u32) -> [Self; 3] {
        let mut rows = [std::ptr::null(); MOST];
        for (lane, row) in rows.iter_mut().enumerate().take(T::LANES) {
            // SAFETY: there is a place for each lane.
            *row = unsafe { from.wrapping_add(*places.add(lane) as usize) }.cast();
        }
        // SAFETY: the addresses of rows.
        unsafe { Self::from_rows(rows) }
    }
    /// Writes three columns and one of zeros as rows of four numbers, `stride` rows apart.
    #[inline(always)]
    unsafe fn to_rows([x, y, z]: [Self; 3], to: *mut [T; 4], stride: usize) {
        let mut columns = [[T::default(); MOST]; 3];
        // SAFETY: each column has space for the largest vector, and `to` for all rows.
        unsafe {
            x.store(columns[0].as_mut_ptr());
            y.store(columns[1].as_mut_ptr());
            z.store(columns[2].as_mut_ptr());
        }
        let [x, y, z] = columns;
        let rows = x.into_iter().zip(y).zip(z).take(T::LANES);
        for (lane, ((x, y), z)) in rows.enumerate() {
            // SAFETY: `to` has space for all rows.
            unsafe { *to.add(lane * stride) = [x, y, z, T::default()] }
        }
    }
    /// One bit for each lane whose size is not at most `limit`: larger, or NaN.
    unsafe fn exceeds(self, limit: Self) -> u32;
}
