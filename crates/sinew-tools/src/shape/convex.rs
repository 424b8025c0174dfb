//! Convex shapes: distances of points from them, and first contacts of moving points.

use super::error::ShapeError;
use super::touch::{Nearest, Touch};
use super::{capsule, cuboid, plane, sphere};
use crate::vector::{cross, dot, length, scaled, sub};

/// A convex shape in its own frame. Lengths are in metres, points finite.
///
/// The constructors check their arguments; variants can be read, but only made by the constructors:
///
/// ```
/// use sinew_tools::Convex;
///
/// let tip = Convex::capsule(0.002, 0.03)?;
/// assert!(matches!(tip, Convex::Capsule { radius, .. } if radius == 0.002));
/// # Ok::<(), sinew_tools::ShapeError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Convex {
    /// A sphere about the origin.
    #[non_exhaustive]
    Sphere {
        /// The radius (m).
        radius: f64,
    },
    /// A cylinder along z with a half sphere at each end, centred at the origin.
    #[non_exhaustive]
    Capsule {
        /// The radius of the cylinder and of its ends (m).
        radius: f64,
        /// The length of the cylinder (m): the distance between the centres of the half spheres. From tip to tip
        /// the capsule is longer by two radii.
        length: f64,
    },
    /// The plane z = 0: all z < 0 is inside, tissue is on the side of z > 0.
    Plane,
    /// A cuboid along the axes, centred at the origin.
    #[non_exhaustive]
    Cuboid {
        /// The lengths of its edges (m).
        size: [f64; 3],
    },
}

/// Distance up to which a point counts as on the surface, as a share of the shape's size.
///
/// It is far above the rounding of a point that a contact has moved there, and far below any visible length.
const ON_SURFACE: f64 = 1e-12;

impl Convex {
    /// A sphere.
    ///
    /// # Errors
    ///
    /// A radius that is not a finite length above 0.
    pub fn sphere(radius: f64) -> Result<Self, ShapeError> {
        Ok(Self::Sphere {
            radius: checked_radius(radius)?,
        })
    }

    /// A capsule of this `length` (m) between the centres of its half spheres.
    ///
    /// # Errors
    ///
    /// A radius that is not a finite length above 0, or a length that is negative or not finite.
    pub fn capsule(radius: f64, length: f64) -> Result<Self, ShapeError> {
        let radius = checked_radius(radius)?;
        if !length.is_finite() || length < 0.0 {
            return Err(ShapeError::Length(length));
        }
        Ok(Self::Capsule { radius, length })
    }

    /// The edge of a blade: a segment along z of this `length` (m), centred at the origin, without any thickness.
    ///
    /// # Errors
    ///
    /// A length that is not finite and above 0.
    pub fn edge(length: f64) -> Result<Self, ShapeError> {
        if !is_length(length) {
            return Err(ShapeError::Blade(length));
        }
        Ok(Self::Capsule {
            radius: 0.0,
            length,
        })
    }

    /// A cuboid with edges of these lengths (m).
    ///
    /// # Errors
    ///
    /// A length that is not finite and above 0.
    pub fn cuboid(size: [f64; 3]) -> Result<Self, ShapeError> {
        let bad = (0..3).find(|axis| !is_length(size[*axis]));
        if let Some(axis) = bad {
            let length = size[axis];
            return Err(ShapeError::Edge { axis, length });
        }
        Ok(Self::Cuboid { size })
    }

    /// The point of the surface that is nearest to a point (m), and its normal.
    ///
    /// If several are nearest, one is returned: above the centre of a sphere, along x from the axis of a capsule, on the
    /// first of the nearest faces inside a cuboid. Outside a cuboid the normal is the direction from the nearest point, also
    /// at edges and corners.
    #[must_use]
    pub fn nearest(&self, point: [f64; 3]) -> Nearest {
        match *self {
            Self::Sphere { radius } => sphere::nearest(point, radius, [0.0, 0.0, 1.0]),
            Self::Capsule { radius, length } => capsule::nearest(point, radius, length / 2.0),
            Self::Plane => plane::nearest(point),
            Self::Cuboid { size } => cuboid::nearest(point, scaled(size, 0.5)),
        }
    }

