//! Lists of nodes, ends and types as blocks of cells.

use super::cell_types::{name_of_unread, of_vtk};
use crate::cell_type::CellType;
use crate::mesh::CellBlock;
use crate::reading::fault::Fault;

/// The cells of one piece of a grid, in the form of both of VTK's formats.
pub(crate) struct Cells {
    /// The points of each cell in turn, counted from 0.
    pub(crate) connectivity: Vec<i64>,
    /// The place in `connectivity` at which each cell ends.
    pub(crate) ends: Vec<i64>,
    /// VTK's number of the type of each cell.
    pub(crate) types: Vec<u8>,
    /// The place of the lists in the file, for messages.
    pub(crate) offset: usize,
}

impl Cells {
    /// Adds the cells to blocks, a block for each run of equal types, with `before` added to the number of each of `points` points.
    pub(super) fn add_to(
        &self,
        blocks: &mut Vec<CellBlock>,
        points: usize,
        before: usize,
    ) -> Result<(), Fault> {
        if self.types.len() != self.ends.len() {
            let problem = format!("there are {} types of cells", self.types.len());
            let expected = format!("{}, one for each cell", self.ends.len());
            return Err(Fault::new(self.offset, problem, expected));
        }
        let mut start = 0;
        let mut known: Option<(u8, CellType, Option<&'static [usize]>)> = None;
        for (number, (&number_of_type, &end)) in (1u64..).zip(self.types.iter().zip(&self.ends)) {
            let in_cell = |problem: String, expected: String| {
                Fault::new(self.offset, problem, expected).in_record("cell", number, 0)
            };
            let end = usize::try_from(end).ok();
            let row = end.and_then(|end| self.connectivity.get(start..end));
            let (Some(row), Some(end)) = (row, end) else {
                let problem = "its nodes are not in the list of nodes of all cells".to_owned();
                let expected = format!(
                    "an end from {start} to {}, the length of that list",
                    self.connectivity.len()
                );
                return Err(in_cell(problem, expected));
            };
            start = end;
            let (kind, order) = match known {
                Some((same, kind, order)) if same == number_of_type => (kind, order),
                _ => {
                    let Some(read) = of_vtk(number_of_type) else {
                        let problem = format!(
                            "its type is {number_of_type} ({})",
                            name_of_unread(number_of_type)
                        );
                        let advice = "convert the grid to tetrahedra, in ParaView by the filter Tetrahedralize";
                        let fault = Fault::unsupported(self.offset, problem, advice);
                        return Err(fault.in_record("cell", number, 0));
                    };
                    known = Some((number_of_type, read.kind, read.order));
                    (read.kind, read.order)
                }
            };
            if row.len() != kind.node_count() {
                let problem = format!("it has {} nodes", row.len());
                let expected = format!("{}, since it is a {kind}", kind.node_count());
                return Err(in_cell(problem, expected));
            }
            if blocks.last().is_none_or(|block| block.kind != kind) {
                blocks.push(CellBlock::new(kind, Vec::new()));
            }
            let Some(block) = blocks.last_mut() else {
                continue;
            };
            let node = |node: i64| {
                let index = usize::try_from(node).ok().filter(|node| *node < points);
                let index = index.and_then(|node| u32::try_from(node + before).ok());
                index.ok_or_else(|| {
                    let expected = match points {
                        0 => "none, as there are no points".to_owned(),
                        _ => format!("a point from 0 to {}", points - 1),
                    };
                    in_cell(format!("it has point {node}"), expected)
                })
            };
            match order {
                None => {
                    for &at in row {
                        block.connectivity.push(node(at)?);
                    }
                }
                Some(order) => {
                    for &at in order.iter().filter_map(|&place| row.get(place)) {
                        block.connectivity.push(node(at)?);
                    }
                }
            }
        }
        if start != self.connectivity.len() {
            let problem = format!(
                "the list of nodes of all cells has {} entries",
                self.connectivity.len()
            );
            let expected = format!("{start}, the end of the last cell");
            return Err(Fault::new(self.offset, problem, expected));
        }
        Ok(())
    }
}
