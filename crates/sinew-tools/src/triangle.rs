//! Points of triangles.

use crate::vector::{Vector, dot, sub};

/// Weights of the corners for the point of a triangle that is nearest to a given point (Ericson, Real-Time Collision
/// Detection, 2005, 5.1.5).
#[must_use]
pub fn nearest_of_triangle([a, b, c]: &[Vector; 3], point: Vector) -> Vector {
    let (ab, ac) = (sub(*b, *a), sub(*c, *a));
    let from = |corner: &Vector| sub(point, *corner);
    let (d1, d2) = (dot(ab, from(a)), dot(ac, from(a)));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let (d3, d4) = (dot(ab, from(b)), dot(ac, from(b)));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let of_c = d1 * d4 - d3 * d2;
    if of_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let share = d1 / (d1 - d3);
        return [1.0 - share, share, 0.0];
    }
    let (d5, d6) = (dot(ab, from(c)), dot(ac, from(c)));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let of_b = d5 * d2 - d1 * d6;
    if of_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let share = d2 / (d2 - d6);
        return [1.0 - share, 0.0, share];
    }
    let of_a = d3 * d6 - d5 * d4;
    if of_a <= 0.0 && d4 >= d3 && d5 >= d6 {
        let share = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - share, share];
    }
    let sum = of_a + of_b + of_c;
    [of_a / sum, of_b / sum, of_c / sum]
}
