//! Segments and triangles.

use sinew_tools::nearest_of_segments;
use sinew_tools::vector::{Vector, between, cross, dot, length, sub};

use super::depth::distance;

/// True if a segment and a triangle are certain to be farther apart than a distance (m): an axis separates them
/// (Gottschalk, Lin and Manocha 1996).
pub(super) fn are_apart([p, q]: [Vector; 2], triangle: [Vector; 3], distance: f64) -> bool {
    let way = sub(q, p);
    let [a, b, c] = triangle.map(|corner| sub(corner, p));
    let sides = [sub(b, a), sub(c, b), sub(a, c)];
    let parts = |axis: Vector| {
        let end = dot(way, axis);
        let [a, b, c] = [a, b, c].map(|corner| dot(corner, axis));
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let gap = (end.min(0.0) - high).max(low - end.max(0.0));
        gap > 0.0 && gap * gap > distance * distance * dot(axis, axis)
    };
    // Most pairs lie side by side on a surface: first the axes along it.
    let normal = cross(sides[0], sides[1]);
    sides.iter().any(|side| parts(cross(normal, *side)))
        || parts(cross(normal, way))
        || parts(normal)
        || sides.iter().any(|side| parts(cross(way, *side)))
}

/// The distance (m) between a segment and a triangle.
pub(super) fn gap(segment: [Vector; 2], triangle: [Vector; 3]) -> f64 {
    if crossing(segment, triangle).is_some() {
        return 0.0;
    }
    let [a, b, c] = triangle;
    let from_sides = [[a, b], [b, c], [c, a]].map(|side| {
        let (along, across) = nearest_of_segments(segment, side);
        let point = |[from, to]: [Vector; 2], share| between(from, to, share);
        length(sub(point(segment, along), point(side, across)))
    });
    let from_ends = segment.map(|end| distance(end, triangle));
    let all = from_sides.into_iter().chain(from_ends);
    all.fold(f64::INFINITY, f64::min)
}

/// The parameter of a segment at which it crosses a triangle.
pub(super) fn crossing([p, q]: [Vector; 2], [a, b, c]: [Vector; 3]) -> Option<f64> {
    let normal = cross(sub(b, a), sub(c, a));
    let [from, to] = [p, q].map(|end| dot(sub(end, a), normal));
    if from * to >= 0.0 {
        return None;
    }
    // The volumes that the segment has with the sides have one sign where it passes within.
    let way = sub(q, p);
    let side = |one: Vector, other: Vector| dot(way, cross(sub(one, p), sub(other, p)));
    let around = [side(a, b), side(b, c), side(c, a)];
    let within = around.iter().all(|side| *side >= 0.0) || around.iter().all(|side| *side <= 0.0);
    within.then(|| from / (from - to))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: [Vector; 3] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    #[test]
    fn segments_beside_over_in_and_through_a_triangle_are_told_apart() {
        let cases = [
            // Through it, and beside it through its plane.
            ([[0.2, 0.2, -1.0], [0.2, 0.2, 3.0]], 0.0, Some(0.25)),
            (
                [[0.8, 0.8, -1.0], [0.8, 0.8, 1.0]],
                0.3 * 2.0_f64.sqrt(),
                None,
            ),
            // Above it, and in its plane beside it and across it.
            ([[0.2, 0.2, 0.5], [0.3, 0.2, 0.5]], 0.5, None),
            ([[-1.0, -0.5, 0.0], [2.0, -0.5, 0.0]], 0.5, None),
            ([[-1.0, 0.5, 0.0], [2.0, 0.5, 0.0]], 0.0, None),
            // Past an edge, which it meets nowhere.
            ([[-1.0, -0.5, 1.0], [-1.0, 0.5, -1.0]], 1.0, None),
        ];
        for scale in [1e-5, 1.0, 1e4] {
            let scaled = |point: Vector| point.map(|along| scale * along);
            for (segment, distance, share) in cases {
                let (segment, triangle) = (segment.map(scaled), TRIANGLE.map(scaled));
                assert!((gap(segment, triangle) - scale * distance).abs() < 1e-12 * scale);
                assert!(
                    !are_apart(segment, triangle, scale * (distance + 1e-9)),
                    "{segment:?}"
                );
                if distance > 0.0 {
                    assert!(
                        are_apart(segment, triangle, scale * (distance - 1e-9)),
                        "{segment:?}"
                    );
                }
                let found = crossing(segment, triangle);
                assert_eq!(
                    found.map(|share| (share * 1e9).round()),
                    share.map(|share| share * 1e9)
                );
            }
        }
    }
}
