//! The nodes of a body as a sheet sees them.

/// A point of tissue, brought to the plane of a sheet along its normal.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Flat {
    /// Its place in the plane, from the sheet's centre.
    pub(crate) place: [f64; 2],
    /// Displacement of the point in the plane since the blade was at the beginning of the sheet, relative to that of
    /// the beginning.
    pub(crate) shift: [f64; 2],
}

impl Flat {
    /// The mean of three points.
    pub(crate) fn mean(of: [Self; 3]) -> Self {
        let mean = |part: fn(&Self) -> [f64; 2]| {
            [0, 1].map(|axis| of.iter().map(|flat| part(flat)[axis]).sum::<f64>() / 3.0)
        };
        Self {
            place: mean(|flat| flat.place),
            shift: mean(|flat| flat.shift),
        }
    }

    /// The point at a share of the way from one to another.
    pub(crate) fn between([from, to]: [Self; 2], share: f64) -> Self {
        let part = |from: [f64; 2], to: [f64; 2]| {
            [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]))
        };
        Self {
            place: part(from.place, to.place),
            shift: part(from.shift, to.shift),
        }
    }
}

/// Positions of the nodes relative to the current sheet: each is computed once, for all tetrahedra at the node.
#[derive(Default)]
pub(crate) struct SeenNodes {
    distances: Vec<f64>,
    flats: Vec<Flat>,
    /// The search in which each was seen.
    looks: Vec<u32>,
}

impl SeenNodes {
    pub(crate) fn with_room(nodes: usize) -> Self {
        Self {
            distances: Vec::with_capacity(nodes),
            flats: Vec::with_capacity(nodes),
            looks: Vec::with_capacity(nodes),
        }
    }

    /// Resizes the lists to `nodes` nodes.
    pub(crate) fn resize(&mut self, nodes: usize) {
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

    /// The distance of a node from the plane, and its place in it.
    pub(crate) fn of(&self, node: u32) -> (f64, Flat) {
        (self.distances[node as usize], self.flats[node as usize])
    }

    /// True if a node is seen for the first time in search number `look`.
    pub(crate) fn is_new(&mut self, node: u32, look: u32) -> bool {
        std::mem::replace(&mut self.looks[node as usize], look) != look
    }

    /// Takes a node as it is seen now: its distance from the plane and its place in it.
    pub(crate) fn set(&mut self, node: u32, distance: f64, flat: Flat) {
        self.distances[node as usize] = distance;
        self.flats[node as usize] = flat;
    }
}
