//! Random shapes and points, and vectors of three coordinates.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

pub(crate) mod pressed;

use proptest::prelude::*;
pub(crate) use sinew_tools::vector::{add, dot, length, scaled, sub};
use sinew_tools::{Convex, Pose};

/// A reference length for errors: the radius of the ball about the shape, 1 m for a plane.
pub(crate) fn size(convex: &Convex) -> f64 {
    convex.reach().unwrap_or(1.0)
}

/// Vectors in a cube of edge 2.
pub(crate) fn vectors() -> impl Strategy<Value = [f64; 3]> {
    [-1.0..1.0, -1.0..1.0, -1.0..1.0]
}

pub(crate) fn poses() -> impl Strategy<Value = Pose> {
    (vectors(), vectors()).prop_map(|(position, turn)| Pose::new(position, scaled(turn, 3.0)))
}

/// Round shapes and cuboids of very different proportions, from .1 mm to 1 m.
pub(crate) fn bounded_shapes() -> impl Strategy<Value = Convex> {
    let unit = (-4.0..0.0).prop_map(|power| 10.0_f64.powf(power));
    let unit = unit.boxed();
    prop_oneof![
        unit.clone()
            .prop_map(|radius| Convex::sphere(radius).unwrap()),
        (unit.clone(), prop_oneof![Just(0.0), unit.clone()])
            .prop_map(|(radius, length)| Convex::capsule(radius, length).unwrap()),
        [unit.clone(), unit.clone(), unit].prop_map(|size| Convex::cuboid(size).unwrap()),
    ]
}

pub(crate) fn shapes() -> impl Strategy<Value = Convex> {
    prop_oneof![6 => bounded_shapes(), 1 => Just(Convex::Plane)]
}

/// True if a point is inside by at least `margin`, according to the definition of the shape.
pub(crate) fn is_inside(convex: &Convex, point: [f64; 3], margin: f64) -> bool {
    let [x, y, z] = point;
    match *convex {
        Convex::Sphere { radius, .. } => length(point) < radius - margin,
        Convex::Capsule { radius, length, .. } => {
            let above = (z.abs() - length / 2.0).max(0.0);
            (x * x + y * y + above * above).sqrt() < radius - margin
        }
        Convex::Plane => z < -margin,
        Convex::Cuboid { size, .. } => {
            (0..3).all(|axis| point[axis].abs() < size[axis] / 2.0 - margin)
        }
    }
}
