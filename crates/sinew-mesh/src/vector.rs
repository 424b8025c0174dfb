//! Vectors of three coordinates.

/// Three coordinates.
pub type Vector = [f64; 3];

/// The sum of two vectors.
#[must_use]
#[inline]
pub fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// The difference `a - b`.
#[must_use]
#[inline]
pub fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// A vector times a number.
#[must_use]
#[inline]
pub fn scaled(a: Vector, factor: f64) -> Vector {
    a.map(|value| value * factor)
}

/// The scalar product.
#[must_use]
#[inline]
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector product.
#[must_use]
#[inline]
pub fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The length of a vector.
#[must_use]
#[inline]
pub fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// The mean of some points.
#[must_use]
#[inline]
pub fn mean<const N: usize>(points: [Vector; N]) -> Vector {
    scaled(points.into_iter().fold([0.0; 3], add), 1.0 / N as f64)
}

/// The least and the greatest coordinates of some points.
#[must_use]
pub fn bounds_of<const N: usize>(points: [Vector; N]) -> [Vector; 2] {
    let extreme = |from: f64, choose: fn(f64, f64) -> f64| {
        std::array::from_fn(|axis| {
            let along = points.iter().map(|point| point[axis]);
            along.fold(from, choose)
        })
    };
    [
        extreme(f64::INFINITY, f64::min),
        extreme(f64::NEG_INFINITY, f64::max),
    ]
}
