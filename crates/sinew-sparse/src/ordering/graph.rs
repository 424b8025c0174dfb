//! Graphs with weights.

use crate::Pattern;

/// An undirected graph without loops. A vertex represents `weight` cells, an edge `edge_weight` pairs of neighbours.
pub(super) struct Graph {
    start: Vec<usize>,
    ends: Vec<u32>,
    edge_weights: Vec<u32>,
    weights: Vec<u32>,
}

impl Graph {
    /// A graph without vertices.
    pub(super) fn new() -> Self {
        Self {
            start: vec![0],
            ends: Vec::new(),
            edge_weights: Vec::new(),
            weights: Vec::new(),
        }
    }

    /// The graph of some cells of a pattern. `number` is scratch space: one entry per cell of the pattern, all [`NONE`]
    /// before and after.
    pub(super) fn of_cells(pattern: &Pattern, cells: &[u32], number: &mut [u32]) -> Self {
        for (cell, new) in cells.iter().zip(0..) {
            number[*cell as usize] = new;
        }
        let mut graph = Self::new();
        for (cell, own) in cells.iter().zip(0..) {
            let neighbours = pattern.neighbours(*cell as usize).iter();
            let known = neighbours.map(|other| number[*other as usize]);
            graph.push(
                1,
                known
                    .filter(|other| *other != NONE && *other != own)
                    .map(|other| (other, 1)),
            );
        }
        for cell in cells {
            number[*cell as usize] = NONE;
        }
        graph
    }

    /// Adds a vertex with its edges.
    pub(super) fn push(&mut self, weight: u32, edges: impl Iterator<Item = (u32, u32)>) {
        for (end, weight) in edges {
            self.ends.push(end);
            self.edge_weights.push(weight);
        }
        self.start.push(self.ends.len());
        self.weights.push(weight);
    }

    /// Number of vertices.
    pub(super) fn len(&self) -> usize {
        self.weights.len()
    }

    pub(super) fn weight(&self, vertex: u32) -> u32 {
        self.weights[vertex as usize]
    }

    /// Weight of all vertices.
    pub(super) fn total(&self) -> u64 {
        self.weights.iter().map(|weight| u64::from(*weight)).sum()
    }

    pub(super) fn neighbours(&self, vertex: u32) -> &[u32] {
        &self.ends[self.start[vertex as usize]..self.start[vertex as usize + 1]]
    }

    /// Neighbours with the weights of the edges to them.
    pub(super) fn edges(&self, vertex: u32) -> impl Iterator<Item = (u32, u32)> {
        let range = self.start[vertex as usize]..self.start[vertex as usize + 1];
        let weights = self.edge_weights[range.clone()].iter().copied();
        self.ends[range].iter().copied().zip(weights)
    }
}

/// No vertex.
pub(super) const NONE: u32 = u32::MAX;
