//! Merging nodes of parts that touch.

use std::collections::{BTreeSet, HashMap};

use super::sets::Sets;
use super::surfaces::{Contacts, Surfaces};
use crate::linearise::middle_nodes;
use crate::mesh::Mesh;

/// Pairs (node, into): a node of a touching face, and the node of another part at the same position, into which it
/// would be merged. Nodes of one part are never merged with each other.
pub(super) fn merged_nodes(surfaces: &mut Surfaces<'_>, contacts: &Contacts) -> Vec<[u32; 2]> {
    let mut of_place: HashMap<u32, BTreeSet<u32>> = HashMap::new();
    let pairs: Vec<[usize; 2]> = contacts
        .matched
        .iter()
        .chain(&contacts.lying)
        .copied()
        .collect();
    for pair in pairs {
        let [a, b] = pair.map(|face| surfaces.part(face));
        if a == b {
            continue;
        }
        for node in pair.into_iter().flat_map(|face| surfaces.boundary[face].0) {
            let place = surfaces.place(node);
            of_place.entry(place).or_default().insert(node);
        }
    }
    let mut merged = Vec::new();
    for nodes in of_place.into_values() {
        let mut nodes = nodes.into_iter();
        let Some(first) = nodes.next() else { continue };
        let mut taken = vec![surfaces.parts.root(first)];
        for node in nodes {
            let part = surfaces.parts.root(node);
            if !taken.contains(&part) {
                taken.push(part);
                merged.push([node, first]);
            }
        }
    }
    merged.sort_unstable();
    merged
}

fn sorted(mut edge: [u32; 2]) -> [u32; 2] {
    edge.sort_unstable();
    edge
}

impl Mesh {
    /// Merges nodes of parts that touch: nodes of faces on a face of another part, at the position of one of its nodes.
    /// Nodes of one part are never merged with each other, so that cuts stay. Nodes on edges of cells of second order
    /// follow the corners. Values are those of the first node. Returns the number of nodes that were merged into
    /// others.
    pub fn merge_nodes(&mut self) -> usize {
        let tets = self.corners_of_tets();
        let mut surfaces = Surfaces::of(&self.points, &tets);
        let contacts = surfaces.contacts();
        let pairs = merged_nodes(&mut surfaces, &contacts);
        if pairs.is_empty() {
            return 0;
        }
        let mut sets = Sets::new(self.points.len());
        for [node, into] in pairs {
            sets.join(node, into);
        }
        self.join_nodes_on_edges(&mut sets);
        let is_used: Vec<bool> = (0u32..)
            .take(self.points.len())
            .map(|node| sets.root(node) == node)
            .collect();
        let cells = self.cells.iter_mut();
        for node in cells.flat_map(|block| &mut block.connectivity) {
            if (*node as usize) < is_used.len() {
                *node = sets.root(*node);
            }
        }
        self.drop_nodes(&is_used)
    }

    /// Joins the nodes in the middle of edges that were merged.
    fn join_nodes_on_edges(&self, sets: &mut Sets) {
        let is_known = |node: &&u32| (**node as usize) < self.points.len();
        let mut on_edge: HashMap<[u32; 2], Vec<([u32; 2], u32)>> = HashMap::new();
        for block in &self.cells {
            let edges = middle_nodes(block.kind);
            for row in block
                .cells()
                .filter(|row| row.iter().all(|node| is_known(&node)))
            {
                for (middle, [a, b]) in edges.clone() {
                    let own = sorted([row[a], row[b]]);
                    let merged = sorted(own.map(|node| sets.root(node)));
                    let known = on_edge.entry(merged).or_default();
                    // Edges of the same corners belong to the two faces of a cut.
                    let other = known.iter().find(|(corners, _)| *corners != own);
                    if let Some((_, other)) = other {
                        sets.join(*other, row[middle]);
                    }
                    if !known.contains(&(own, row[middle])) {
                        known.push((own, row[middle]));
                    }
                }
            }
        }
    }
}
