//! Sorts values with tags into the order of points and cells.

use std::ops::Range;

use super::data::{Holder, RawData};
use crate::cell_type::CellType;
use crate::mesh::{CellBlock, CellData, CellIndex, CellNodeData, Mesh, PointData};
use crate::reading::fault::Fault;
use crate::reading::remarks::Remarks;
use crate::reading::tag_index::TagIndex;

pub(super) fn add(
    sections: Vec<RawData>,
    mesh: &mut Mesh,
    nodes: &TagIndex,
    file_length: usize,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    if sections.is_empty() {
        return Ok(());
    }
    refuse_if_too_sparse(&sections, mesh, file_length)?;
    let has_cell_data = sections.iter().any(|data| data.holder != Holder::Nodes);
    let elements = ElementIndex::of(if has_cell_data { &mesh.cells } else { &[] });
    for mut data in sections {
        if data.holder == Holder::Elements
            && elements.counts_from_0()
            && data.counts_from_1()
            && data.tags.len() == elements.cells
        {
            remarks.at(
                data.offset,
                format!(
                    "{}: rows count from 1 and elements from 0, as meshio writes version 4.0; row 1 is for element 0",
                    data.label()
                ),
            );
            data.tags.iter_mut().for_each(|tag| *tag -= 1);
        }
        let mut rows = RowCount::default();
        match data.holder {
            Holder::Nodes => {
                let values = point_values(&data, mesh.points.len(), nodes, &mut rows);
                rows.remark(&data, "points", mesh.points.len(), remarks);
                mesh.point_data.push(PointData {
                    name: data.name,
                    step: data.step,
                    time: data.time,
                    components: data.components,
                    values,
                });
            }
            Holder::Elements => {
                let blocks = cell_values(&data, &mesh.cells, &elements, &mut rows);
                let cells = rows.leave_out_other_types(&mesh.cells, &elements);
                rows.remark(&data, "cells", cells, remarks);
                mesh.cell_data.push(CellData {
                    name: data.name,
                    step: data.step,
                    time: data.time,
                    components: data.components,
                    blocks,
                });
            }
            Holder::ElementNodes => {
                let blocks = cell_node_values(&data, &mesh.cells, &elements, &mut rows)?;
                let cells = rows.leave_out_other_types(&mesh.cells, &elements);
                rows.remark(&data, "cells", cells, remarks);
                mesh.cell_node_data.push(CellNodeData {
                    name: data.name,
                    step: data.step,
                    time: data.time,
                    components: data.components,
                    blocks,
                });
            }
        }
    }
    Ok(())
}

/// Refuses data that are too sparse. Missing rows are filled with NaN; many such sections could need far more memory
/// than the file has bytes.
fn refuse_if_too_sparse(
    sections: &[RawData],
    mesh: &Mesh,
    file_length: usize,
) -> Result<(), Fault> {
    let cells: usize = mesh.cells.iter().map(CellBlock::len).sum();
    let corners: usize = mesh
        .cells
        .iter()
        .map(|block| block.connectivity.len())
        .sum();
    let allowed = file_length.saturating_mul(16).saturating_add(1 << 20);
    let mut needed: usize = 0;
    for data in sections {
        let holders = match data.holder {
            Holder::Nodes => mesh.points.len(),
            Holder::Elements => cells,
            Holder::ElementNodes => corners,
        };
        let bytes = holders.saturating_mul(data.components).saturating_mul(8);
        needed = needed.saturating_add(bytes);
        if needed > allowed {
            let problem = format!(
                "data for a small part of the mesh would take {needed} bytes when the rest is filled up, many times the \
                 {file_length} bytes of the file"
            );
            let advice = "write values for more of the mesh, or fewer sections";
            return Err(Fault::unsupported(data.offset, problem, advice).inside(data.section()));
        }
    }
    Ok(())
}

impl RawData {
    fn section(&self) -> &'static str {
        match self.holder {
            Holder::Nodes => "$NodeData",
            Holder::Elements => "$ElementData",
            Holder::ElementNodes => "$ElementNodeData",
        }
    }

    /// Section and name, for messages.
    fn label(&self) -> String {
        format!("{}: \"{}\"", self.section(), self.name.escape_debug())
    }

    /// True if the rows are numbered 1, 2 and so on.
    fn counts_from_1(&self) -> bool {
        (1u64..)
            .zip(&self.tags)
            .all(|(ordinal, &tag)| tag == ordinal)
    }

    /// The rows that have the same number of values each.
    fn rows(&self) -> impl Iterator<Item = (u64, &[f64])> {
        let rows = self.values.chunks_exact(self.components.max(1));
        self.tags.iter().copied().zip(rows)
    }
}

