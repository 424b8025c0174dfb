//! The rows of a body's matrices that belong to its supports.

use std::ops::Range;

use crate::network::Dashpot;
use crate::parts::{Parts, WholePart};
use crate::springs;

/// The rows of K and of the dashpots' matrix at nodes with fixed components, against all their
/// neighbours, fixed or not: K_ps and K_pp together, in 3x3 blocks.
#[derive(Clone, Debug)]
pub(crate) struct Border {
    /// Nodes of the rows, increasing.
    nodes: Vec<u32>,
    row_start: Vec<usize>,
    /// Node of each block, increasing within a row.
    columns: Vec<u32>,
    /// Row-major blocks (N/m).
    stiffness: Vec<[f64; 9]>,
    /// Row-major blocks (N s/m); empty without dashpots.
    dashpots: Vec<[f64; 9]>,
}

impl Border {
    /// Sums up the rows of `nodes` (increasing) from the parts of K at them and from `dashpots`; dashpots that end at
    /// none of these nodes are skipped.
    pub(crate) fn new(parts: Parts<'_>, nodes: &[u32], dashpots: &[Dashpot]) -> Self {
        let (mesh, at_nodes) = (parts.mesh, parts_at(parts, nodes));
        let mut border = Self::zero(parts, nodes, &at_nodes);
        let mut whole = WholePart::default();
        for part in at_nodes {
            parts.whole(part, &mut whole);
            for (a, row) in whole.nodes().iter().enumerate() {
                for (b, column) in whole.nodes().iter().enumerate() {
                    if let Some(at) = border.find(*row, *column) {
                        add(&mut border.stiffness[at], whole.block(a, b));
                    }
                }
            }
        }
        if !dashpots.is_empty() {
            border.dashpots = vec![[0.0; 9]; border.columns.len()];
        }
        for Dashpot { nodes, rate } in dashpots {
            let block = springs::edge_block(&mesh.points, *nodes, *rate);
            let [a, b] = *nodes;
            for (row, column) in [(a, b), (b, a)] {
                for (column, sign) in [(row, 1.0), (column, -1.0)] {
                    if let Some(at) = border.find(row, column) {
                        add(&mut border.dashpots[at], block.map(|entry| sign * entry));
                    }
                }
            }
        }
        border
    }

    fn zero(parts: Parts<'_>, nodes: &[u32], at_nodes: &[usize]) -> Self {
        let mut neighbours: Vec<Vec<u32>> = nodes.iter().map(|node| vec![*node]).collect();
        let mut of_part = Vec::new();
        for part in at_nodes {
            parts.nodes(*part, &mut of_part);
            for node in &of_part {
                if let Ok(row) = nodes.binary_search(node) {
                    neighbours[row].extend(&of_part);
                }
            }
        }
        let (mut row_start, mut columns) = (vec![0], Vec::new());
        for mut row in neighbours {
            row.sort_unstable();
            row.dedup();
            columns.append(&mut row);
            row_start.push(columns.len());
        }
        Self {
            nodes: nodes.to_vec(),
            row_start,
            stiffness: vec![[0.0; 9]; columns.len()],
            columns,
            dashpots: Vec::new(),
        }
    }

    /// The blocks of a node's row.
    fn row(&self, node: u32) -> Option<Range<usize>> {
        let row = self.nodes.binary_search(&node).ok()?;
        Some(self.row_start[row]..self.row_start[row + 1])
    }

    fn find(&self, row: u32, column: u32) -> Option<usize> {
        let range = self.row(row)?;
        let offset = self.columns[range.clone()].binary_search(&column).ok()?;
        Some(range.start + offset)
    }

    /// The row of K (u + beta v) + C v (N) at a node, C being the dashpots; zero if there is no such row. `u` and `v`
    /// give the displacement (m) and velocity (m/s) of a node.
    pub(crate) fn internal_force(
        &self,
        node: u32,
        beta: f64,
        u: impl Fn(u32) -> [f64; 3],
        v: impl Fn(u32) -> [f64; 3],
    ) -> [f64; 3] {
        let mut force = [0.0; 3];
        for at in self.row(node).unwrap_or_default() {
            let column = self.columns[at];
            let mut moved = u(column);
            if beta != 0.0 {
                let velocity = v(column);
                moved = std::array::from_fn(|axis| moved[axis] + beta * velocity[axis]);
            }
            add_product(&mut force, &self.stiffness[at], moved);
            if let Some(block) = self.dashpots.get(at) {
                add_product(&mut force, block, v(column));
            }
        }
        force
    }

    /// The blocks of K and of the dashpots that couple the neighbours of a node to it, transposed: with
    /// `d` at the node, the forces (N, N s) that the two matrices make at each neighbour.
    pub(crate) fn column_products(
        &self,
        node: u32,
        d: [f64; 3],
    ) -> impl Iterator<Item = (u32, [f64; 3], [f64; 3])> {
        let transposed = move |block: &[f64; 9]| -> [f64; 3] {
            std::array::from_fn(|j| (0..3).map(|i| block[3 * i + j] * d[i]).sum())
        };
        let row = self.row(node).unwrap_or_default();
        row.map(move |at| {
            let damping = self.dashpots.get(at).map(transposed);
            let stiffness = transposed(&self.stiffness[at]);
            (self.columns[at], stiffness, damping.unwrap_or_default())
        })
    }
}

/// The numbers of the parts with a matrix that have some of the nodes.
fn parts_at(parts: Parts<'_>, nodes: &[u32]) -> Vec<usize> {
    let mut wanted = vec![false; parts.mesh.points.len()];
    for &node in nodes {
        wanted[node as usize] = true;
    }
    let mut of_part = Vec::new();
    let has_some = |part: &usize| {
        parts.nodes(*part, &mut of_part);
        of_part.iter().any(|node| wanted[*node as usize])
    };
    let linear = (0..parts.count()).filter(|part| !parts.is_hyperelastic(*part));
    linear.filter(has_some).collect()
}

fn add(sum: &mut [f64; 9], block: [f64; 9]) {
    for (sum, entry) in sum.iter_mut().zip(block) {
        *sum += entry;
    }
}

fn add_product(sum: &mut [f64; 3], block: &[f64; 9], x: [f64; 3]) {
    for (sum, row) in sum.iter_mut().zip(block.as_chunks::<3>().0) {
        *sum += row[0] * x[0] + row[1] * x[1] + row[2] * x[2];
    }
}
