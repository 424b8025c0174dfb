//! Counts of a mesh and of its refinements, computed before these are built.

use sinew_scene::BodyModel;

/// Counts of a mesh of tetrahedra.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Sizes {
    pub(super) nodes: usize,
    pub(super) edges: usize,
    pub(super) faces: usize,
    pub(super) tets: usize,
}

impl Sizes {
    pub(super) fn of(body: &BodyModel) -> Self {
        let report = body.model.report();
        let tets = body.mesh.tets.len();
        // A face inside belongs to two tetrahedra, one of the boundary to one.
        let faces = (4 * tets + body.mesh.boundary(None).len()) / 2;
        Self {
            nodes: report.nodes,
            edges: report.edges,
            faces,
            tets,
        }
    }

    /// The counts after each tetrahedron is divided into eight: a node in the middle of each edge, three new edges in
    /// each face and one in each tetrahedron, eight new faces in each tetrahedron.
    pub(super) fn refined(self) -> Self {
        let Self {
            nodes,
            edges,
            faces,
            tets,
        } = self;
        Self {
            nodes: nodes + edges,
            edges: 2 * edges + 3 * faces + tets,
            faces: 4 * faces + 8 * tets,
            tets: 8 * tets,
        }
    }

    /// Blocks of the matrix without supports: one for each node and two for each edge.
    pub(super) fn blocks(self) -> usize {
        self.nodes + 2 * self.edges
    }
}