/// Counts of the rows of a section by outcome.
#[derive(Default)]
struct RowCount {
    given: Vec<bool>,
    unknown: usize,
    first_unknown: u64,
    repeated: usize,
}

impl RowCount {
    fn start(&mut self, holders: usize) {
        self.given = vec![false; holders];
    }

    fn mark(&mut self, holder: usize) {
        if let Some(given) = self.given.get_mut(holder) {
            self.repeated += usize::from(*given);
            *given = true;
        }
    }

    fn mark_unknown(&mut self, tag: u64) {
        if self.unknown == 0 {
            self.first_unknown = tag;
        }
        self.unknown += 1;
    }

    /// Leaves out cells of types without any value, such as triangles if only tetrahedra have values; returns the
    /// number of remaining cells.
    fn leave_out_other_types(&mut self, cells: &[CellBlock], elements: &ElementIndex) -> usize {
        let blocks = cells.iter().zip(&elements.starts);
        let ranges: Vec<(CellType, Range<usize>)> = blocks
            .map(|(block, start)| (block.kind, *start..*start + block.len()))
            .collect();
        let given = |range: &Range<usize>| self.given.get(range.clone());
        let has_values = |range| given(range).is_some_and(|given| given.contains(&true));
        let with_values = ranges.iter().filter(|(_, range)| has_values(range));
        let kinds: Vec<CellType> = with_values.map(|(kind, _)| *kind).collect();
        let mut left = elements.cells;
        for (kind, range) in ranges {
            if !kinds.is_empty() && !kinds.contains(&kind) {
                left -= range.len();
                if let Some(given) = self.given.get_mut(range) {
                    given.fill(true);
                }
            }
        }
        left
    }

    fn remark(&self, data: &RawData, holders: &str, total: usize, remarks: &mut Remarks) {
        let label = data.label();
        if self.unknown > 0 {
            remarks.at(
                data.offset,
                format!(
                    "{label}: rows for tags that the mesh does not have, skipped: {} (first: tag {})",
                    self.unknown, self.first_unknown
                ),
            );
        }
        if self.repeated > 0 {
            let repeated = self.repeated;
            remarks.at(
                data.offset,
                format!("{label}: rows that repeat a tag: {repeated}; the last one counts"),
            );
        }
        let missing = self.given.iter().filter(|&&given| !given).count();
        if missing > 0 {
            remarks.at(
                data.offset,
                format!("{label}: {missing} of {total} {holders} have no value; they are NaN"),
            );
        }
    }
}

fn point_values(data: &RawData, points: usize, nodes: &TagIndex, rows: &mut RowCount) -> Vec<f64> {
    rows.start(points);
    let mut values = vec![f64::NAN; points * data.components];
    for (tag, row) in data.rows() {
        let Some(node) = nodes.get(tag) else {
            rows.mark_unknown(tag);
            continue;
        };
        let first = node as usize * data.components;
        if let Some(place) = values.get_mut(first..first + data.components) {
            place.copy_from_slice(row);
            rows.mark(node as usize);
        }
    }
    values
}

/// Index of cells by tag.
struct ElementIndex {
    first: TagIndex,
    /// The position of each block's first cell among all cells.
    starts: Vec<usize>,
    /// Cells with the tag of an earlier one, and that one, among all cells.
    repeated: Vec<(usize, usize)>,
    cells: usize,
}

impl ElementIndex {
    fn of(blocks: &[CellBlock]) -> ElementIndex {
        let tags: Vec<u64> = blocks
            .iter()
            .flat_map(|block| &block.element_tags)
            .copied()
            .collect();
        let mut first = TagIndex::of_range(&tags);
        let mut repeated = Vec::new();
        if !first.is_complete() {
            for (cell, &tag) in (0u32..).zip(&tags) {
                match first.get(tag) {
                    Some(earlier) => repeated.push((cell as usize, earlier as usize)),
                    None => first.insert(tag, cell),
                }
            }
        }
        let mut cells = 0;
        let starts = blocks
            .iter()
            .map(|block| {
                cells += block.len();
                cells - block.len()
            })
            .collect();
        ElementIndex {
            first,
            starts,
            repeated,
            cells,
        }
    }

