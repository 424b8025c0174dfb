//! The tetrahedra at each node.

/// The tetrahedra at each node, increasing.
///
/// Cuts only remove tetrahedra from nodes, or divide them among a node and its copies. So the list of a node has space
/// for the lists of all its copies as well, and no data is moved.
#[derive(Clone, Debug)]
pub(crate) struct Incidence {
    starts: Vec<u32>,
    counts: Vec<u32>,
    tets: Vec<u32>,
}

impl Incidence {
    pub(crate) fn new(nodes: usize, tets: &[[u32; 4]], spare: usize) -> Self {
        Self::of_some(nodes, (0..).zip(tets), tets.len(), spare)
    }

    /// Incidence of `count` of the tetrahedra, each given with its number, in increasing order.
    pub(crate) fn of_some<'a>(
        nodes: usize,
        tets: impl Iterator<Item = (u32, &'a [u32; 4])> + Clone,
        count: usize,
        spare: usize,
    ) -> Self {
        let mut counts = Vec::with_capacity(nodes + spare);
        counts.resize(nodes, 0);
        for node in tets.clone().flat_map(|(_, corners)| corners) {
            counts[*node as usize] += 1;
        }
        let mut starts = Vec::with_capacity(nodes + spare);
        let mut next = 0;
        for count in &mut counts {
            starts.push(next);
            next += *count;
            *count = 0;
        }
        let mut incidence = Self {
            starts,
            counts,
            tets: vec![0; 4 * count],
        };
        for (tet, nodes) in tets {
            for node in nodes {
                let node = *node as usize;
                let place = incidence.starts[node] + incidence.counts[node];
                incidence.tets[place as usize] = tet;
                incidence.counts[node] += 1;
            }
        }
        incidence
    }

    pub(crate) fn of(&self, node: u32) -> &[u32] {
        &self.tets[self.range(node)]
    }

    fn range(&self, node: u32) -> std::ops::Range<usize> {
        let (start, count) = (self.starts[node as usize], self.counts[node as usize]);
        start as usize..(start + count) as usize
    }

    /// Removes a tetrahedron from a node.
    pub(crate) fn remove(&mut self, node: u32, tet: u32) {
        let range = self.range(node);
        let tets = &mut self.tets[range];
        if let Ok(place) = tets.binary_search(&tet) {
            tets[place..].rotate_left(1);
            self.counts[node as usize] -= 1;
        }
    }

    /// Divides the tetrahedra of a node by the group of each, where group 0 stays with the node and each further group
    /// becomes a new node, numbered after the last one. Each group keeps its order.
    pub(crate) fn divide(&mut self, node: u32, groups: u32, group_of: impl Fn(u32) -> u32) {
        let range = self.range(node);
        self.tets[range.clone()].sort_unstable_by_key(|tet| (group_of(*tet), *tet));
        let mut start = range.start as u32;
        for group in 0..groups {
            let tets = &self.tets[start as usize..range.end];
            let count = tets.partition_point(|tet| group_of(*tet) <= group) as u32;
            if group == 0 {
                self.counts[node as usize] = count;
            } else {
                self.starts.push(start);
                self.counts.push(count);
            }
            start += count;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_node_shares_its_tetrahedra_with_its_copies_in_order() {
        let tets = [[0, 1, 2, 3], [1, 2, 3, 4], [0, 2, 3, 4], [0, 1, 3, 4]];
        let mut incidence = Incidence::new(5, &tets, 0);
        assert_eq!(incidence.of(3), [0, 1, 2, 3]);
        incidence.divide(3, 3, |tet| [1, 0, 2, 1][tet as usize]);
        assert_eq!(incidence.of(3), [1]);
        assert_eq!(incidence.of(5), [0, 3]);
        assert_eq!(incidence.of(6), [2]);
        assert_eq!(incidence.of(4), [1, 2, 3], "others stay");
        incidence.remove(4, 2);
        incidence.remove(4, 0);
        assert_eq!(incidence.of(4), [1, 3]);
    }
}
