//! The boundary with its own points.

use super::TetMesh;

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
        let boundary = self.boundary(None);
        let mut nodes: Vec<u32> = boundary.iter().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let place = |node: &u32| nodes.binary_search(node).unwrap_or_default() as u32;
        let triangles = boundary
            .iter()
            .map(|triangle| triangle.each_ref().map(place));
        BoundarySurface {
            triangles: triangles.collect(),
            points: nodes
                .iter()
                .map(|node| self.points[*node as usize])
                .collect(),
            nodes,
        }
    }
}
