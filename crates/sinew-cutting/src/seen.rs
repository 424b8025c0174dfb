//! Positions of the nodes of a body relative to a sheet.

use crate::flat::Flat;
use crate::sheet::Sheet;

/// Bounds of a sheet in its plane.
pub(crate) struct Outlines([[f64; 2]; 2]);

impl Outlines {
    pub(crate) fn of(sheet: &Sheet) -> Self {
        Self(sheet.flat_bounds())
    }
}

/// Positions of the nodes relative to the current sheet: each is computed once, for all tetrahedra at the node.
#[derive(Default)]
pub(crate) struct SeenNodes {
    distances: Vec<f64>,
    flats: Vec<Flat>,
    /// The number of the search in which each node was last seen.
    looks: Vec<u32>,
    /// The nodes that the current search has seen.
    seen: Vec<u32>,
    /// Half-spaces that contain each node, one bit each: outside the four edges of the sheet's bounds, two sides of
    /// its plane.
    beyond: Vec<u8>,
}

impl SeenNodes {
    pub(crate) fn with_room(nodes: usize) -> Self {
        Self {
            distances: Vec::with_capacity(nodes),
            flats: Vec::with_capacity(nodes),
            looks: Vec::with_capacity(nodes),
            seen: Vec::with_capacity(nodes),
            beyond: Vec::with_capacity(nodes),
        }
    }

    /// Starts a search in a body of `nodes` nodes.
    pub(crate) fn start(&mut self, nodes: usize) {
        self.seen.clear();
        self.beyond.resize(nodes, 0);
        self.distances.resize(nodes, 0.0);
        self.flats.resize(nodes, Flat::default());
        self.looks.resize(nodes, 0);
    }

    /// Distances from the plane of a tetrahedron's vertices, which this search has seen; 0 for those that lie on it.
    pub(crate) fn distances(&self, nodes: [u32; 4]) -> [f64; 4] {
        nodes.map(|node| self.distances[node as usize])
    }

    pub(crate) fn flats(&self, nodes: [u32; 4]) -> [Flat; 4] {
        nodes.map(|node| self.flats[node as usize])
    }

    /// The distance of a node from the plane, and its position in it.
    pub(crate) fn of(&self, node: u32) -> (f64, Flat) {
        (self.distances[node as usize], self.flats[node as usize])
    }

    /// True if a node is seen for the first time in the search with the number `look`.
    pub(crate) fn is_new(&mut self, node: u32, look: u32) -> bool {
        let is_new = std::mem::replace(&mut self.looks[node as usize], look) != look;
        if is_new {
            self.seen.push(node);
        }
        is_new
    }

    /// Finds the half-spaces that contain each node that the search has seen.
    pub(crate) fn outline(&mut self, Outlines([mut low, mut high]): Outlines) {
        // As far as any of them has moved.
        for axis in 0..2 {
            let (mut back, mut ahead) = (0.0_f64, 0.0_f64);
            for node in &self.seen {
                let shift = self.flats[*node as usize].shift[axis];
                (back, ahead) = (back.min(shift), ahead.max(shift));
            }
            low[axis] += back;
            high[axis] += ahead;
        }
        for node in &self.seen {
            let node = *node as usize;
            let Flat { place: [x, y], .. } = self.flats[node];
            let distance = self.distances[node];
            let are = [
                x < low[0],
                y < low[1],
                x > high[0],
                y > high[1],
                distance < 0.0,
                distance > 0.0,
            ];
            let bits = are.into_iter().rev();
            self.beyond[node] = bits.fold(0, |all, is| all << 1 | u8::from(is));
        }
    }

    /// False only if one half-space contains all nodes of a tetrahedron, so that the sheet misses it.
    pub(crate) fn may_be_passed(&self, nodes: [u32; 4]) -> bool {
        let [a, b, c, d] = nodes.map(|node| self.beyond[node as usize]);
        a & b & c & d == 0
    }

    /// Sets a node's distance from the plane and its position in it.
    pub(crate) fn set(&mut self, node: u32, distance: f64, flat: Flat) {
        self.distances[node as usize] = distance;
        self.flats[node as usize] = flat;
    }
}
