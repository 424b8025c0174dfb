//! Writes versions 2.2 and 4.1, as text and as bytes.

mod cells;
mod data;
mod entities;
mod sink;
mod v2;
mod v41;

use std::io::{self, Write};

use crate::mesh::Mesh;
use sink::Sink;

/// A mesh cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteMshError {
    /// The destination refused.
    #[error("the mesh cannot be written: {0}")]
    Io(#[from] io::Error),
    /// A coordinate is infinite or not a number.
    #[error(
        "the node with tag {node_tag} has coordinates {point:?}; only finite numbers can be written"
    )]
    NotFinite {
        /// Tag of the node.
        node_tag: u64,
        /// Its coordinates.
        point: [f64; 3],
    },
    /// A name cannot stand on one line.
    #[error("the name of group {tag} of dimension {dim} has a line break")]
    BadName {
        /// Dimension of the group.
        dim: u8,
        /// Tag of the group.
        tag: i32,
    },
    /// The name of a data field cannot stand on one line.
    #[error("the name of data field {name:?} has a line break or a double quote")]
    BadFieldName {
        /// The name.
        name: String,
    },
    /// A node tag is 0 or occurs twice.
    #[error("node tag {tag} {}", if *tag == 0 { "stands for no node" } else { "occurs twice" })]
    BadNodeTag {
        /// The tag.
        tag: u64,
    },
    /// A tag does not fit where the format has 31 bits for it.
    #[error("tag {tag} does not fit into the 31 bits that the format has for it there")]
    TagTooLarge {
        /// The tag.
        tag: u64,
    },
    /// The fields of the mesh do not fit together.
    #[error("{what} has {found} entries, but {expected} are needed")]
    BadLength {
        /// The field.
        what: String,
        /// Its length.
        found: usize,
        /// The length it should have.
        expected: usize,
    },
    /// A cell names a node that does not exist.
    #[error("cell {cell} of block {block} has node index {node}, but there are {nodes} nodes")]
    NodeOutOfRange {
        /// Index of the block.
        block: usize,
        /// Index of the cell in the block.
        cell: usize,
        /// The index it names.
        node: u32,
        /// Number of nodes.
        nodes: usize,
    },
}

/// A version of the .msh format that can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MshVersion {
    /// 2.2, which nearly every program reads.
    V22,
    /// 4.1, gmsh's own since 2019.
    V41,
}

/// How the numbers of a .msh file are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MshEncoding {
    /// As text, with the fewest digits that read back exactly.
    Text,
    /// As bytes, least significant first.
    Binary,
}

/// Writes a mesh as a .msh file: points, cells, tags, physical groups, data fields and periodic links.
///
/// Equal meshes give equal bytes, and every number reads back exactly. What the versions cannot hold is changed thus:
///
/// * **4.1**: groups belong to geometrical entities there. A block whose cells differ in entity or groups is written as several
///   blocks, and where one entity would have to be in different groups, or a cell has none, new entity numbers are given.
/// * **2.2**: a cell has one group there. A cell in several is written once for each, as gmsh does; the copies
///   get new tags. Signs of group tags, entities of nodes and the boundaries between blocks of one cell type are lost. Tags
///   beyond 31 bits are replaced by counting from 1 (and links between nodes with such tags left out).
/// * Points and cells without any value in a data field get no row in it.
///
/// # Errors
///
/// If the mesh contradicts itself, a coordinate is not finite, a name has a line break, a tag does not fit into a binary
/// file's 31 bits where there is data, or the destination fails.
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

fn full_or_empty(what: &str, found: usize, expected: usize) -> Result<(), WriteMshError> {
    if found == 0 || found == expected {
        return Ok(());
    }
    Err(WriteMshError::BadLength {
        what: what.to_owned(),
        found,
        expected,
    })
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
