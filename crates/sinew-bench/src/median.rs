//! Medians.

/// Sorts some values and returns the middle one; NaN without values.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    median_of_sorted(values)
}

/// The middle one of sorted values; NaN without values.
pub(crate) fn median_of_sorted(sorted: &[f64]) -> f64 {
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}
