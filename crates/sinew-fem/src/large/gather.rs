//! Sums of what tetrahedra give to their nodes.

use std::ops::Range;

/// The corners of tetrahedra at each node. Sums are taken by node, in the order of the tetrahedra, so that no two
/// threads write to one place and the bits do not depend on their number.
#[derive(Clone, Debug)]
pub(super) struct Gather {
    /// Nodes that have a corner, by the last of their tetrahedra.
    nodes: Vec<u32>,
    /// The place of that tetrahedron.
    last_places: Vec<u32>,
    /// Start of each node's part of `corners`, and the end of the last.
    starts: Vec<u32>,
    /// Corners: four times the tetrahedron's place, and the vertex.
    corners: Vec<u32>,
}

impl Gather {
    /// The corners of tetrahedra with these nodes, in a mesh of `count` nodes; `None` for padding.
    pub(super) fn new(count: usize, tets: impl Iterator<Item = Option<[u32; 4]>> + Clone) -> Self {
        let mut ends = vec![0u32; count + 1];
        for node in tets.clone().flatten().flatten() {
            ends[node as usize + 1] += 1;
        }
        for node in 0..count {
            ends[node + 1] += ends[node];
        }
        let mut free = ends.clone();
        let mut of_nodes = vec![0; ends[count] as usize];
        let mut last_places = vec![0; count];
        for (tet, nodes) in (0..).zip(tets) {
            for (vertex, node) in (0..).zip(nodes.into_iter().flatten()) {
                let place = &mut free[node as usize];
                of_nodes[*place as usize] = 4 * tet + vertex;
                *place += 1;
                last_places[node as usize] = tet;
            }
        }
        let range = |node: u32| ends[node as usize] as usize..ends[node as usize + 1] as usize;
        let mut nodes: Vec<u32> = (0..count as u32)
            .filter(|node| !range(*node).is_empty())
            .collect();
        nodes.sort_by_key(|node| last_places[*node as usize]);
        let (mut starts, mut corners) = (vec![0], Vec::with_capacity(of_nodes.len()));
        for node in &nodes {
            corners.extend_from_slice(&of_nodes[range(*node)]);
            starts.push(corners.len() as u32);
        }
        Self {
            last_places: nodes
                .iter()
                .map(|node| last_places[*node as usize])
                .collect(),
            nodes,
            starts,
            corners,
        }
    }

    /// Number of nodes that have all their corners among the first places of tetrahedra.
    pub(super) fn complete(&self, places: usize) -> usize {
        self.last_places
            .partition_point(|last| (*last as usize) < places)
    }

    /// All of its nodes.
    pub(super) fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// Writes the sums of the forces (N) at the corners of some of its nodes, by the number of the node.
    #[inline(always)]
    pub(super) fn sum(&self, which: Range<usize>, at_corners: &[[f64; 4]], out: &mut [[f64; 4]]) {
        let starts = self.starts[which.start..=which.end].windows(2);
        for (node, range) in self.nodes[which].iter().zip(starts) {
            let corners = &self.corners[range[0] as usize..range[1] as usize];
            // Two sums, since each addition waits for the one before.
            let (mut even, mut odd) = ([0.0; 4], [0.0; 4]);
            let (pairs, last) = corners.as_chunks::<2>();
            for [one, other] in pairs {
                even = row_sum(even, &at_corners[*one as usize]);
                odd = row_sum(odd, &at_corners[*other as usize]);
            }
            for corner in last {
                even = row_sum(even, &at_corners[*corner as usize]);
            }
            out[*node as usize] = row_sum(even, &odd);
        }
    }
}

/// The sum of two rows, which is one instruction.
#[inline(always)]
pub(super) fn row_sum(a: [f64; 4], b: &[f64; 4]) -> [f64; 4] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]]
}
