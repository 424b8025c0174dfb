//! Repairs of a mesh, each made only on request. Coincident nodes are never merged, because cuts consist of them.

use std::collections::HashSet;

use crate::cell_type::CellType;
use crate::mesh::{CellBlock, Mesh};
use crate::physical_tags::PhysicalTags;
use crate::tet_shape::{TetShape, tet_corners};

impl Mesh {
    /// Orients inverted tetrahedra (4 and 10 nodes) positively: exchanges two corners, the nodes on the edges between
    /// corners accordingly, and the values at all of them. Returns the number of turned tetrahedra.
    pub fn orient(&mut self) -> usize {
        let mut turned = 0;
        for block in 0..self.cells.len() {
            let kind = self.cells[block].kind;
            let exchanges: &[(usize, usize)] = match kind {
                CellType::Tetra => &[(1, 2)],
                // VTK's mid-edge nodes: 4 on 01, 6 on 02, 8 on 13, 9 on 23.
                CellType::Tetra10 => &[(1, 2), (4, 6), (8, 9)],
                _ => continue,
            };
            let count = kind.node_count();
            for cell in 0..self.cells[block].len() {
                let row = &self.cells[block].connectivity[cell * count..][..count];
                let is_inverted = tet_corners(self, kind, row)
                    .is_some_and(|corners| TetShape::of(corners).volume < 0.0);
                if !is_inverted {
                    continue;
                }
                turned += 1;
                for &(a, b) in exchanges {
                    let start = cell * count;
                    self.cells[block].connectivity.swap(start + a, start + b);
                    for data in &mut self.cell_node_data {
                        let Some(values) = data.blocks.get_mut(block) else {
                            continue;
                        };
                        for i in 0..data.components {
                            let at = |node: usize| (start + node) * data.components + i;
                            if at(a.max(b)) < values.len() {
                                values.swap(at(a), at(b));
                            }
                        }
                    }
                }
            }
        }
        turned
    }

    /// Drops the nodes that no cell uses, with their values and links. Returns the number of dropped nodes.
    pub fn drop_orphans(&mut self) -> usize {
        let mut is_used = vec![false; self.points.len()];
        for &node in self.cells.iter().flat_map(|block| &block.connectivity) {
            if let Some(used) = is_used.get_mut(node as usize) {
                *used = true;
            }
        }
        self.drop_nodes(&is_used)
    }

    /// Drops the nodes for which `is_used` is false, with their values and links, and returns their number. No cell may use one.
    pub(crate) fn drop_nodes(&mut self, is_used: &[bool]) -> usize {
        let dropped = is_used.iter().filter(|&&used| !used).count();
        if dropped == 0 {
            return 0;
        }
        let orphan_tags: HashSet<u64> = (0u32..)
            .zip(is_used)
            .filter(|&(_, &used)| !used)
            .map(|(node, _)| self.node_tag(node))
            .collect();
        // Without tags, nodes count from 1; the remaining ones must keep the numbers they had.
        self.node_tags = (0u32..)
            .zip(is_used)
            .filter(|&(_, &used)| used)
            .map(|(node, _)| self.node_tag(node))
            .collect();
        for link in &mut self.periodic {
            let is_kept = |pair: &[u64; 2]| !pair.iter().any(|tag| orphan_tags.contains(tag));
            link.node_tags.retain(is_kept);
        }
        keep_rows(&mut self.points, is_used, 1);
        keep_rows(&mut self.node_entities, is_used, 1);
        for data in &mut self.point_data {
            keep_rows(&mut data.values, is_used, data.components);
        }
        let mut next = 0;
        let new_index: Vec<u32> = is_used
            .iter()
            .map(|&used| {
                next += u32::from(used);
                next.wrapping_sub(1)
            })
            .collect();
        for node in self
            .cells
            .iter_mut()
            .flat_map(|block| &mut block.connectivity)
        {
            if let Some(&new) = new_index.get(*node as usize) {
                *node = new;
            }
        }
        dropped
    }

    /// Merges each cell into the first cell of its type with the same nodes, which then belongs to the groups of both.
    /// Values are those of the first cell. Blocks without cells are removed. Returns the number of cells merged into others.
    pub fn merge_duplicates(&mut self) -> usize {
        let pairs: Vec<_> = (0..=3)
            .flat_map(|dim| self.duplicate_cells(dim))
            .flat_map(|duplicates| duplicates.pairs)
            .collect();
        if pairs.is_empty() {
            return 0;
        }
        let mut keep: Vec<Vec<bool>> = self
            .cells
            .iter()
            .map(|block| vec![true; block.len()])
            .collect();
        let mut groups: Vec<Vec<Vec<i32>>> = self.cells.iter().map(groups_of_cells).collect();
        for &(first, copy) in &pairs {
            keep[copy.block][copy.cell] = false;
            for tag in std::mem::take(&mut groups[copy.block][copy.cell]) {
                let merged = &mut groups[first.block][first.cell];
                if !merged
                    .iter()
                    .any(|other| other.saturating_abs() == tag.saturating_abs())
                {
                    merged.push(tag);
                }
            }
        }
        for (block, groups) in self.cells.iter_mut().zip(groups) {
            block.physical = PhysicalTags::new();
            for tags in groups {
                block.physical.push(&tags);
            }
        }
        for (block, keep) in keep.iter().enumerate() {
            let nodes = self.cells[block].kind.node_count();
            for data in &mut self.cell_data {
                if let Some(values) = data.blocks.get_mut(block) {
                    keep_rows(values, keep, data.components);
                }
            }
            for data in &mut self.cell_node_data {
                if let Some(values) = data.blocks.get_mut(block) {
                    keep_rows(values, keep, data.components * nodes);
                }
            }
            self.cells[block].keep(keep);
        }
        let has_cells: Vec<bool> = self.cells.iter().map(|block| !block.is_empty()).collect();
        keep_rows(&mut self.cells, &has_cells, 1);
        for data in &mut self.cell_data {
            keep_rows(&mut data.blocks, &has_cells, 1);
        }
        for data in &mut self.cell_node_data {
            keep_rows(&mut data.blocks, &has_cells, 1);
        }
        pairs.len()
    }
}

fn groups_of_cells(block: &CellBlock) -> Vec<Vec<i32>> {
    (0..block.len())
        .map(|cell| block.physical.of(cell).to_vec())
        .collect()
}

/// Keeps the rows for which `keep` is true. A row has `width` entries.
fn keep_rows<T>(list: &mut Vec<T>, keep: &[bool], width: usize) {
    let mut entry = 0;
    list.retain(|_| {
        entry += 1;
        keep.get((entry - 1) / width.max(1))
            .copied()
            .unwrap_or(true)
    });
}
