//! Shapes as the set of points within a radius of a point, a rod or a box, and their distances from triangles.

use super::convex::Convex;
use crate::segments::nearest_of_segments;
use crate::triangle::nearest_of_triangle;
use crate::vector::{Vector, add, between, cross, dot, length, scaled, sub};

/// A triangle by its corners (m), counter-clockwise as seen from outside of the body.
pub(crate) type Triangle = [Vector; 3];

/// Share of half the smallest edge of a cuboid by which its edges are rounded for triangles.
const ROUNDED: f64 = 0.05;

/// The edges of a cuboid, given by its corners; the bits of a corner are its signs along x, y and z.
const EDGES_OF_CUBOID: [[usize; 2]; 12] = [
    [0, 1],
    [2, 3],
    [4, 5],
    [6, 7],
    [0, 2],
    [1, 3],
    [4, 6],
    [5, 7],
    [0, 4],
    [1, 5],
    [2, 6],
    [3, 7],
];

/// The set of points within a radius of a point, a rod along z or a box along the axes, about the origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hull {
    /// Half the sizes (m) of the core.
    half: Vector,
    core: Core,
    pub(crate) radius: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Core {
    Point,
    Rod,
    Box,
}

/// The points of a triangle and of a core that are nearest to each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearestPair {
    /// Their distance (m).
    pub(crate) distance: f64,
    /// Weights of the corners of the triangle.
    pub(crate) weights: Vector,
    /// The point of the triangle (m).
    pub(crate) on_triangle: Vector,
    /// The point of the core (m).
    pub(crate) on_core: Vector,
}

impl Hull {
    /// The hull of a shape, with slightly rounded edges; `None` for a plane.
    pub(crate) fn of(convex: &Convex) -> Option<Self> {
        match *convex {
            Convex::Sphere { radius } => Some(Self {
                half: [0.0; 3],
                core: Core::Point,
                radius,
            }),
            Convex::Capsule { radius, length } => Some(Self {
                half: [0.0, 0.0, length / 2.0],
                core: Core::Rod,
                radius,
            }),
            Convex::Plane => None,
            Convex::Cuboid { size } => {
                let radius = ROUNDED * convex.half_width();
                Some(Self {
                    half: size.map(|edge| edge / 2.0 - radius),
                    core: Core::Box,
                    radius,
                })
            }
        }
    }

    fn corner(&self, number: usize) -> Vector {
        [0, 1, 2].map(|axis| {
            if number >> axis & 1 == 1 {
                self.half[axis]
            } else {
                -self.half[axis]
            }
        })
    }

    /// The parameter of a segment at the middle of its part in the box, if it passes through it.
    fn passage(&self, [from, to]: [Vector; 2]) -> Option<f64> {
        let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
        for axis in 0..3 {
            let (place, motion, half) = (from[axis], to[axis] - from[axis], self.half[axis]);
            if motion == 0.0 {
                if place.abs() > half {
                    return None;
                }
                continue;
            }
            let at = |face: f64| (face - place) / motion;
            enters = enters.max(at(-half).min(at(half)));
            leaves = leaves.min(at(-half).max(at(half)));
        }
        (enters < leaves).then_some(0.5 * (enters + leaves))
    }

    /// The nearest points of a triangle and the core, which may be the same.
    pub(crate) fn nearest(&self, triangle: &Triangle) -> NearestPair {
        let mut best = NearestPair {
            distance: f64::INFINITY,
            weights: [1.0, 0.0, 0.0],
            on_triangle: triangle[0],
            on_core: [0.0; 3],
        };
        match self.core {
            Core::Point => best.take_point(triangle, [0.0; 3]),
            Core::Rod => {
                let ends = [scaled(self.half, -1.0), self.half];
                ends.into_iter()
                    .for_each(|end| best.take_point(triangle, end));
                best.take_edge(triangle, ends);
            }
            Core::Box => {
                for corner in 0..8 {
                    best.take_point(triangle, self.corner(corner));
                }
                for edge in EDGES_OF_CUBOID {
                    best.take_edge(triangle, edge.map(|corner| self.corner(corner)));
                }
                for (corner, at) in triangle.iter().enumerate() {
                    let half = self.half;
                    let on_core = [0, 1, 2].map(|axis| at[axis].clamp(-half[axis], half[axis]));
                    let mut weights = [0.0; 3];
                    weights[corner] = 1.0;
                    best.take(triangle, weights, on_core);
                }
                for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                    if let Some(along) = self.passage([triangle[a], triangle[b]]) {
                        let mut weights = [0.0; 3];
                        (weights[a], weights[b]) = (1.0 - along, along);
                        best.take(triangle, weights, weighted(triangle, weights));
                    }
                }
            }
        }
        best
    }
}

impl NearestPair {
    fn take(&mut self, triangle: &Triangle, weights: Vector, on_core: Vector) {
        let on_triangle = weighted(triangle, weights);
        let distance = length(sub(on_core, on_triangle));
        if distance < self.distance {
            *self = Self {
                distance,
                weights,
                on_triangle,
                on_core,
            };
        }
    }

