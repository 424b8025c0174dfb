//! The surface of a body.

use std::collections::HashSet;
use std::ops::Deref;

use sinew_mesh::{BoundarySurface, TetMesh};
use sinew_scene::BodyModel;
use sinew_tools::vector::{add, cross, dot, length, scaled, sub};
use sinew_tools::{Convex, Pose, Shape, nearest_of_triangle};

use crate::protocol::NONE;

/// The surface of a body at rest.
#[derive(Debug)]
pub(crate) struct Surface {
    boundary: BoundarySurface,
    /// Number of triangles, the first ones, that belong to the body before all cuts.
    pub(crate) outer: usize,
    /// The point of each node of the mesh, or [`NONE`].
    point_of: Vec<u32>,
}

impl Deref for Surface {
    type Target = BoundarySurface;

    fn deref(&self) -> &BoundarySurface {
        &self.boundary
    }
}

impl Surface {
    /// The surface of a body without cuts.
    pub(crate) fn of(mesh: &TetMesh) -> Self {
        let boundary = mesh.boundary_surface();
        let outer = boundary.triangles.len();
        let mut point_of = vec![NONE; mesh.points.len()];
        for (point, node) in (0..).zip(&boundary.nodes) {
            point_of[*node as usize] = point;
        }
        Self {
            boundary,
            outer,
            point_of,
        }
    }

    /// The mean length (m) of the edges of its triangles at rest.
    pub(crate) fn mean_edge(&self) -> f64 {
        let edges = self
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let lengths = edges.map(|edge| {
            let [from, to] = edge.map(|point| self.points[point as usize]);
            length(sub(to, from))
        });
        lengths.sum::<f64>() / (3 * self.triangles.len()).max(1) as f64
    }

    /// The point of a node of the mesh, if it lies on the surface.
    pub(crate) fn point_of(&self, node: u32) -> Option<usize> {
        let point = self.point_of.get(node as usize);
        point
            .filter(|point| **point != NONE)
            .map(|point| *point as usize)
    }

    /// The surface of a body after cuts; `self` was its surface before all cuts.
    pub(crate) fn after_cuts(&self, body: &BodyModel) -> Self {
        let mut after = Self::of(&body.mesh);
        let Some(from) = &body.cut else {
            return after;
        };
        let by_node = |triangle: &[u32; 3], node: &dyn Fn(u32) -> u32| {
            let mut nodes = triangle.map(node);
            nodes.sort_unstable();
            nodes
        };
        let whole = |point: u32| self.nodes[point as usize];
        let whole = self.triangles.iter().map(|face| by_node(face, &whole));
        let whole: HashSet<[u32; 3]> = whole.collect();
        let BoundarySurface {
            nodes, triangles, ..
        } = &mut after.boundary;
        let origin = |point: u32| from.cut.origins[nodes[point as usize] as usize];
        // In their order: those of the body first.
        triangles.sort_by_key(|face| !whole.contains(&by_node(face, &origin)));
        after.outer = triangles.partition_point(|face| whole.contains(&by_node(face, &origin)));
        after
    }

    /// Depth (m) of a tool in the body at rest, negative before it touches: the depth of an indentation.
    ///
    /// The depth of a ball is measured to the triangles, so that it does not depend on the positions of nodes; that of
    /// other shapes to the nodes.
    pub(crate) fn depth(&self, shape: &Shape, pose: &Pose) -> f64 {
        let parts = shape.parts().iter();
        let depths = parts.map(|part| match part.convex {
            Convex::Sphere { radius, .. } => {
                radius - self.distance(pose.then(&part.pose).position())
            }
            _ => {
                let own = Shape::of(part.convex);
                let pose = pose.then(&part.pose);
                let gaps = self.points.iter().map(|point| own.distance(&pose, *point));
                -gaps.fold(f64::INFINITY, f64::min)
            }
        });
        depths.fold(f64::NEG_INFINITY, f64::max)
    }

    /// The distance (m) of a position from the surface at rest, negative inside the body.
    fn distance(&self, place: [f64; 3]) -> f64 {
        let mut nearest = (f64::INFINITY, 1.0);
        for triangle in &self.triangles {
            let corners = triangle.map(|point| self.points[point as usize]);
            let weights = nearest_of_triangle(&corners, place);
            let weighted = corners.into_iter().zip(weights);
            let at = weighted.fold([0.0; 3], |sum, (corner, weight)| {
                add(sum, scaled(corner, weight))
            });
            let away = sub(place, at);
            let squared = dot(away, away);
            if squared < nearest.0 {
                let [a, b, c] = corners;
                let normal = cross(sub(b, a), sub(c, a));
                nearest = (squared, dot(away, normal));
            }
        }
        nearest.0.sqrt().copysign(nearest.1)
    }
}

#[cfg(test)]
mod tests {
    use sinew_mesh::structured::{Split, cube};

    use super::*;

    fn surface() -> Surface {
        Surface::of(&cube(4, 0.1, Split::Kuhn).unwrap())
    }

    #[test]
    fn a_ball_is_as_deep_as_it_stands_below_the_face_wherever_nodes_lie() {
        let surface = surface();
        let ball = Shape::of(Convex::sphere(0.01).unwrap());
        for (x, y) in [(0.05, 0.05), (0.0437, 0.0621), (0.03, 0.071)] {
            for depth in [-0.02, 0.0, 0.004, 0.015] {
                let pose = Pose::new([x, y, 0.11 - depth], [0.0; 3]);
                assert!((surface.depth(&ball, &pose) - depth).abs() < 1e-15);
            }
        }
        let plane = Shape::of(Convex::Plane);
        let upside_down = Pose::new([0.0, 0.0, 0.097], [std::f64::consts::PI, 0.0, 0.0]);
        assert!((surface.depth(&plane, &upside_down) - 0.003).abs() < 1e-12);
    }
}
