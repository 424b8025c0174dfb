//! Sums of what tetrahedra give to their nodes.

/// The corners of tetrahedra at each node. Sums are taken by node, in the order of the tetrahedra, so that no two
/// threads write to one place and the bits do not depend on their number.
#[derive(Clone, Debug)]
pub(super) struct Gather {
    /// Nodes that have a corner, increasing.
    nodes: Vec<u32>,
    /// Start of each node's part of `corners`, and the end of the last.
    starts: Vec<u32>,
    /// Corners: four times the tetrahedron's place, and the vertex.
    corners: Vec<u32>,
}

impl Gather {
    /// The corners of tetrahedra with these nodes, in a mesh of `count` nodes.
    pub(super) fn new(count: usize, tets: impl Iterator<Item = [u32; 4]> + Clone) -> Self {
        let mut ends = vec![0u32; count + 1];
        for node in tets.clone().flatten() {
            ends[node as usize + 1] += 1;
        }
        for node in 0..count {
            ends[node + 1] += ends[node];
        }
        let mut free = ends.clone();
        let mut corners = vec![0; ends[count] as usize];
        for (corner, node) in (0..).zip(tets.flatten()) {
            let place = &mut free[node as usize];
            corners[*place as usize] = corner;
            *place += 1;
        }
        let has_corners = |node: &u32| ends[*node as usize] < ends[*node as usize + 1];
        let nodes: Vec<u32> = (0..count as u32).filter(has_corners).collect();
        let mut starts: Vec<u32> = nodes.iter().map(|node| ends[*node as usize]).collect();
        starts.push(ends[count]);
        Self {
            nodes,
            starts,
            corners,
        }
    }

    /// Calls `add` with each node and the sum of the forces (N) at its corners.
    pub(super) fn sum(&self, at_corners: &[[f64; 12]], mut add: impl FnMut(u32, [f64; 3])) {
        for (node, range) in self.nodes.iter().zip(self.starts.windows(2)) {
            let mut sum = [0.0; 3];
            for corner in &self.corners[range[0] as usize..range[1] as usize] {
                let forces = &at_corners[*corner as usize / 4];
                let first = *corner as usize % 4 * 3;
                for (sum, force) in sum.iter_mut().zip(&forces[first..first + 3]) {
                    *sum += force;
                }
            }
            add(*node, sum);
        }
    }
}
