//! The boundary with its own points.

use super::TetMesh;
use super::surface::OUTWARD_FACES;

/// The boundary of a body with its own points, for drawing and writing it without inner nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundarySurface {
    /// Node of the mesh (0-based) of each point, increasing.
    pub nodes: Vec<u32>,
    /// Position (m) of each point.
    pub points: Vec<[f64; 3]>,
    /// Outward triangles between points.
    pub triangles: Vec<[u32; 3]>,
}

impl TetMesh {
    /// The triangles of [`TetMesh::boundary`] of the whole mesh, in its order, with the nodes on them only.
    #[must_use]
    pub fn boundary_surface(&self) -> BoundarySurface {
        self.surface_of(self.boundary(None))
    }

    /// Same as [`TetMesh::boundary_surface`], for a mesh of tetrahedra with positive volumes whose outer faces are known:
    /// each by its tetrahedron (0-based) and the vertex (0 to 3) opposite, in increasing order. A face that is given on
    /// both sides with the same nodes is inside, and left out.
    ///
    /// ```
    /// use sinew_mesh::structured::{self, Split};
    /// let cube = structured::cube(1, 0.1, Split::Kuhn)?;
    /// let surface = cube.boundary_surface();
    /// let of_tet = |tet: u32| (0..4).map(move |vertex| (tet, vertex));
    /// let is_outer = |&(tet, vertex): &(u32, usize)| {
    ///     let nodes = cube.tets[tet as usize];
    ///     surface.triangles.iter().any(|triangle| {
    ///         let node = |point: &u32| surface.nodes[*point as usize];
    ///         triangle.iter().map(node).all(|node| node != nodes[vertex] && nodes.contains(&node))
    ///     })
    /// };
    /// let faces = (0..6).flat_map(of_tet).filter(is_outer);
    /// assert_eq!(cube.surface_of_faces(faces), surface);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Panics
    ///
    /// If there is no such tetrahedron or vertex.
    #[must_use]
    pub fn surface_of_faces(
        &self,
        faces: impl IntoIterator<Item = (u32, usize)>,
    ) -> BoundarySurface {
        let face = |(tet, vertex): (u32, usize)| {
            let nodes = self.tets[tet as usize];
            OUTWARD_FACES[vertex].map(|corner| nodes[corner])
        };
        let mut faces: Vec<[u32; 3]> = faces.into_iter().map(face).collect();
        let key = |face: &[u32; 3]| {
            let mut key = *face;
            key.sort_unstable();
            key
        };
        let mut keys: Vec<[u32; 3]> = faces.iter().map(key).collect();
        keys.sort_unstable();
        let twice = keys.windows(2).filter(|pair| pair[0] == pair[1]);
        let twice: Vec<[u32; 3]> = twice.map(|pair| pair[0]).collect();
        if !twice.is_empty() {
            faces.retain(|face| twice.binary_search(&key(face)).is_err());
        }
        self.surface_of(faces)
    }

    /// Triangles between nodes, with the nodes on them only.
    fn surface_of(&self, mut triangles: Vec<[u32; 3]>) -> BoundarySurface {
        const NONE: u32 = u32::MAX;
        let mut place = vec![NONE; self.points.len()];
        for node in triangles.as_flattened() {
            place[*node as usize] = 0;
        }
        let mut nodes = Vec::new();
        for (node, place) in (0..).zip(&mut place) {
            if *place != NONE {
                *place = nodes.len() as u32;
                nodes.push(node);
            }
        }
        for node in triangles.as_flattened_mut() {
            *node = place[*node as usize];
        }
        BoundarySurface {
            triangles,
            points: nodes
                .iter()
                .map(|node| self.points[*node as usize])
                .collect(),
            nodes,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::structured::{Split, block};

    #[test]
    fn a_face_that_is_parted_without_an_edge_of_its_own_is_inside() {
        let mesh = block([2, 1, 1], [0.2, 0.1, 0.1], Split::Kuhn).expect("valid");
        let surface = mesh.boundary_surface();
        // All faces: those inside are there twice.
        let all =
            (0..mesh.tets.len() as u32).flat_map(|tet| (0..4).map(move |vertex| (tet, vertex)));
        assert_eq!(mesh.surface_of_faces(all), surface);
    }
}
