//! Bounds on the vectors of cells.

/// Share by which a vector may be longer than its limit before it is shortened: the rounding error of a vector that has
/// just been shortened.
pub(super) const ROUNDING: f64 = 1e-9;

/// Shortens a cell's vector, measured from `from` or from 0, to `limit` if it is longer; returns true if it shortened
/// the vector. A vector within the limit keeps its bits.
pub fn clamp_vector(vector: &mut [f64], from: Option<&[f64]>, limit: f64) -> bool {
    clamp_within(vector, from, limit, ROUNDING)
}

/// [`clamp_vector`] for numbers that are rounded to a share of themselves.
pub(super) fn clamp_within(
    vector: &mut [f64],
    from: Option<&[f64]>,
    limit: f64,
    rounding: f64,
) -> bool {
    let at = |index: usize| from.map_or(0.0, |from| from[index]);
    let part = |index: usize, vector: &[f64]| vector[index] - at(index);
    let parts = 0..vector.len();
    let square: f64 = parts.clone().map(|i| part(i, vector).powi(2)).sum();
    let allowed = limit * (1.0 + rounding);
    if square <= allowed * allowed {
        return false;
    }
    // Squares may overflow where lengths do not.
    let sizes = parts.clone().map(|i| part(i, vector).abs());
    let largest = sizes.fold(0.0, f64::max);
    let shares = parts.map(|i| (part(i, vector) / largest).powi(2));
    let length = largest * shares.sum::<f64>().sqrt();
    let longer = length > allowed;
    if longer {
        let share = limit / length;
        for (index, x) in vector.iter_mut().enumerate() {
            *x = at(index) + (*x - at(index)) * share;
        }
    }
    longer
}
