//! Largest values of polynomials on an interval.

use std::f64::consts::PI;

/// Points per degree among which the largest value of a polynomial is sought.
pub(super) const POINTS_PER_DEGREE: usize = 32;

/// Share of the largest value that a peak has at one of these points: cos(pi/64), rounded down.
const SEEN_OF_A_PEAK: f64 = 0.99;

/// The largest value of the absolute value of a polynomial, given as a function of the angle, between the angles 0 and
/// pi, from this many points for the first search.
pub(super) fn largest_value(function: impl Fn(f64) -> f64, points: usize) -> f64 {
    let width = PI / points as f64;
    let seen: Vec<f64> = (0..=points)
        .map(|point| function(point as f64 * width))
        .collect();
    let largest = seen.iter().copied().fold(0.0, f64::max);
    // Peaks of nearly the same height: the highest of them may be seen less well than another.
    let near = (0..=points).filter(|point| seen[*point] >= SEEN_OF_A_PEAK * largest);
    let peaks = near.map(|point| peak_about(&function, point as f64 * width, width));
    // Rounding of a value.
    peaks.fold(largest, f64::max) * (1.0 + 1e-14)
}

/// The least value of a polynomial, given as a function of the angle, between the angles 0 and pi, from this many
/// points for the first search.
pub(super) fn least_value(function: impl Fn(f64) -> f64, points: usize) -> f64 {
    let upside_down = |angle: f64| -function(angle);
    let places = tops(upside_down, points).into_iter();
    places.map(&function).fold(f64::INFINITY, f64::min)
}

/// The angles between 0 and pi at which a polynomial, given as a function of the angle, has local maxima: for each of
/// this many points above its neighbours, the maximum near it.
pub(super) fn tops(function: impl Fn(f64) -> f64, points: usize) -> Vec<f64> {
    let width = PI / points as f64;
    let seen: Vec<f64> = (0..=points)
        .map(|point| function(point as f64 * width))
        .collect();
    let above = |point: usize, other: Option<&f64>| other.is_none_or(|other| seen[point] >= *other);
    let tops = (0..=points).filter(|point| {
        let before = point.checked_sub(1).and_then(|before| seen.get(before));
        above(*point, before) && above(*point, seen.get(point + 1))
    });
    let places = tops.flat_map(|point| {
        let centre = point as f64 * width;
        [centre, top_about(&function, centre, width)]
    });
    places.collect()
}

/// The largest value of a function within `width` of a point.
fn peak_about(function: &impl Fn(f64) -> f64, centre: f64, width: f64) -> f64 {
    function(top_about(function, centre, width))
}

/// Place of the largest value of a function within `width` of a point, by golden section.
pub(super) fn top_about(function: &impl Fn(f64) -> f64, centre: f64, width: f64) -> f64 {
    let golden = (5.0_f64.sqrt() - 1.0) / 2.0;
    let (mut low, mut high) = (centre - width, centre + width);
    // Where a maximum is found to the square root of rounding, its value is to rounding.
    for _ in 0..40 {
        let (left, right) = (high - golden * (high - low), low + golden * (high - low));
        if function(left) >= function(right) {
            high = right;
        } else {
            low = left;
        }
    }
    0.5 * (low + high)
}