    /// True if the elements are numbered 0, 1 and so on.
    fn counts_from_0(&self) -> bool {
        self.first.is_complete() && self.first.range() == (0, self.cells.saturating_sub(1) as u64)
    }

    fn cell(&self, tag: u64) -> Option<usize> {
        self.first.get(tag).map(|cell| cell as usize)
    }

    fn place(&self, cell: usize) -> CellIndex {
        // Blocks without cells start where the next one does.
        let block = self.starts.partition_point(|&start| start <= cell);
        let block = block.saturating_sub(1);
        let start = self.starts.get(block).copied().unwrap_or(0);
        CellIndex {
            block,
            cell: cell - start,
        }
    }
}

fn cell_values(
    data: &RawData,
    cells: &[CellBlock],
    elements: &ElementIndex,
    rows: &mut RowCount,
) -> Vec<Vec<f64>> {
    let width = data.components;
    rows.start(elements.cells);
    let mut blocks: Vec<Vec<f64>> = cells
        .iter()
        .map(|block| vec![f64::NAN; block.len() * width])
        .collect();
    let range = |at: CellIndex| at.cell * width..(at.cell + 1) * width;
    for (tag, row) in data.rows() {
        let Some(cell) = elements.cell(tag) else {
            rows.mark_unknown(tag);
            continue;
        };
        let at = elements.place(cell);
        let block = blocks.get_mut(at.block);
        if let Some(place) = block.and_then(|block| block.get_mut(range(at))) {
            place.copy_from_slice(row);
            rows.mark(cell);
        }
    }
    // A value under a tag that several cells have belongs to all of them.
    for &(cell, first) in &elements.repeated {
        if !rows.given.get(first).copied().unwrap_or(false) {
            continue;
        }
        let (from, to) = (elements.place(first), elements.place(cell));
        let row = blocks
            .get(from.block)
            .and_then(|block| block.get(range(from)));
        let Some(row) = row.map(<[f64]>::to_vec) else {
            continue;
        };
        let block = blocks.get_mut(to.block);
        if let Some(place) = block.and_then(|block| block.get_mut(range(to))) {
            place.copy_from_slice(&row);
            rows.mark(cell);
        }
    }
    blocks
}

fn cell_node_values(
    data: &RawData,
    cells: &[CellBlock],
    elements: &ElementIndex,
    rows: &mut RowCount,
) -> Result<Vec<Vec<f64>>, Fault> {
    rows.start(elements.cells);
    let mut blocks: Vec<Vec<f64>> = cells
        .iter()
        .map(|block| vec![f64::NAN; block.connectivity.len() * data.components])
        .collect();
    let mut rest = data.values.as_slice();
    for (number, (&tag, &nodes)) in (1u64..).zip(data.tags.iter().zip(&data.node_counts)) {
        let (row, after) = rest
            .split_at_checked(nodes as usize * data.components)
            .unwrap_or_default();
        rest = after;
        let Some(cell) = elements.cell(tag) else {
            rows.mark_unknown(tag);
            continue;
        };
        let at = elements.place(cell);
        let Some(kind) = cells.get(at.block).map(|block| block.kind) else {
            continue;
        };
        if nodes as usize != kind.node_count() {
            let problem = format!("element {tag} has {nodes} nodes here");
            let expected = format!("{}, since it is a {kind}", kind.node_count());
            let fault = Fault::new(data.offset, problem, expected);
            let rows = data.tags.len() as u64;
            return Err(fault.in_record("row", number, rows).inside(data.section()));
        }
        let width = row.len();
        if let Some(place) = blocks
            .get_mut(at.block)
            .and_then(|block| block.get_mut(at.cell * width..(at.cell + 1) * width))
        {
            copy_in_vtk_order(kind, data.components, row, place);
            rows.mark(cell);
        }
    }
    Ok(blocks)
}

fn copy_in_vtk_order(kind: CellType, components: usize, gmsh_row: &[f64], place: &mut [f64]) {
    let Some(order) = kind.vtk_order_in_gmsh_row() else {
        place.copy_from_slice(gmsh_row);
        return;
    };
    for (node, &i) in place.chunks_exact_mut(components).zip(order) {
        let first = usize::from(i) * components;
        if let Some(values) = gmsh_row.get(first..first + components) {
            node.copy_from_slice(values);
        }
    }
}
