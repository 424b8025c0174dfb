//! Vectors of three coordinates.

/// Three coordinates.
pub type Vector = [f64; 3];

/// The sum of two vectors.
#[must_use]
pub fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// The difference `a - b`.
#[must_use]
pub fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// A vector times a number.
#[must_use]
pub fn scaled(a: Vector, factor: f64) -> Vector {
    a.map(|value| value * factor)
}

/// The scalar product.
#[must_use]
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector product.
#[must_use]
pub fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The point at this share of the segment from `a` to `b`; exactly `a` in components with equal `b`.
#[must_use]
pub fn between(a: Vector, b: Vector, share: f64) -> Vector {
    add(a, scaled(sub(b, a), share))
}

/// The length of a vector, also of one whose squares are too small for f64.
#[must_use]
pub fn length(a: Vector) -> f64 {
    let squares = dot(a, a);
    if squares > 1e-280 && squares.is_finite() {
        return squares.sqrt();
    }
    let largest = a
        .iter()
        .fold(0.0, |largest: f64, value| largest.max(value.abs()));
    if largest == 0.0 {
        return 0.0;
    }
    let a = a.map(|value| value / largest);
    largest * dot(a, a).sqrt()
}

/// The length of a vector and its direction, or `otherwise` for a vector of length 0.
#[must_use]
pub fn length_and_direction(a: Vector, otherwise: Vector) -> (f64, Vector) {
    let length = length(a);
    if length < f64::MIN_POSITIVE {
        return (length, otherwise);
    }
    let direction = a.map(|value| value / length);
    (length, direction)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiny_and_huge_vectors_have_their_length_and_direction() {
        for size in [1e-307, 1e-170, 1e-3, 1.0, 1e170] {
            let (length, direction) =
                length_and_direction([3.0 * size, 0.0, -4.0 * size], [0.0; 3]);
            assert!((length / size - 5.0).abs() < 1e-14, "{size}");
            assert!(self::length(sub(direction, [0.6, 0.0, -0.8])) < 1e-14);
        }
    }

    #[test]
    fn a_vector_without_direction_takes_the_other() {
        let up = [0.0, 0.0, 1.0];
        assert_eq!(length_and_direction([0.0; 3], up), (0.0, up));
    }
}
