//! Capsules along z, centred at the origin: a cylinder between two half spheres.

use super::sphere;
use super::touch::{Nearest, Touch};
use crate::vector::{add, length, length_and_direction, scaled, sub};

/// Rounding error of a position, as a share of the radius.
const ROUNDING: f64 = 1e-12;

pub(super) fn nearest(point: [f64; 3], radius: f64, half_length: f64) -> Nearest {
    let centre = [0.0, 0.0, point[2].clamp(-half_length, half_length)];
    let nearest = sphere::nearest(sub(point, centre), radius, [1.0, 0.0, 0.0]);
    Nearest {
        point: add(centre, nearest.point),
        ..nearest
    }
}

/// Contact at which a point from outside enters.
pub(super) fn first_contact(
    from: [f64; 3],
    motion: [f64; 3],
    radius: f64,
    half_length: f64,
) -> Option<Touch> {
    let across = [from[0], from[1], 0.0];
    let mut z = from[2];
    if length(across) > radius {
        // The whole capsule lies within the endless cylinder.
        let share = sphere::entry(across, [motion[0], motion[1], 0.0], radius)?;
        let [x, y, z_there] = add(from, scaled(motion, share));
        z = z_there;
        if z.abs() <= half_length {
            let (_, normal) = length_and_direction([x, y, 0.0], [1.0, 0.0, 0.0]);
            return Some(Touch {
                share,
                point: add([0.0, 0.0, z], scaled(normal, radius)),
                normal,
            });
        }
    }
    let centre = [0.0, 0.0, half_length.copysign(z)];
    let Some(share) = sphere::entry(sub(from, centre), motion, radius) else {
        return through_the_seam(from, motion, radius, centre);
    };
    let mut outward = sub(add(from, scaled(motion, share)), centre);
    // Rounding must not tilt the normal towards the other end, which would then stand out of the tangent plane.
    if outward[2] * z < 0.0 {
        outward[2] = 0.0;
    }
    let (_, normal) = length_and_direction(outward, [0.0, 0.0, 1.0_f64.copysign(z)]);
    Some(Touch {
        share,
        point: add(centre, scaled(normal, radius)),
        normal,
    })
}

/// The contact of a point that enters the cylinder past its round end without entering the end.
///
/// Such a point exists only by rounding, if the line is nearly a tangent of the end.
fn through_the_seam(
    from: [f64; 3],
    motion: [f64; 3],
    radius: f64,
    centre: [f64; 3],
) -> Option<Touch> {
    let share = (centre[2] - from[2]) / motion[2];
    let [x, y, _] = add(from, scaled(motion, share));
    let (from_axis, normal) = length_and_direction([x, y, 0.0], [1.0, 0.0, 0.0]);
    let is_approach = x * motion[0] + y * motion[1] < 0.0;
    (is_approach && share >= 0.0 && from_axis <= radius * (1.0 + ROUNDING)).then(|| Touch {
        share,
        point: add(centre, scaled(normal, radius)),
        normal,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const R: f64 = 0.002;
    const HALF: f64 = 0.01;

    #[test]
    fn the_cylinder_and_both_ends_are_entered_where_they_are() {
        let side = first_contact([3.0 * R, 0.0, 0.004], [-4.0 * R, 0.0, 0.002], R, HALF).unwrap();
        assert!((side.share - 0.5).abs() < 1e-15);
        assert_eq!(side.normal, [1.0, 0.0, 0.0]);
        assert!((side.point[2] - 0.005).abs() < 1e-17);

        for end in [-1.0, 1.0] {
            let from = [0.0, 0.0, end * (HALF + 3.0 * R)];
            let top = first_contact(from, [0.0, 0.0, -end * 4.0 * R], R, HALF).unwrap();
            assert!((top.share - 0.5).abs() < 1e-15);
            assert_eq!(top.normal, [0.0, 0.0, end]);
            assert!((top.point[2] - end * (HALF + R)).abs() < 1e-17);
        }
    }

    #[test]
    fn a_line_beside_the_round_end_misses_although_it_crosses_the_endless_cylinder() {
        let from = [-5.0 * R, 0.0, HALF + 1.01 * R];
        assert_eq!(first_contact(from, [10.0 * R, 0.0, 0.0], R, HALF), None);
    }

    #[test]
    fn a_line_through_the_seam_is_never_lost() {
        // Slopes at which the round end is too near to a tangent of the line to be distinguished from it.
        for slope in [1e-6, 1e-8, 1e-9, 1e-10] {
            for above in [0.0, 1e-18, 1e-17, 1e-13, 1e-10] {
                // In the plane y = 0, down and inwards, through (R, HALF + above).
                let from = [R + slope * 0.01, 0.0, HALF + above + 0.01];
                let touch = first_contact(from, [-slope * 0.02, 0.0, -0.02], R, HALF);
                assert!(touch.is_some(), "{slope} {above}");
            }
        }
    }

    #[test]
    fn a_point_of_the_axis_has_a_normal_across_it() {
        let nearest = nearest([0.0, 0.0, 0.5 * HALF], R, HALF);
        assert_eq!(nearest.distance, -R);
        assert_eq!(nearest.normal, [1.0, 0.0, 0.0]);
        assert_eq!(nearest.point, [R, 0.0, 0.5 * HALF]);
    }
}
