//! Writes versions 2.2 and 4.1, as text and as bytes.

mod cells;
mod data;
mod entities;
mod error;
mod sink;
mod v2;
mod v41;

use std::io::{self, Write};

pub use error::WriteMshError;
pub use sink::MshEncoding;

use crate::mesh::Mesh;
use error::full_or_empty;
use sink::Sink;

/// A version of the .msh format that can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MshVersion {
    /// 2.2, which nearly every program reads.
    V22,
    /// 4.1, gmsh's own since 2019.
    V41,
}

/// Writes a mesh as a .msh file: points, cells, tags, physical groups, data fields and periodic links.
///
/// Equal meshes give equal bytes, and every number reads back exactly. Contents that a version cannot store are
/// changed:
///
/// * **4.1** attaches groups to geometrical entities. A block whose cells differ in entity or groups is written as several
///   blocks, and if one entity would have to be in different groups, or a cell has none, new entity numbers are given.
/// * **2.2** has one group per cell. A cell in several groups is written once for each, as gmsh does; the copies
///   get new tags. Signs of group tags, entities of nodes and the boundaries between blocks of one cell type are lost. Tags
///   beyond 31 bits are replaced by counting from 1 (and links between nodes with such tags left out).
/// * Points and cells without any value in a data field get no row in it.
///
/// # Errors
///
/// If the mesh contradicts itself, a coordinate is not finite, a name has a line break, a tag does not fit into a binary
/// file's 31 bits and there are data, or the destination fails.
///
/// ```
/// use sinew_mesh::{MshEncoding, MshVersion, read_msh, structured, write_msh};
///
/// let mesh = structured::cube(2, 0.1, structured::Split::Kuhn)?.to_mesh();
/// let mut file = Vec::new();
/// write_msh(&mesh, MshVersion::V22, MshEncoding::Binary, &mut file)?;
/// assert_eq!(read_msh(&file)?.points, mesh.points);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_msh(
    mesh: &Mesh,
    version: MshVersion,
    encoding: MshEncoding,
    to: &mut impl Write,
) -> Result<(), WriteMshError> {
    check(mesh)?;
    let mut to = Sink::new(io::BufWriter::new(to), encoding);
    let number = match version {
        MshVersion::V22 => "2.2",
        MshVersion::V41 => "4.1",
    };
    to.header(number)?;
    write_physical_names(mesh, &mut to)?;
    match version {
        MshVersion::V22 => v2::write(mesh, &mut to)?,
        MshVersion::V41 => v41::write(mesh, &mut to)?,
    }
    to.flush()?;
    Ok(())
}

/// Writes a mesh as .msh version 4.1 text; see [`write_msh`].
///
/// # Errors
///
/// If the mesh contradicts itself, a coordinate is not finite, a name has a line break, or the destination fails.
pub fn write_msh41_ascii(mesh: &Mesh, to: &mut impl Write) -> Result<(), WriteMshError> {
    write_msh(mesh, MshVersion::V41, MshEncoding::Text, to)
}

fn check(mesh: &Mesh) -> Result<(), WriteMshError> {
    let nodes = mesh.points.len();
    full_or_empty("node_tags", mesh.node_tags.len(), nodes)?;
    full_or_empty("node_entities", mesh.node_entities.len(), nodes)?;
    for (node, &point) in (0u32..).zip(&mesh.points) {
        if !point.iter().all(|x| x.is_finite()) {
            return Err(WriteMshError::NotFinite {
                node_tag: mesh.node_tag(node),
                point,
            });
        }
    }
    for (&(dim, tag), name) in &mesh.physical_names {
        if name.contains('\n') {
            return Err(WriteMshError::BadName { dim, tag });
        }
    }
    check_node_tags(mesh)?;
    data::check(mesh)?;
    for (number, block) in mesh.cells.iter().enumerate() {
        let cells = block.len();
        let what = |field: &str| format!("{field} of block {number}");
        full_or_empty(&what("element_tags"), block.element_tags.len(), cells)?;
        full_or_empty(&what("geometrical"), block.geometrical.len(), cells)?;
        full_or_empty(&what("physical"), block.physical.len(), cells)?;
        let complete = cells * block.kind.node_count();
        full_or_empty(&what("connectivity"), block.connectivity.len(), complete)?;
        for (cell, row) in block.cells().enumerate() {
            if let Some(&node) = row.iter().find(|&&node| node as usize >= nodes) {
                return Err(WriteMshError::NodeOutOfRange {
                    block: number,
                    cell,
                    node,
                    nodes,
                });
            }
        }
    }
    Ok(())
}

fn check_node_tags(mesh: &Mesh) -> Result<(), WriteMshError> {
    let mut tags = mesh.node_tags.clone();
    tags.sort_unstable();
    if tags.first() == Some(&0) {
        return Err(WriteMshError::BadNodeTag { tag: 0 });
    }
    let repeated = tags.iter().zip(tags.iter().skip(1)).find(|(a, b)| a == b);
    match repeated {
        Some((&tag, _)) => Err(WriteMshError::BadNodeTag { tag }),
        None => Ok(()),
    }
}

fn write_physical_names(mesh: &Mesh, to: &mut Sink<impl Write>) -> io::Result<()> {
    if mesh.physical_names.is_empty() {
        return Ok(());
    }
    to.line("$PhysicalNames")?;
    to.line(&mesh.physical_names.len().to_string())?;
    for ((dim, tag), name) in &mesh.physical_names {
        to.line(&format!("{dim} {tag} \"{name}\""))?;
    }
    to.line("$EndPhysicalNames")
}
