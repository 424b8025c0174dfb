//! Axes of a material at rest.

use sinew_mesh::vector::cross;

/// Three perpendicular unit vectors in the material at rest, the third the cross product of the others.
pub(crate) type Frame = [[f64; 3]; 3];

/// True if two vectors make no axes: they are parallel, or no directions.
#[must_use]
pub fn are_parallel(first: [f64; 3], second: [f64; 3]) -> bool {
    frame(first, second).is_none()
}

/// Perpendicular unit vectors: along the first vector, along what is left of the second, and their cross product; `None`
/// where the two are parallel, or not vectors.
pub(crate) fn frame(first: [f64; 3], second: [f64; 3]) -> Option<Frame> {
    let (first, second) = (unit(first)?, unit(second)?);
    let along: f64 = first.iter().zip(second).map(|(a, b)| a * b).sum();
    let rest = [0, 1, 2].map(|i| second[i] - along * first[i]);
    let is_parallel = rest.iter().map(|d| d * d).sum::<f64>() < 1e-12;
    let second = unit(rest).filter(|_| !is_parallel)?;
    Some([first, second, cross(first, second)])
}

/// The unit vector along another; `None` where that is 0 or not finite.
pub(crate) fn unit(vector: [f64; 3]) -> Option<[f64; 3]> {
    // Scaled first, so that no square overflows or is lost.
    let largest = vector.iter().fold(0.0, |m: f64, d| m.max(d.abs()));
    if !(vector.iter().all(|d| d.is_finite()) && largest > 0.0) {
        return None;
    }
    let scaled = vector.map(|d| d / largest);
    let length = scaled.iter().map(|d| d * d).sum::<f64>().sqrt();
    Some(scaled.map(|d| d / length))
}
