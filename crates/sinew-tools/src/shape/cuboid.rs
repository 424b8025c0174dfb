//! Cuboids about the origin.

use super::touch::{Nearest, Touch};
use crate::vector::{length_and_direction, sub};

pub(super) fn nearest(point: [f64; 3], half: [f64; 3]) -> Nearest {
    let on_it = clamped(point, half);
    let outside = sub(point, on_it);
    if outside != [0.0; 3] {
        let (distance, normal) = length_and_direction(outside, [0.0, 0.0, 1.0]);
        return Nearest {
            distance,
            point: on_it,
            normal,
        };
    }
    let gap = |axis: usize| point[axis].abs() - half[axis];
    let nearer = |best, axis| if gap(axis) > gap(best) { axis } else { best };
    let axis = (1..3).fold(0, nearer);
    let side = side(point[axis]);
    let mut on_face = point;
    on_face[axis] = side * half[axis];
    Nearest {
        distance: gap(axis),
        point: on_face,
        normal: normal(axis, side),
    }
}

/// Contact at which a point outside or on the surface enters, by slabs (Kay and Kajiya 1986): a point is inside while
/// it is between all three pairs of faces. A gap up to `tolerance` (m) counts as zero.
///
/// The slabs are open, so that a point that slides along a face or an edge does not enter.
pub(super) fn first_contact(
    from: [f64; 3],
    motion: [f64; 3],
    half: [f64; 3],
    tolerance: f64,
) -> Option<Touch> {
    let mut first: Option<(f64, usize)> = None;
    let mut leaves = f64::INFINITY;
    for axis in 0..3 {
        let (place, speed) = (from[axis], motion[axis]);
        if speed == 0.0 {
            if place.abs() >= half[axis] {
                return None;
            }
            continue;
        }
        // The faces are met at -half and half, seen along the motion.
        let along = place * speed.signum();
        leaves = leaves.min((half[axis] - along) / speed.abs());
        let gap = -half[axis] - along;
        if gap < 0.0 {
            continue;
        }
        let enters = if gap <= tolerance {
            0.0
        } else {
            gap / speed.abs()
        };
        let is_first = first.is_none_or(|(share, other)| {
            enters > share || (enters == share && speed.abs() > motion[other].abs())
        });
        if is_first {
            first = Some((enters, axis));
        }
    }
    let (share, axis) = first?;
    let side = -motion[axis].signum();
    let there = [0, 1, 2].map(|axis| from[axis] + share * motion[axis]);
    let mut point = clamped(there, half);
    point[axis] = side * half[axis];
    (share < leaves).then(|| Touch {
        share,
        point,
        normal: normal(axis, side),
    })
}

fn clamped(point: [f64; 3], half: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| point[axis].clamp(-half[axis], half[axis]))
}

fn side(place: f64) -> f64 {
    if place < 0.0 { -1.0 } else { 1.0 }
}

fn normal(axis: usize, side: f64) -> [f64; 3] {
    let mut normal = [0.0; 3];
    normal[axis] = side;
    normal
}

#[cfg(test)]
mod tests {
    use super::*;

    const HALF: [f64; 3] = [0.5, 1.0, 2.0];

    #[test]
    fn inside_the_nearest_face_counts_and_outside_edges_and_corners_too() {
        let centre = nearest([0.0; 3], HALF);
        assert_eq!(centre.distance, -0.5);
        assert_eq!(
            (centre.point, centre.normal),
            ([0.5, 0.0, 0.0], [1.0, 0.0, 0.0])
        );

        let below = nearest([0.1, -0.9, 0.3], HALF);
        assert!((below.distance + 0.1).abs() < 1e-16);
        assert_eq!(
            (below.point, below.normal),
            ([0.1, -1.0, 0.3], [0.0, -1.0, 0.0])
        );

        let edge = nearest([0.5 + 3.0, 1.0 + 4.0, 0.7], HALF);
        assert_eq!(edge.distance, 5.0);
        assert_eq!(
            (edge.point, edge.normal),
            ([0.5, 1.0, 0.7], [0.6, 0.8, 0.0])
        );

        let corner = nearest([-0.5 - 1.0, 1.0 + 2.0, -2.0 - 2.0], HALF);
        assert_eq!(corner.distance, 3.0);
        assert_eq!(corner.point, [-0.5, 1.0, -2.0]);
        assert_eq!(corner.normal, [-1.0, 2.0, -2.0].map(|value| value / 3.0));
    }

    #[test]
    fn the_face_that_is_met_last_is_the_one_that_is_entered() {
        let touch = first_contact([2.0, 1.5, 0.0], [-3.0, -3.0, 0.0], HALF, 0.0).unwrap();
        assert_eq!(touch.share, 0.5);
        assert_eq!(
            (touch.point, touch.normal),
            ([0.5, 0.0, 0.0], [1.0, 0.0, 0.0])
        );
    }

    #[test]
    fn sliding_and_passing_by_an_edge_are_no_entry() {
        let misses = |from, motion| first_contact(from, motion, HALF, 1e-12).is_none();
        assert!(misses([0.5, 0.0, -3.0], [0.0, 0.0, 6.0]));
        // Through the edge x = .5, y = 1, from outside to outside.
        assert!(misses([1.0, 0.5, 0.0], [-1.0, 1.0, 0.0]));
        // From the edge, inwards across one of its faces and outwards across the other.
        assert!(misses([0.5, 1.0, 0.0], [-0.1, 0.2, 0.0]));
        assert!(misses([0.5, 1.0, 0.0], [0.0; 3]));
    }

    #[test]
    fn at_a_corner_a_face_answers_that_the_motion_opposes() {
        let touch = first_contact([0.5, 1.0, 2.0], [-0.1, -0.2, -0.05], HALF, 1e-12).unwrap();
        assert_eq!(touch.share, 0.0);
        assert_eq!(
            (touch.point, touch.normal),
            ([0.5, 1.0, 2.0], [0.0, 1.0, 0.0])
        );
    }
}