    /// The first contact of a point that moves straight from `from` to `to` (m).
    ///
    /// A point that begins inside is in contact immediately, with the nearest point of the surface. A point that begins
    /// outside, or on the surface, is in contact when it enters. It is not in contact if it only touches, slides or
    /// moves away. At an edge or corner of a cuboid the normal is that of a face which the motion opposes.
    #[must_use]
    pub fn first_contact(&self, from: [f64; 3], to: [f64; 3]) -> Option<Touch> {
        let nearest = self.nearest(from);
        if nearest.distance < 0.0 {
            return Some(Touch::at_once(&nearest));
        }
        let motion = sub(to, from);
        // The distance is convex along a line: one that does not fall at first never falls.
        let is_approach = dot(nearest.normal, motion) < 0.0;
        if nearest.distance > 0.0 && !is_approach {
            return None;
        }
        // Nor does it fall by more than the way. What is on the surface is in contact however little it moves.
        let on_surface = ON_SURFACE * 2.0 * self.reach().unwrap_or(0.0);
        if nearest.distance > length(motion) + on_surface {
            return None;
        }
        let is_on = |size: f64| nearest.distance <= ON_SURFACE * size;
        let touch = match *self {
            Self::Sphere { radius } | Self::Capsule { radius, .. } if is_on(radius) => {
                is_approach.then(|| Touch::at_once(&nearest))
            }
            Self::Sphere { radius } => sphere::first_contact(from, motion, radius),
            Self::Capsule { radius, length } => {
                capsule::first_contact(from, motion, radius, length / 2.0)
            }
            Self::Plane => plane::first_contact(from, motion),
            Self::Cuboid { size } => {
                let tolerance = ON_SURFACE * length(size);
                cuboid::first_contact(from, motion, scaled(size, 0.5), tolerance)
            }
        };
        touch.filter(|touch| touch.share <= 1.0)
    }

    /// The radius (m) of a ball about the own origin that contains the shape; none for a plane.
    #[must_use]
    pub fn reach(&self) -> Option<f64> {
        match *self {
            Self::Sphere { radius } => Some(radius),
            Self::Capsule { radius, length } => Some(radius + length / 2.0),
            Self::Plane => None,
            Self::Cuboid { size } => Some(length(size) / 2.0),
        }
    }

    /// The smallest radius of curvature (m) of a round shape; none for shapes with flat faces.
    #[must_use]
    pub(crate) fn smallest_radius(&self) -> Option<f64> {
        match *self {
            Self::Sphere { radius } | Self::Capsule { radius, .. } => Some(radius),
            Self::Plane | Self::Cuboid { .. } => None,
        }
    }

    /// Half the smallest width (m) of the shape's projection along a direction in its own frame: it cannot pass in that
    /// direction between nodes that are nearer to each other. Infinite for a plane.
    ///
    /// The width of a cuboid with half edges a_i along e, across d, is `sum a_i |e_i|`; between its kinks this is a
    /// positive sine, so the minimum is at a kink, with e perpendicular to d and to an edge.
    #[must_use]
    pub fn half_width_across(&self, direction: [f64; 3]) -> f64 {
        let Self::Cuboid { size } = *self else {
            return self.half_width();
        };
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let half_widths = axes.into_iter().filter_map(|axis| {
            let across = cross(direction, axis);
            let size_of_it = length(across);
            // Along an edge all directions across are those of the other two.
            (size_of_it > 1e-9 * length(direction)).then(|| {
                let half_width = (0..3).map(|x| size[x] / 2.0 * across[x].abs());
                half_width.sum::<f64>() / size_of_it
            })
        });
        let least = half_widths.fold(f64::INFINITY, f64::min);
        if least.is_finite() {
            least
        } else {
            self.half_width()
        }
    }

    /// Half the smallest width (m): the radius of a round shape, or half the smallest edge of a cuboid; infinite for a plane.
    #[must_use]
    pub fn half_width(&self) -> f64 {
        match *self {
            Self::Sphere { radius } | Self::Capsule { radius, .. } => radius,
            Self::Plane => f64::INFINITY,
            Self::Cuboid { size } => size.into_iter().fold(f64::INFINITY, f64::min) / 2.0,
        }
    }
}

fn checked_radius(radius: f64) -> Result<f64, ShapeError> {
    if is_length(radius) {
        Ok(radius)
    } else {
        Err(ShapeError::Radius(radius))
    }
}