    /// Takes a point of the core.
    fn take_point(&mut self, triangle: &Triangle, point: Vector) {
        self.take(triangle, nearest_of_triangle(triangle, point), point);
    }

    /// Considers the inner points of an edge of the core: those nearest to the edges of the triangle, and its
    /// intersection.
    fn take_edge(&mut self, triangle: &Triangle, [from, to]: [Vector; 2]) {
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            let (along, across) = nearest_of_segments([triangle[a], triangle[b]], [from, to]);
            let mut weights = [0.0; 3];
            (weights[a], weights[b]) = (1.0 - along, along);
            self.take(triangle, weights, between(from, to, across));
        }
        if let Some(point) = crossing(triangle, [from, to]) {
            self.take(triangle, nearest_of_triangle(triangle, point), point);
        }
    }
}

/// The point of a triangle with these weights of its corners.
pub(crate) fn weighted(triangle: &Triangle, weights: Vector) -> Vector {
    let [a, b, c] = *triangle;
    add(
        add(scaled(a, weights[0]), scaled(b, weights[1])),
        scaled(c, weights[2]),
    )
}

/// The outward normal of a triangle, times twice its area.
pub(crate) fn doubled_area(triangle: &Triangle) -> Vector {
    let [a, b, c] = *triangle;
    cross(sub(b, a), sub(c, a))
}

/// Intersection of a segment with a triangle.
fn crossing(triangle: &Triangle, [from, to]: [Vector; 2]) -> Option<Vector> {
    let normal = doubled_area(triangle);
    let heights = [from, to].map(|end| dot(normal, sub(end, triangle[0])));
    if heights[0] * heights[1] >= 0.0 {
        return None;
    }
    let point = between(from, to, heights[0] / (heights[0] - heights[1]));
    let is_inside = |(a, b): (usize, usize)| {
        let edge = sub(triangle[b], triangle[a]);
        dot(normal, cross(edge, sub(point, triangle[a]))) >= 0.0
    };
    [(0, 1), (1, 2), (2, 0)]
        .into_iter()
        .all(is_inside)
        .then_some(point)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number from 0 to 1 from a simple generator.
    fn random(seed: &mut u64) -> f64 {
        *seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (*seed >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn point(seed: &mut u64) -> Vector {
        [0; 3].map(|_: i32| 2.0 * random(seed) - 1.0)
    }

    #[test]
    fn no_pair_of_points_is_nearer_than_the_nearest() {
        let shapes = [
            Convex::sphere(0.1).unwrap(),
            Convex::capsule(0.1, 0.8).unwrap(),
            Convex::cuboid([0.3, 0.5, 0.7]).unwrap(),
        ];
        let mut seed = 3;
        for shape in shapes {
            let hull = Hull::of(&shape).unwrap();
            for _ in 0..300 {
                let triangle = [0; 3].map(|_: i32| point(&mut seed));
                let found = hull.nearest(&triangle);
                let there = weighted(&triangle, found.weights);
                assert!(length(sub(there, found.on_triangle)) < 1e-14);
                assert!((found.weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
                assert!(found.weights.iter().all(|weight| *weight >= 0.0));
                let mut pairs = found.on_core.iter().zip(hull.half);
                let is_in_core = pairs.all(|(x, half)| x.abs() <= half + 1e-14);
                assert!(is_in_core, "{shape:?} {triangle:?} {:?}", found.on_core);
                let apart = length(sub(found.on_triangle, found.on_core));
                assert!(
                    (apart - found.distance).abs() < 1e-14,
                    "{shape:?} {triangle:?}"
                );
                for _ in 0..300 {
                    let (a, b) = (random(&mut seed), random(&mut seed));
                    let (a, b) = if a + b > 1.0 {
                        (1.0 - a, 1.0 - b)
                    } else {
                        (a, b)
                    };
                    let other = weighted(&triangle, [1.0 - a - b, a, b]);
                    let core = point(&mut seed);
                    let core = [0, 1, 2].map(|axis| core[axis] * hull.half[axis]);
                    let distance = length(sub(other, core));
                    assert!(distance > found.distance - 1e-14, "{shape:?} {triangle:?}");
                }
            }
        }
    }

    #[test]
    fn a_triangle_above_a_shape_is_at_its_height() {
        let triangle = [[-1.0, -1.0, 0.5], [2.0, -1.0, 0.5], [-1.0, 2.0, 0.5]];
        for (shape, expected) in [
            (Convex::sphere(0.1).unwrap(), 0.4),
            (Convex::capsule(0.1, 0.4).unwrap(), 0.2),
            (Convex::cuboid([0.2, 0.2, 0.6]).unwrap(), 0.2),
        ] {
            let hull = Hull::of(&shape).unwrap();
            let found = hull.nearest(&triangle);
            assert!((found.distance - hull.radius - expected).abs() < 1e-15);
        }
        let through = Hull::of(&Convex::capsule(0.1, 1.4).unwrap()).unwrap();
        assert_eq!(through.nearest(&triangle).distance, 0.0);
        assert!(Hull::of(&Convex::Plane).is_none());
    }
}
