//! Surface triangles and their tetrahedra.

use std::collections::HashMap;

use super::TetMesh;
use crate::vector::{cross, dot, sub};

/// The faces of a tetrahedron, each opposite the node of the same index; their normals point outwards if the tetrahedron
/// is positively oriented.
pub(crate) const OUTWARD_FACES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// A triangle is not on the surface of the tetrahedra.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// No tetrahedron has the triangle as a face.
    #[error("triangle {index} with node tags {node_tags:?} is not a face of any tetrahedron")]
    NotAFace {
        /// Index of the triangle among those given.
        index: usize,
        /// The tags of its nodes (for a node that does not exist: its index plus one).
        node_tags: [u64; 3],
    },
    /// The triangle lies between tetrahedra, so that no direction points out.
    #[error(
        "triangle {index} with node tags {node_tags:?} lies inside the mesh, between the tetrahedra with tags \
         {tet_tags:?}; only a triangle on the outer surface has an outward normal"
    )]
    Interior {
        /// Index of the triangle among those given.
        index: usize,
        /// The tags of its nodes.
        node_tags: [u64; 3],
        /// The tags of the first two tetrahedra that have it as a face.
        tet_tags: [u64; 2],
    },
}

/// The tetrahedra at a face.
#[derive(Clone, Copy)]
struct Adjacent {
    tet: usize,
    /// Its node opposite the face.
    opposite: u32,
    second_tet: Option<usize>,
}

impl TetMesh {
    /// The given surface triangles, each turned so that its normal (counter-clockwise rule) points away from the only
    /// tetrahedron of which it is a face. The order is kept.
    ///
    /// # Errors
    ///
    /// If a triangle is not a face of a tetrahedron, or a face of more than one.
    pub fn outward_triangles(&self, triangles: &[[u32; 3]]) -> Result<Vec<[u32; 3]>, SurfaceError> {
        let faces = self.outward_faces(triangles)?;
        Ok(faces.into_iter().map(|(triangle, _)| triangle).collect())
    }

    /// The triangles of [`TetMesh::outward_triangles`], each with its tetrahedron (0-based).
    ///
    /// # Errors
    ///
    /// Same as [`TetMesh::outward_triangles`].
    pub fn outward_faces(
        &self,
        triangles: &[[u32; 3]],
    ) -> Result<Vec<([u32; 3], usize)>, SurfaceError> {
        let adjacent = self.tets_behind(triangles);
        let oriented = triangles.iter().enumerate().map(|(index, triangle)| {
            let node_tags = triangle.map(|node| self.node_tag(node));
            match adjacent.get(&sorted(*triangle)).copied().flatten() {
                None => Err(SurfaceError::NotAFace { index, node_tags }),
                Some(Adjacent {
                    tet,
                    second_tet: Some(second),
                    ..
                }) => {
                    let tet_tags = [self.tet_tag(tet), self.tet_tag(second)];
                    Err(SurfaceError::Interior {
                        index,
                        node_tags,
                        tet_tags,
                    })
                }
                Some(Adjacent { tet, opposite, .. }) => {
                    Ok((self.turned_outward(*triangle, tet, opposite), tet))
                }
            }
        });
        oriented.collect()
    }

    fn tets_behind(&self, triangles: &[[u32; 3]]) -> HashMap<[u32; 3], Option<Adjacent>> {
        let mut adjacent: HashMap<[u32; 3], Option<Adjacent>> = triangles
            .iter()
            .map(|&triangle| (sorted(triangle), None))
            .collect();
        // Most faces of a large mesh have a corner away from all triangles, and need no look-up.
        let mut is_corner = vec![false; self.points.len()];
        for &node in triangles.iter().flatten() {
            if let Some(is_corner) = is_corner.get_mut(node as usize) {
                *is_corner = true;
            }
        }
        for (tet, nodes) in self.tets.iter().enumerate() {
            let at_corner = nodes.map(|node| is_corner[node as usize]);
            for (&opposite, face) in nodes.iter().zip(OUTWARD_FACES) {
                if !face.into_iter().all(|i| at_corner[i]) {
                    continue;
                }
                let Some(entry) = adjacent.get_mut(&sorted(face.map(|i| nodes[i]))) else {
                    continue;
                };
                match entry {
                    None => {
                        *entry = Some(Adjacent {
                            tet,
                            opposite,
                            second_tet: None,
                        });
                    }
                    Some(first) => first.second_tet = first.second_tet.or(Some(tet)),
                }
            }
        }
        adjacent
    }