fn is_length(value: f64) -> bool {
    value.is_finite() && value > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_that_are_no_lengths_are_refused_by_name() {
        let said = |result: Result<Convex, ShapeError>| result.unwrap_err().to_string();
        for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(Convex::sphere(radius).is_err(), "{radius}");
        }
        assert_eq!(
            said(Convex::sphere(-0.5)),
            "radius = -0.5 m: expected a finite length above 0"
        );
        assert_eq!(
            said(Convex::capsule(0.0, 1.0)),
            "radius = 0 m: expected a finite length above 0"
        );
        assert_eq!(
            said(Convex::capsule(1.0, -0.1)),
            "length = -0.1 m: expected a finite length of at least 0"
        );
        assert!(Convex::capsule(1.0, 0.0).is_ok());
        assert_eq!(
            said(Convex::cuboid([1.0, 0.0, 1.0])),
            "the edge along y is 0 m: expected a finite length above 0"
        );
    }

    #[test]
    fn half_a_cuboid_is_as_wide_across_a_direction_as_half_its_shadow() {
        let plate = Convex::cuboid([0.2, 0.3, 0.01]).unwrap();
        assert!((plate.half_width_across([0.0, 0.0, -2.0]) - 0.1).abs() < 1e-15);
        assert!((plate.half_width_across([1.0, 0.0, 0.0]) - 0.005).abs() < 1e-15);
        assert_eq!(plate.half_width_across([0.0; 3]), 0.005);
        assert_eq!(Convex::Plane.half_width_across([1.0; 3]), f64::INFINITY);
        assert_eq!(
            Convex::sphere(0.1).unwrap().half_width_across([1.0; 3]),
            0.1
        );
        // The least over all directions across, by testing many.
        for direction in [[1.0, 2.0, 3.0], [-0.1, 0.3, 0.02], [1.0, 1.0, 0.0]] {
            let first = cross(direction, [0.3, -0.5, 0.8]);
            let first = scaled(first, 1.0 / length(first));
            let second = cross(direction, first);
            let second = scaled(second, 1.0 / length(second));
            let least = (0..20_000).map(|n| {
                let (sin, cos) = (f64::from(n) * 1e-4 * std::f64::consts::PI).sin_cos();
                let half = [0.1, 0.15, 0.005];
                (0..3)
                    .map(|x| half[x] * (cos * first[x] + sin * second[x]).abs())
                    .sum::<f64>()
            });
            let least = least.fold(f64::INFINITY, f64::min);
            assert!((plate.half_width_across(direction) - least).abs() < 1e-4);
        }
    }

    #[test]
    fn the_centre_of_a_sphere_has_a_normal() {
        let nearest = Convex::sphere(0.1).unwrap().nearest([0.0; 3]);
        assert_eq!(nearest.distance, -0.1);
        assert_eq!(nearest.point, [0.0, 0.0, 0.1]);
        assert_eq!(nearest.normal, [0.0, 0.0, 1.0]);
    }

    #[test]
    fn a_plane_is_entered_from_above_only() {
        let plane = Convex::Plane;
        let touch = plane
            .first_contact([1.0, 2.0, 0.3], [2.0, 2.0, -0.1])
            .unwrap();
        assert!((touch.share - 0.75).abs() < 1e-15);
        assert_eq!(touch.normal, [0.0, 0.0, 1.0]);
        assert!((touch.point[0] - 1.75).abs() < 1e-15);
        assert_eq!(touch.point[2], 0.0);
        assert_eq!(plane.first_contact([0.0, 0.0, 0.3], [0.0, 0.0, 0.1]), None);
        assert_eq!(plane.first_contact([0.0; 3], [1.0, 0.0, 0.0]), None);
        let from_below = plane
            .first_contact([0.0, 0.0, -0.1], [0.0, 0.0, 0.1])
            .unwrap();
        assert_eq!(from_below.share, 0.0);
    }

    #[test]
    fn balls_of_reach_and_smallest_radii_are_those_of_the_shapes() {
        let shapes = [
            (Convex::sphere(0.3).unwrap(), Some(0.3), Some(0.3)),
            (Convex::capsule(0.3, 1.0).unwrap(), Some(0.8), Some(0.3)),
            (Convex::Plane, None, None),
            (Convex::cuboid([2.0, 4.0, 4.0]).unwrap(), Some(3.0), None),
        ];
        for (convex, reach, smallest) in shapes {
            assert_eq!(
                (convex.reach(), convex.smallest_radius()),
                (reach, smallest)
            );
        }
    }
}
