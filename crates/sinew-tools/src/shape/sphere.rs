//! Spheres about the origin, used for capsules too.

use super::touch::{Nearest, Touch};
use crate::vector::{add, dot, length, length_and_direction, scaled, sub};

/// The nearest point of the surface; for the centre it is the one along `otherwise`, a unit vector.
pub(super) fn nearest(point: [f64; 3], radius: f64, otherwise: [f64; 3]) -> Nearest {
    let (from_centre, normal) = length_and_direction(point, otherwise);
    Nearest {
        distance: from_centre - radius,
        point: scaled(normal, radius),
        normal,
    }
}

/// Contact at which a point from outside enters.
pub(super) fn first_contact(from: [f64; 3], motion: [f64; 3], radius: f64) -> Option<Touch> {
    let share = entry(from, motion, radius)?;
    let (_, normal) = length_and_direction(add(from, scaled(motion, share)), [0.0, 0.0, 1.0]);
    Some(Touch {
        share,
        point: scaled(normal, radius),
        normal,
    })
}

/// The share, of any size, of a motion at which a point outside enters a sphere, or in a plane a circle.
///
/// Of the two roots of `a s^2 + 2 b s + c = 0` the smaller one, as `c / (-b + sqrt(b^2 - a c))`, which is free of
/// cancellation; the discriminant is computed from the distance of the line from the centre.
pub(super) fn entry(from: [f64; 3], motion: [f64; 3], radius: f64) -> Option<f64> {
    let b = dot(from, motion);
    if b >= 0.0 {
        return None;
    }
    let a = dot(motion, motion);
    let passes_at = length(sub(from, scaled(motion, b / a)));
    if passes_at < radius {
        let from_centre = length(from);
        let c = (from_centre - radius) * (from_centre + radius);
        let root = (a * (radius - passes_at) * (radius + passes_at)).sqrt();
        Some((c / (root - b)).max(0.0))
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_has_its_digits_from_far_away_and_from_next_to_it() {
        // From distance d straight at the sphere: (d - R) / d.
        for distance in [1.0 + 1e-15, 1.0 + 1e-9, 1.5, 1e6] {
            let motion = [0.0, -distance, 0.0];
            let share = entry([0.0, distance, 0.0], motion, 1.0).unwrap();
            let expected = (distance - 1.0) / distance;
            assert!((share - expected).abs() <= 4e-16 * expected, "{distance}");
        }
        // At an offset of .6 R the height is .8 R.
        let share = entry([0.6, 2.0, 0.0], [0.0, -2.4, 0.0], 1.0).unwrap();
        assert!((share - 0.5).abs() < 1e-15);
    }

    #[test]
    fn a_line_that_only_touches_does_not_enter() {
        assert_eq!(entry([1.0, -5.0, 0.0], [0.0, 10.0, 0.0], 1.0), None);
        assert_eq!(entry([0.0, 5.0, 0.0], [0.0, 10.0, 0.0], 1.0), None);
        assert_eq!(entry([0.0, 5.0, 0.0], [0.0; 3], 1.0), None);
    }
}
