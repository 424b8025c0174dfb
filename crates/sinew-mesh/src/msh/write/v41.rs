//! Writes version 4.1.

use std::io::{self, Write};

use super::cells::vtk_index_of_gmsh_node;
use super::data::{self, WrittenCell};
use super::entities::{Entities, Part};
use super::error::WriteMshError;
use super::sink::Sink;
use crate::mesh::{CellIndex, Entity, Mesh};

pub(super) fn write(mesh: &Mesh, to: &mut Sink<impl Write>) -> Result<(), WriteMshError> {
    let mut entities = Entities::of_nodes(mesh);
    let parts = entities.assign_cells(mesh);
    entities.write(mesh, &parts, to)?;
    write_nodes(mesh, &entities, to)?;
    write_elements(mesh, &parts, to)?;
    write_periodic(mesh, to)?;
    let node_tag = |node: u32| mesh.node_tag(node);
    data::write(mesh, &node_tag, &written_cells(mesh, &parts), to)
}

/// The cells in the order of the file. They keep the mesh's order.
fn written_cells(mesh: &Mesh, parts: &[Part<'_>]) -> Vec<WrittenCell> {
    if mesh.cell_data.is_empty() && mesh.cell_node_data.is_empty() {
        return Vec::new();
    }
    let tags = parts.iter().flat_map(Part::element_tags);
    let cells = mesh
        .cells
        .iter()
        .enumerate()
        .flat_map(|(block, cells)| (0..cells.len()).map(move |cell| CellIndex { block, cell }));
    tags.zip(cells)
        .map(|(tag, cell)| WrittenCell { tag, cell })
        .collect()
}

fn write_nodes(mesh: &Mesh, entities: &Entities, to: &mut Sink<impl Write>) -> io::Result<()> {
    let nodes: Vec<(u64, [f64; 3], Entity)> = (0u32..)
        .zip(&mesh.points)
        .map(|(node, &point)| {
            let entity = mesh.node_entities.get(node as usize);
            (
                mesh.node_tag(node),
                point,
                entity.copied().unwrap_or(entities.default_for_nodes),
            )
        })
        .collect();
    let blocks: Vec<_> = nodes.chunk_by(|a, b| a.2 == b.2).collect();
    to.line("$Nodes")?;
    write_header(blocks.len(), nodes.iter().map(|node| node.0), to)?;
    for block in blocks {
        let entity = block
            .first()
            .map_or(entities.default_for_nodes, |node| node.2);
        to.int(i32::from(entity.dim))?;
        to.int(entity.tag)?;
        to.int(0)?;
        to.size(block.len() as u64)?;
        to.end_row()?;
        for (tag, ..) in block {
            to.size(*tag)?;
            to.end_row()?;
        }
        for (_, point, _) in block {
            to.doubles(point)?;
            to.end_row()?;
        }
    }
    to.end("Nodes")
}

/// Writes the header of a section: numbers of blocks and rows, least and greatest tag.
fn write_header(
    blocks: usize,
    tags: impl Iterator<Item = u64>,
    to: &mut Sink<impl Write>,
) -> io::Result<()> {
    let (mut total, mut range) = (0, None);
    for tag in tags {
        total += 1;
        let (least, greatest) = range.unwrap_or((tag, tag));
        range = Some((tag.min(least), tag.max(greatest)));
    }
    let (least, greatest) = range.unwrap_or((0, 0));
    for number in [blocks as u64, total, least, greatest] {
        to.size(number)?;
    }
    to.end_row()
}

fn write_elements(mesh: &Mesh, parts: &[Part<'_>], to: &mut Sink<impl Write>) -> io::Result<()> {
    to.line("$Elements")?;
    write_header(parts.len(), parts.iter().flat_map(Part::element_tags), to)?;
    for part in parts {
        let kind = part.block.kind;
        to.int(i32::from(part.entity.dim))?;
        to.int(part.entity.tag)?;
        to.int(kind.gmsh_id())?;
        to.size(part.cells as u64)?;
        to.end_row()?;
        let vtk_index = vtk_index_of_gmsh_node(kind);
        for (element_tag, (_, row)) in part.element_tags().zip(part.rows()) {
            to.size(element_tag)?;
            for &i in &vtk_index {
                let node = row.get(i).copied().unwrap_or_default();
                to.size(mesh.node_tag(node))?;
            }
            to.end_row()?;
        }
    }
    to.end("Elements")
}

fn write_periodic(mesh: &Mesh, to: &mut Sink<impl Write>) -> io::Result<()> {
    if mesh.periodic.is_empty() {
        return Ok(());
    }
    to.line("$Periodic")?;
    to.size(mesh.periodic.len() as u64)?;
    to.end_row()?;
    for link in &mesh.periodic {
        for number in [i32::from(link.dim), link.entity, link.master] {
            to.int(number)?;
        }
        to.end_row()?;
        to.size(link.affine.len() as u64)?;
        to.doubles(&link.affine)?;
        to.end_row()?;
        to.size(link.node_tags.len() as u64)?;
        to.end_row()?;
        for pair in &link.node_tags {
            to.size(pair[0])?;
            to.size(pair[1])?;
            to.end_row()?;
        }
    }
    to.end("Periodic")
}
