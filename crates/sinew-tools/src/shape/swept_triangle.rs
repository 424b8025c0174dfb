//! The first contact of a moving triangle with a shape.

use super::hull::{Hull, Triangle, doubled_area};
use crate::vector::{Vector, add, between, dot, scaled, sub};

/// Gap, as a share of a hull's radius, below which a triangle touches it.
const TOUCHES: f64 = 1e-9;

/// Least depth, as a share of a hull's radius, at which a triangle that is in contact elsewhere gets another contact.
/// Contacts much closer together would be nearly the same, with indeterminate forces.
const OVERLAPS: f64 = 0.1;

/// Depth, as a share of a hull's radius, up to which a triangle is pushed out for any size of its motion.
const LEFT: f64 = 1e-3;

/// Largest number of advances towards a first contact; a triangle that is still approaching then counts as touching.
const MOST_ADVANCES: usize = 200;

/// The contact of a triangle with a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TriangleTouch {
    /// The share of the motion at the contact (0 to 1).
    pub(crate) share: f64,
    /// Weights of its corners at the point of contact.
    pub(crate) weights: Vector,
    /// The point on the surface of the shape (m), in its own frame.
    pub(crate) point: Vector,
    /// The outward unit normal of the shape there.
    pub(crate) normal: Vector,
}

impl Hull {
    /// The first contact with a triangle whose corners move along straight lines from one position to another (m), from
    /// its outer side.
    ///
    /// Method: conservative advancement. The nearest points define a plane between triangle and core. No corner can be
    /// in contact before the corner that approaches the plane fastest is as near as the radius.
    pub(crate) fn first_contact(&self, from: &Triangle, to: &Triangle) -> Option<TriangleTouch> {
        let motion = [0, 1, 2].map(|corner| sub(to[corner], from[corner]));
        let mut share = 0.0;
        for advance in 0.. {
            let now = [0, 1, 2].map(|corner| between(from[corner], to[corner], share));
            let (gap, touch) = self.look(&now)?;
            let touch = TriangleTouch { share, ..touch };
            // Towards the shape.
            let speeds = motion.map(|motion| -dot(touch.normal, motion));
            let fastest = speeds.into_iter().fold(0.0, f64::max);
            if gap < -TOUCHES * self.radius {
                return Some(touch);
            }
            if fastest == 0.0 {
                return None;
            }
            if gap <= TOUCHES * self.radius || advance == MOST_ADVANCES {
                return Some(touch);
            }
            share += gap / fastest;
            if share > 1.0 {
                return None;
            }
        }
        None
    }

    /// The contact with a triangle that is deep in the shape (m), its radius included; contacts that are less deep are
    /// found by the next step.
    pub(crate) fn overlap(&self, triangle: &Triangle) -> Option<TriangleTouch> {
        let (gap, touch) = self.look(triangle)?;
        (gap < -OVERLAPS * self.radius).then_some(touch)
    }

    /// The depth (m) beyond which a triangle cannot have been left in contact by the step before, if both steps move it
    /// `way` (m) against the shape: twice the depth of another contact, but no deeper than it can have moved.
    pub(crate) fn left(&self, way: f64) -> f64 {
        (2.0 * OVERLAPS * self.radius).min(way + LEFT * self.radius)
    }

    /// The gap (m) to a triangle from its outer side, and the nearest points.
    pub(crate) fn look(&self, triangle: &Triangle) -> Option<(f64, TriangleTouch)> {
        let outward = doubled_area(triangle);
        let size = dot(outward, outward).sqrt();
        let found = self.nearest(triangle);
        let normal = if found.distance > TOUCHES * self.radius {
            scaled(sub(found.on_triangle, found.on_core), 1.0 / found.distance)
        } else if size > 0.0 {
            scaled(outward, -1.0 / size)
        } else {
            return None;
        };
        let is_outside = dot(normal, outward) <= 0.0;
        let touch = TriangleTouch {
            share: 0.0,
            weights: found.weights,
            point: add(found.on_core, scaled(normal, self.radius)),
            normal,
        };
        is_outside.then_some((found.distance - self.radius, touch))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Convex;
    use crate::vector::length;

    /// A number from -1 to 1 from a simple generator.
    fn random(seed: &mut u64) -> f64 {
        *seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn point(seed: &mut u64) -> Vector {
        [0; 3].map(|_: i32| random(seed))
    }

    /// A large triangle that comes down on a ball has contact at the ball's top, after the share of the motion that
    /// follows from its height.
    #[test]
    fn a_triangle_that_comes_down_on_a_ball_meets_its_top() {
        let ball = Hull::of(&Convex::sphere(0.01).unwrap()).unwrap();
        let at = |z: f64| [[0.0, 0.3, z], [0.3, -0.3, z], [-0.3, -0.3, z]];
        let touch = ball.first_contact(&at(0.05), &at(-0.15)).unwrap();
        assert!((touch.share - 0.2).abs() < 1e-12, "{}", touch.share);
        assert!(length(sub(touch.normal, [0.0, 0.0, 1.0])) < 1e-12);
        assert!(length(sub(touch.point, [0.0, 0.0, 0.01])) < 1e-12);
        let [a, b, c] = touch.weights;
        assert!((a - 0.5).abs() < 1e-12 && (b - 0.25).abs() < 1e-12 && (c - 0.25).abs() < 1e-12);
        assert_eq!(ball.first_contact(&at(0.05), &at(0.011)), None);
        // From behind it is not met.
        assert_eq!(ball.first_contact(&at(-0.05), &at(0.15)), None);
    }

    /// The triangle is outside before the first contact, touches at the contact, and is outside at all times if there
    /// is none.
    #[test]
    fn nothing_is_met_too_late_or_too_early() {
        let shapes = [
            Convex::sphere(0.1).unwrap(),
            Convex::capsule(0.05, 0.4).unwrap(),
            Convex::cuboid([0.2, 0.3, 0.4]).unwrap(),
        ];
        let (mut seed, mut met) = (7, 0);
        for shape in shapes {
            let hull = Hull::of(&shape).unwrap();
            for _ in 0..400 {
                let from = [0; 3].map(|_: i32| add(point(&mut seed), [0.0, 0.0, -1.4]));
                let to = [0; 3].map(|_: i32| add(point(&mut seed), [0.0, 0.0, 1.0]));
                let outside = |share: f64| {
                    let now = [0, 1, 2].map(|corner| between(from[corner], to[corner], share));
                    hull.nearest(&now).distance - hull.radius
                };
                if doubled_area(&from)[2] < 0.0 || outside(0.0) <= 0.0 {
                    continue;
                }
                let touch = hull.first_contact(&from, &to);
                let end = touch.map_or(1.0, |touch| touch.share);
                if touch.is_some() {
                    met += 1;
                    assert!(outside(end).abs() < 1e-8);
                } else if (0..=200).any(|n| {
                    let share = f64::from(n) / 200.0;
                    let now = [0, 1, 2].map(|corner| between(from[corner], to[corner], share));
                    hull.look(&now).is_none()
                }) {
                    // Seen from behind at some time.
                    continue;
                }
                for n in 0..200 {
                    let gap = outside(end * f64::from(n) / 200.0);
                    assert!(gap > -1e-9, "{shape:?} {from:?} {to:?}: {gap}");
                }
            }
        }
        assert!(met > 100, "{met}");
    }
}
