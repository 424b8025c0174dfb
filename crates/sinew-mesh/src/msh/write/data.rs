//! Data fields, which are written in the same way in both versions.

use std::io::Write;

use super::cells::vtk_index_of_gmsh_node;
use super::error::{WriteMshError, full_or_empty};
use super::sink::Sink;
use crate::mesh::{CellBlock, CellIndex, Mesh};

/// A cell under the tag it has in the file.
pub(super) struct WrittenCell {
    pub(super) tag: u64,
    pub(super) cell: CellIndex,
}

struct Field<'m> {
    section: &'static str,
    name: &'m str,
    step: i32,
    time: f64,
    components: usize,
}

/// Refuses fields that do not fit the mesh.
pub(super) fn check(mesh: &Mesh) -> Result<(), WriteMshError> {
    for field in &mesh.point_data {
        let expected = mesh.points.len() * field.components;
        check_length(&field.name, field.values.len(), expected)?;
    }
    for field in &mesh.cell_data {
        let of_block = |block: &CellBlock| block.len() * field.components;
        check_blocks(mesh, &field.name, &field.blocks, of_block)?;
    }
    for field in &mesh.cell_node_data {
        let of_block = |block: &CellBlock| block.connectivity.len() * field.components;
        check_blocks(mesh, &field.name, &field.blocks, of_block)?;
    }
    Ok(())
}

fn check_blocks(
    mesh: &Mesh,
    name: &str,
    blocks: &[Vec<f64>],
    of_block: impl Fn(&CellBlock) -> usize,
) -> Result<(), WriteMshError> {
    full_or_empty(
        &format!("blocks of field {name:?}"),
        blocks.len(),
        mesh.cells.len(),
    )?;
    for (block, values) in mesh.cells.iter().zip(blocks) {
        check_length(name, values.len(), of_block(block))?;
    }
    Ok(())
}

fn check_length(name: &str, found: usize, expected: usize) -> Result<(), WriteMshError> {
    if name.contains(['\n', '"']) {
        return Err(WriteMshError::BadFieldName {
            name: name.to_owned(),
        });
    }
    if found == expected {
        return Ok(());
    }
    Err(WriteMshError::BadLength {
        what: format!("field {name:?}"),
        found,
        expected,
    })
}

pub(super) fn write(
    mesh: &Mesh,
    node_tag: &impl Fn(u32) -> u64,
    cells: &[WrittenCell],
    to: &mut Sink<impl Write>,
) -> Result<(), WriteMshError> {
    for data in &mesh.point_data {
        let field = Field {
            section: "NodeData",
            name: &data.name,
            step: data.step,
            time: data.time,
            components: data.components,
        };
        let values = data.values.chunks_exact(data.components.max(1));
        let rows: Vec<(u64, &[f64])> = (0u32..)
            .zip(values)
            .map(|(node, row)| (node_tag(node), row))
            .filter(|(_, row)| has_value(row))
            .collect();
        field.start(rows.len(), to)?;
        for (tag, row) in rows {
            write_tag(tag, to)?;
            to.doubles(row)?;
            to.end_row()?;
        }
        to.end(field.section)?;
    }
    for data in &mesh.cell_data {
        let field = Field {
            section: "ElementData",
            name: &data.name,
            step: data.step,
            time: data.time,
            components: data.components,
        };
        let rows = cell_rows(cells, &data.blocks, |_| data.components);
        field.start(rows.len(), to)?;
        for (cell, row) in rows {
            write_tag(cell.tag, to)?;
            to.doubles(row)?;
            to.end_row()?;
        }
        to.end(field.section)?;
    }
    for data in &mesh.cell_node_data {
        let field = Field {
            section: "ElementNodeData",
            name: &data.name,
            step: data.step,
            time: data.time,
            components: data.components,
        };
        let kind = |cell: CellIndex| mesh.cells.get(cell.block).map(|block| block.kind);
        let rows = cell_rows(cells, &data.blocks, |cell| {
            kind(cell).map_or(0, |kind| kind.node_count() * data.components)
        });
        field.start(rows.len(), to)?;
        for (cell, row) in rows {
            let Some(kind) = kind(cell.cell) else {
                continue;
            };
            write_tag(cell.tag, to)?;
            to.int(i32::try_from(kind.node_count()).unwrap_or(i32::MAX))?;
            for i in vtk_index_of_gmsh_node(kind) {
                let first = i * data.components;
                to.doubles(row.get(first..first + data.components).unwrap_or_default())?;
            }
            to.end_row()?;
        }
        to.end(field.section)?;
    }
    Ok(())
}

fn has_value(row: &[f64]) -> bool {
    !row.iter().all(|x| x.is_nan())
}

/// The cells with values, and their values. `width` is the number of values of a cell.
fn cell_rows<'r>(
    cells: &'r [WrittenCell],
    blocks: &'r [Vec<f64>],
    width: impl Fn(CellIndex) -> usize,
) -> Vec<(&'r WrittenCell, &'r [f64])> {
    let rows = cells.iter().filter_map(|written| {
        let width = width(written.cell);
        let first = written.cell.cell * width;
        let row = blocks.get(written.cell.block)?.get(first..first + width)?;
        has_value(row).then_some((written, row))
    });
    rows.collect()
}

/// Writes the tag of a row, which has 4 bytes in binary files of both versions.
fn write_tag(tag: u64, to: &mut Sink<impl Write>) -> Result<(), WriteMshError> {
    match i32::try_from(tag) {
        Ok(tag) => to.int(tag)?,
        Err(_) if !to.is_binary() => to.size(tag)?,
        Err(_) => return Err(WriteMshError::TagTooLarge { tag }),
    }
    Ok(())
}

impl Field<'_> {
    fn start(&self, rows: usize, to: &mut Sink<impl Write>) -> Result<(), WriteMshError> {
        to.line(&format!("${}", self.section))?;
        to.line(&format!("1\n\"{}\"", self.name))?;
        to.line(&format!("1\n{:?}", self.time))?;
        to.line(&format!("3\n{}\n{}\n{rows}", self.step, self.components))?;
        Ok(())
    }
}
