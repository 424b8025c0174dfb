//! The nodes that a split touches.

use sinew_cutting::{CuttableBody, Stroke};

/// Mark of a node whose tetrahedra have other nodes.
const BESIDE: u8 = 1;

/// Mark of a node that was split, or is a copy.
const SPLIT: u8 = 2;

/// Mark of a node that was moved, or whose original was.
const MOVED: u8 = 4;

/// Mark of a node with a tetrahedron that has a moved node.
const RESHAPED: u8 = 8;

/// The nodes that a split touches, with the kind of change. Repeated use allocates nothing.
#[derive(Debug, Default)]
pub(super) struct Touched {
    /// The nodes, increasing.
    nodes: Vec<u32>,
    /// Place of each node of the body among them.
    places: Vec<u32>,
    /// Marks of each node of the body.
    marks: Vec<u8>,
}

impl Touched {
    pub(super) fn with_room(nodes: usize) -> Self {
        Self {
            nodes: Vec::with_capacity(nodes),
            places: Vec::with_capacity(nodes),
            marks: Vec::with_capacity(nodes),
        }
    }

    /// Finds them after a stroke on a body that had `nodes_before` nodes.
    pub(super) fn find(&mut self, body: &CuttableBody, stroke: &Stroke, nodes_before: usize) {
        for node in self.nodes.drain(..) {
            self.marks[node as usize] = 0;
        }
        self.marks.resize(body.nodes(), 0);
        self.places.resize(body.nodes(), 0);
        for moved in &stroke.moved {
            self.mark(moved.node, MOVED);
        }
        for (copy, node) in (nodes_before as u32..).zip(&stroke.copied) {
            let moved = self.marks[*node as usize] & MOVED;
            self.mark(*node, SPLIT);
            self.mark(copy, SPLIT | moved);
        }
        for tet in &stroke.changed_tets {
            let nodes = body.tets()[*tet as usize];
            let is_moved = nodes
                .iter()
                .any(|node| self.marks[*node as usize] & MOVED != 0);
            let mark = if is_moved { BESIDE | RESHAPED } else { BESIDE };
            nodes.into_iter().for_each(|node| self.mark(node, mark));
        }
        self.nodes.sort_unstable();
        for (place, node) in (0..).zip(&self.nodes) {
            self.places[*node as usize] = place;
        }
    }

    fn mark(&mut self, node: u32, mark: u8) {
        let marks = &mut self.marks[node as usize];
        if *marks == 0 {
            self.nodes.push(node);
        }
        *marks |= mark;
    }

    /// All of them, increasing.
    pub(super) fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// The place of a touched node among them.
    pub(super) fn place(&self, node: u32) -> usize {
        self.places[node as usize] as usize
    }

    pub(super) fn is_split(&self, node: u32) -> bool {
        self.marks[node as usize] & SPLIT != 0
    }

    pub(super) fn is_moved(&self, node: u32) -> bool {
        self.marks[node as usize] & MOVED != 0
    }

    /// True if the tetrahedra at a node have changed, or have another shape: then all sums over them are recomputed. At
    /// other touched nodes only the coupling to split ones changes.
    pub(super) fn is_made_anew(&self, node: u32) -> bool {
        self.marks[node as usize] & (SPLIT | RESHAPED) != 0
    }

    /// Nodes whose sums are recomputed, increasing.
    pub(super) fn made_anew(&self) -> impl Iterator<Item = u32> {
        let nodes = self.nodes.iter().copied();
        nodes.filter(|node| self.is_made_anew(*node))
    }
}
