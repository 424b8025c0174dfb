//! The tetrahedra at each edge.

use super::sets::Sets;
use crate::tetra::EDGES;

/// The edges of regions that average over them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Edges {
    /// The tetrahedra of one region at each edge; an edge between two regions occurs twice.
    pub(crate) tets: Sets,
    /// The two nodes of each, the smaller first.
    pub(crate) nodes: Vec<[u32; 2]>,
    /// The six edges of each tetrahedron, in the order of [`EDGES`]; empty if no region averages over edges.
    pub(crate) of_tet: Vec<[u32; 6]>,
}

/// Marks the edges of a tetrahedron whose region does not average over them.
pub(crate) const NO_EDGE: u32 = u32::MAX;

impl Edges {
    /// The edges of the tetrahedra whose region `averages`, region after region, by their nodes.
    pub(super) fn new(
        tets: &[[u32; 4]],
        region_of: &[u32],
        averages: impl Fn(u32) -> bool,
    ) -> Self {
        let mut all = Vec::new();
        for ((tet, nodes), region) in (0..).zip(tets).zip(region_of) {
            if averages(*region) {
                for (edge, [a, b]) in (0u8..).zip(EDGES) {
                    let [a, b] = [nodes[a].min(nodes[b]), nodes[a].max(nodes[b])];
                    all.push((*region, [a, b], tet, edge));
                }
            }
        }
        if all.is_empty() {
            return Self::default();
        }
        all.sort_unstable();
        let mut of_tet = vec![[NO_EDGE; 6]; tets.len()];
        let mut nodes: Vec<[u32; 2]> = Vec::new();
        let mut last = None;
        for (region, ends, tet, edge) in &all {
            if last.replace((region, ends)) != Some((region, ends)) {
                nodes.push(*ends);
            }
            of_tet[*tet as usize][*edge as usize] = nodes.len() as u32 - 1;
        }
        drop(all);
        let averaged = (0..).zip(&of_tet).filter(|(_, edges)| edges[0] != NO_EDGE);
        let pairs = averaged.flat_map(|(tet, edges)| edges.iter().map(move |edge| (*edge, tet)));
        Self {
            tets: Sets::from_pairs(nodes.len(), pairs),
            nodes,
            of_tet,
        }
    }
}
