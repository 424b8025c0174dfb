//! Conversion of cells of second and higher order to linear cells with the same corners.

use std::collections::BTreeMap;

use crate::cell_type::CellType;
use crate::mesh::{CellBlock, Mesh};

/// The mid-edge nodes of second-order lines, triangles and tetrahedra in VTK's order: each with the two corners of its edge.
/// The edges of a line are the first of this list, those of a triangle the first three.
const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

/// The cells that [`Mesh::linearise`] changed.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Linearised {
    /// The number of changed cells, by their former kind.
    pub cells: BTreeMap<CellType, usize>,
    /// Number of nodes that only these cells had, away from their corners; they are dropped.
    pub dropped_nodes: usize,
    /// The greatest distance of a mid-edge node of a second-order line, triangle or tetrahedron from the middle of the straight
    /// edge, in the mesh's unit: about the error of a curved boundary.
    pub farthest_from_straight: f64,
}

impl Mesh {
    /// Replaces every cell by a linear one with the same corners, and drops the other nodes of the cells unless they
    /// are corners elsewhere. Groups and element tags stay; values at the nodes of cells stay at the corners.
    ///
    /// A mesh of linear cells is unchanged.
    pub fn linearise(&mut self) -> Linearised {
        let mut done = Linearised::default();
        let mut keep = vec![true; self.points.len()];
        for block in &self.cells {
            let linear = block.kind.linear();
            if linear == block.kind || block.is_empty() {
                continue;
            }
            *done.cells.entry(block.kind).or_default() += block.len();
            for &node in block.cells().flat_map(|row| &row[linear.node_count()..]) {
                if let Some(keep) = keep.get_mut(node as usize) {
                    *keep = false;
                }
            }
            let bulge = self.farthest_from_straight(block);
            done.farthest_from_straight = done.farthest_from_straight.max(bulge);
        }
        for number in 0..self.cells.len() {
            self.linearise_block(number);
            for &node in &self.cells[number].connectivity {
                if let Some(keep) = keep.get_mut(node as usize) {
                    *keep = true;
                }
            }
        }
        done.dropped_nodes = self.drop_nodes(&keep);
        done
    }

    fn linearise_block(&mut self, number: usize) {
        let block = &mut self.cells[number];
        let (nodes, linear) = (block.kind.node_count(), block.kind.linear());
        let corners = linear.node_count();
        block.kind = linear;
        keep_start_of_rows(&mut block.connectivity, nodes, corners);
        for data in &mut self.cell_node_data {
            if let Some(values) = data.blocks.get_mut(number) {
                keep_start_of_rows(values, nodes * data.components, corners * data.components);
            }
        }
    }

    fn farthest_from_straight(&self, block: &CellBlock) -> f64 {
        let point = |node: u32| self.points.get(node as usize).copied();
        let mut farthest = 0.0f64;
        for row in block.cells() {
            for (middle, [a, b]) in middle_nodes(block.kind) {
                let (Some(a), Some(b), Some(middle)) =
                    (point(row[a]), point(row[b]), point(row[middle]))
                else {
                    continue;
                };
                let off = |i: usize| middle[i] - f64::midpoint(a[i], b[i]);
                farthest = farthest.max(off(0).hypot(off(1)).hypot(off(2)));
            }
        }
        farthest
    }
}

/// The nodes in the middle of edges of a second-order line, triangle or tetrahedron, as places in a row of nodes, each
/// with the two corners of its edge; none for other kinds.
pub(crate) fn middle_nodes(kind: CellType) -> impl Iterator<Item = (usize, [usize; 2])> + Clone {
    let edges = match kind {
        CellType::Line3 => &EDGES[..1],
        CellType::Triangle6 => &EDGES[..3],
        CellType::Tetra10 => &EDGES[..],
        _ => &[],
    };
    (kind.linear().node_count()..).zip(edges.iter().copied())
}

/// Keeps the first `kept` entries of each row of `width` entries.
fn keep_start_of_rows<T>(list: &mut Vec<T>, width: usize, kept: usize) {
    if kept == width {
        return;
    }
    let mut entry = 0;
    list.retain(|_| {
        entry += 1;
        (entry - 1) % width < kept
    });
}
