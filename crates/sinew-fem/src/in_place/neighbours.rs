//! Numbers of neighbours of nodes.

use sinew_cutting::CuttableBody;
use sinew_mesh::TetMesh;

use crate::error::FemError;
use crate::graph::Graph;

/// Numbers of neighbours of all nodes, fixed ones included, by which edges are counted.
#[derive(Debug)]
pub(super) struct Neighbours {
    counts: Vec<u32>,
    /// The last count in which each node was seen.
    seen: Vec<u32>,
    look: u32,
}

impl Neighbours {
    /// Counts the neighbours in a mesh, with space for `spare` further nodes.
    pub(super) fn new(mesh: &TetMesh, spare: usize) -> Result<Self, FemError> {
        let mut graph = Graph::of(mesh);
        let pattern = graph.pattern()?;
        let nodes = mesh.points.len();
        let mut counts = Vec::with_capacity(nodes + spare);
        counts.extend((0..nodes).map(|node| pattern.neighbours(node).len() as u32 - 1));
        let mut seen = Vec::with_capacity(nodes + spare);
        seen.resize(nodes, 0);
        Ok(Self {
            counts,
            seen,
            look: 0,
        })
    }

    /// Counts them again at some nodes, among them both ends of all edges that were added or removed; returns the
    /// number of added edges.
    pub(super) fn follow(&mut self, body: &CuttableBody, nodes: &[u32]) -> isize {
        self.counts.resize(body.nodes(), 0);
        self.seen.resize(body.nodes(), 0);
        let mut twice = 0;
        for node in nodes {
            self.look = self.look.wrapping_add(1);
            self.seen[*node as usize] = self.look;
            let mut count = 0;
            for tet in body.tets_at(*node) {
                for other in body.tets()[*tet as usize] {
                    let seen = std::mem::replace(&mut self.seen[other as usize], self.look);
                    count += u32::from(seen != self.look);
                }
            }
            let before = std::mem::replace(&mut self.counts[*node as usize], count);
            twice += count as isize - before as isize;
        }
        twice / 2
    }
}
