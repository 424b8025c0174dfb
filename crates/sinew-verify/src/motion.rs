//! Errors of motions.

/// The square root of the sum of squares of the differences, over that of the exact values.
pub(crate) fn relative_error(pairs: impl IntoIterator<Item = (f64, f64)>) -> f64 {
    let (mut off, mut all) = (0.0, 0.0);
    for (found, exact) in pairs {
        off += (found - exact) * (found - exact);
        all += exact * exact;
    }
    f64::sqrt(off / all)
}