    /// The triangle with its normal away from the tetrahedron `tet`, whose node opposite the triangle is `opposite`.
    pub(super) fn turned_outward(&self, triangle: [u32; 3], tet: usize, opposite: u32) -> [u32; 3] {
        let [a, b, c] = triangle.map(|node| self.points[node as usize]);
        let inner = self.points[opposite as usize];
        let towards_inside = dot(cross(sub(b, a), sub(c, a)), sub(inner, a));
        let points_inward = if towards_inside == 0.0 {
            // A flat tetrahedron has no inside; go by its numbering, as if it were positively oriented.
            !self.is_outward_by_numbering(triangle, tet, opposite)
        } else {
            towards_inside > 0.0
        };
        let [a, b, c] = triangle;
        if points_inward { [a, c, b] } else { [a, b, c] }
    }

    fn is_outward_by_numbering(&self, triangle: [u32; 3], tet: usize, opposite: u32) -> bool {
        let nodes = self.tets[tet];
        let [a, b, c] = triangle;
        nodes.iter().zip(OUTWARD_FACES).any(|(&node, face)| {
            let face = face.map(|i| nodes[i]);
            node == opposite && [[a, b, c], [b, c, a], [c, a, b]].contains(&face)
        })
    }

    fn node_tag(&self, node: u32) -> u64 {
        let ordinal = u64::from(node) + 1;
        self.node_tags
            .get(node as usize)
            .copied()
            .unwrap_or(ordinal)
    }

    fn tet_tag(&self, tet: usize) -> u64 {
        self.tet_tags.get(tet).copied().unwrap_or(tet as u64 + 1)
    }
}

/// The nodes of a triangle in ascending order.
pub(super) fn sorted(mut triangle: [u32; 3]) -> [u32; 3] {
    triangle.sort_unstable();
    triangle
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two tetrahedra on either side of the triangle 0 1 2; the second is inverted.
    fn two_tets() -> TetMesh {
        let points = vec![
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -1.0],
        ];
        let mut mesh =
            TetMesh::new(points, vec![[0, 1, 2, 3], [0, 1, 2, 4]]).expect("indices are in range");
        mesh.node_tags = vec![10, 20, 30, 40, 50];
        mesh.tet_tags = vec![7, 9];
        mesh
    }

    fn normal(mesh: &TetMesh, triangle: [u32; 3]) -> [f64; 3] {
        let [a, b, c] = triangle.map(|node| mesh.points[node as usize]);
        cross(sub(b, a), sub(c, a))
    }

    #[test]
    fn both_windings_come_out_outward() {
        let mesh = two_tets();
        let given = [[0, 1, 3], [0, 3, 1], [0, 1, 4], [4, 1, 0]];
        let outward = mesh
            .outward_triangles(&given)
            .expect("all are on the surface");
        for (triangle, given) in outward.iter().zip(given) {
            assert_eq!(normal(&mesh, *triangle), [0.0, -1.0, 0.0], "{given:?}");
            assert_eq!(sorted(*triangle), sorted(given));
        }
    }

    #[test]
    fn the_faces_of_a_flat_tetrahedron_follow_its_numbering() {
        let mut mesh = two_tets();
        mesh.tets.truncate(1);
        mesh.points[3] = [1.0, 1.0, 0.0];
        let outward = mesh
            .outward_triangles(&[[0, 1, 2], [2, 1, 0]])
            .expect("it is a face");
        assert_eq!(outward, [[0, 2, 1], [2, 1, 0]]);
    }

    #[test]
    fn triangles_off_the_surface_are_named() {
        let mesh = two_tets();
        assert_eq!(
            mesh.outward_triangles(&[[0, 1, 3], [0, 3, 4]])
                .expect_err("crosses both")
                .to_string(),
            "triangle 1 with node tags [10, 40, 50] is not a face of any tetrahedron"
        );
        assert_eq!(
            mesh.outward_triangles(&[[2, 1, 0]])
                .expect_err("between the two")
                .to_string(),
            "triangle 0 with node tags [30, 20, 10] lies inside the mesh, between the tetrahedra with tags [7, 9]; only a triangle on the outer surface has an outward normal"
        );
        assert!(mesh.outward_triangles(&[[0, 1, 99]]).is_err());
    }
}
