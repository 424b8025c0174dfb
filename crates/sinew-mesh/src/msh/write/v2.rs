//! Writes version 2.2.

use std::io::Write;

use super::cells::vtk_index_of_gmsh_node;
use super::data::{self, WrittenCell};
use super::entities::first_free_element_tag;
use super::error::WriteMshError;
use super::sink::Sink;
use crate::mesh::{CellBlock, CellIndex, Mesh};

const GREATEST: u64 = i32::MAX as u64;

pub(super) fn write(mesh: &Mesh, to: &mut Sink<impl Write>) -> Result<(), WriteMshError> {
    let is_counted = mesh.node_tags.iter().any(|&tag| tag > GREATEST);
    let node_tag = |node: u32| match is_counted {
        true => u64::from(node) + 1,
        false => mesh.node_tag(node),
    };
    to.line("$Nodes")?;
    to.line(&mesh.points.len().to_string())?;
    for (node, point) in (0u32..).zip(&mesh.points) {
        to.int(tag_of_31_bits(node_tag(node))?)?;
        to.doubles(point)?;
        to.end_row()?;
    }
    to.end("Nodes")?;
    let rows = rows(mesh);
    to.line("$Elements")?;
    to.line(&rows.len().to_string())?;
    for run in rows.chunk_by(|a, b| a.at.block == b.at.block && !a.is_copy && !b.is_copy) {
        write_run(mesh, run, &node_tag, to)?;
    }
    to.end("Elements")?;
    if !is_counted {
        write_periodic(mesh, to)?;
    }
    let cells: Vec<WrittenCell> = rows
        .iter()
        .map(|row| WrittenCell {
            tag: row.tag,
            cell: row.at,
        })
        .collect();
    data::write(mesh, &node_tag, &cells, to)
}

fn tag_of_31_bits(tag: u64) -> Result<i32, WriteMshError> {
    i32::try_from(tag).map_err(|_| WriteMshError::TagTooLarge { tag })
}

/// A cell in one of its groups.
struct Row {
    at: CellIndex,
    tag: u64,
    physical: i32,
    /// True if the cell is in the file already, with another group.
    is_copy: bool,
}

/// The cells, each followed by a copy for each of its further groups.
fn rows(mesh: &Mesh) -> Vec<Row> {
    let groups = |block: &CellBlock, cell: usize| block.physical.of(cell).len().max(1);
    let total: u64 = mesh
        .cells
        .iter()
        .map(|block| {
            (0..block.len())
                .map(|cell| groups(block, cell) as u64)
                .sum::<u64>()
        })
        .sum();
    let first_free = first_free_element_tag(mesh);
    let have_tags = mesh
        .cells
        .iter()
        .any(|block| !block.element_tags.is_empty());
    let is_counted = !have_tags || first_free.saturating_add(total) > GREATEST;
    let mut next = if is_counted { 1 } else { first_free };
    let mut take_next = || {
        next += 1;
        next - 1
    };
    let mut rows = Vec::new();
    for (block, cells) in mesh.cells.iter().enumerate() {
        for cell in 0..cells.len() {
            let physical = cells.physical.of(cell);
            for index in 0..groups(cells, cell) {
                let tag = cells.element_tags.get(cell).copied();
                rows.push(Row {
                    at: CellIndex { block, cell },
                    tag: match tag {
                        Some(tag) if index == 0 && !is_counted => tag,
                        _ => take_next(),
                    },
                    physical: physical.get(index).copied().unwrap_or(0).saturating_abs(),
                    is_copy: index > 0,
                });
            }
        }
    }
    rows
}

/// Writes the rows of one block, in a binary file under one header.
fn write_run(
    mesh: &Mesh,
    run: &[Row],
    node_tag: &impl Fn(u32) -> u64,
    to: &mut Sink<impl Write>,
) -> Result<(), WriteMshError> {
    const TAGS: i32 = 2;
    let Some(block) = run.first().and_then(|row| mesh.cells.get(row.at.block)) else {
        return Ok(());
    };
    let kind = block.kind.gmsh_id();
    let vtk_index = vtk_index_of_gmsh_node(block.kind);
    if to.is_binary() {
        to.int(kind)?;
        to.int(tag_of_31_bits(run.len() as u64)?)?;
        to.int(TAGS)?;
    }
    for row in run {
        to.int(tag_of_31_bits(row.tag)?)?;
        if !to.is_binary() {
            to.int(kind)?;
            to.int(TAGS)?;
        }
        to.int(row.physical)?;
        to.int(block.geometrical.get(row.at.cell).copied().unwrap_or(0))?;
        let start = row.at.cell * block.kind.node_count();
        for &i in &vtk_index {
            let node = block.connectivity.get(start + i).copied();
            to.int(tag_of_31_bits(node_tag(node.unwrap_or_default()))?)?;
        }
        to.end_row()?;
    }
    Ok(())
}

/// Writes the links, as text even in binary files.
fn write_periodic(mesh: &Mesh, to: &mut Sink<impl Write>) -> Result<(), WriteMshError> {
    if mesh.periodic.is_empty() {
        return Ok(());
    }
    to.line("$Periodic")?;
    to.line(&mesh.periodic.len().to_string())?;
    for link in &mesh.periodic {
        to.line(&format!("{} {} {}", link.dim, link.entity, link.master))?;
        if !link.affine.is_empty() {
            let numbers: Vec<String> = link.affine.iter().map(|x| format!("{x:?}")).collect();
            to.line(&format!("Affine {}", numbers.join(" ")))?;
        }
        to.line(&link.node_tags.len().to_string())?;
        for [dependent, master] in &link.node_tags {
            to.line(&format!("{dependent} {master}"))?;
        }
    }
    to.line("$EndPeriodic")?;
    Ok(())
}
