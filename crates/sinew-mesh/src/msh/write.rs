//! Writes version 4.1 as text.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::io::{self, Write};

use crate::cell_type::CellType;
use crate::mesh::{CellBlock, Entity, Mesh};

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

/// Writes a mesh as .msh version 4.1 text: points, cells, tags and physical groups.
///
/// Equal meshes give equal bytes, and every coordinate is written with the fewest digits that read back exactly.
/// In version 4.1 groups belong to geometrical entities: a block whose cells differ in entity or groups is written as
/// several blocks, and where one entity would have to be in different groups, or a cell has none, new
/// entity numbers are given. Data fields and periodic links are not written.
///
/// # Errors
///
/// If the mesh contradicts itself, a coordinate is not finite, a group name has a line break, or the destination fails.
pub fn write_msh41_ascii(mesh: &Mesh, to: &mut impl Write) -> Result<(), WriteMshError> {
    check(mesh)?;
    let mut entities = Entities::of_nodes(mesh);
    let parts = entities.assign_cells(mesh);
    let mut to = io::BufWriter::new(to);
    to.write_all(b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n")?;
    write_physical_names(mesh, &mut to)?;
    entities.write(mesh, &parts, &mut to)?;
    write_nodes(mesh, &entities, &mut to)?;
    write_elements(mesh, &parts, &mut to)?;
    to.flush()?;
    Ok(())
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

/// Consecutive cells of a block that share an entity: what the file calls a block.
struct Part<'m> {
    block: &'m CellBlock,
    /// Index of the first cell within the block.
    first: usize,
    cells: usize,
    entity: Entity,
    first_element_tag: Option<u64>,
}

impl Part<'_> {
    fn rows(&self) -> impl Iterator<Item = (usize, &[u32])> {
        self.block
            .cells()
            .enumerate()
            .skip(self.first)
            .take(self.cells)
    }
}

/// The entities that the file must list, with their physical tags.
struct Entities {
    physical: BTreeMap<Entity, Vec<i32>>,
    /// The entity of the nodes if the mesh does not tell.
    default_for_nodes: Entity,
}

impl Entities {
    fn of_nodes(mesh: &Mesh) -> Entities {
        let greatest_dim = mesh
            .cells
            .iter()
            .map(|block| block.kind.dim())
            .max()
            .unwrap_or(0);
        let default_for_nodes = Entity {
            dim: greatest_dim,
            tag: 1,
        };
        Entities {
            physical: BTreeMap::new(),
            default_for_nodes,
        }
    }

    /// Divides the blocks, and gives each part an entity whose groups are those of its cells.
    fn assign_cells<'m>(&mut self, mesh: &'m Mesh) -> Vec<Part<'m>> {
        let mut fresh = FreshEntities::beside(mesh);
        let mut assigned: HashMap<(Entity, &[i32]), Entity> = HashMap::new();
        let mut parts: Vec<Part<'m>> = Vec::new();
        let mut next_element_tag = first_free_element_tag(mesh);
        for block in &mesh.cells {
            let mut open: Option<Part<'m>> = None;
            let tags_are_missing = block.element_tags.is_empty();
            for cell in 0..block.len() {
                let tag = block.geometrical.get(cell).copied().unwrap_or(0);
                let wanted = Entity {
                    dim: block.kind.dim(),
                    tag,
                };
                let groups = block.physical.of(cell);
                let entity = *assigned.entry((wanted, groups)).or_insert_with(|| {
                    let is_free = tag > 0 && !self.physical.contains_key(&wanted);
                    let entity = if is_free {
                        wanted
                    } else {
                        fresh.next(wanted.dim)
                    };
                    self.physical.insert(entity, groups.to_vec());
                    entity
                });
                match &mut open {
                    Some(part) if part.entity == entity => part.cells += 1,
                    _ => {
                        parts.extend(open.take());
                        let first_element_tag = tags_are_missing.then_some(next_element_tag);
                        open = Some(Part {
                            block,
                            first: cell,
                            cells: 1,
                            entity,
                            first_element_tag,
                        });
                    }
                }
                if tags_are_missing {
                    next_element_tag += 1;
                }
            }
            parts.extend(open);
        }
        for &entity in &mesh.node_entities {
            self.physical.entry(entity).or_default();
        }
        if mesh.node_entities.is_empty() {
            self.physical.entry(self.default_for_nodes).or_default();
        }
        parts
    }

    fn write(&self, mesh: &Mesh, parts: &[Part<'_>], to: &mut impl Write) -> io::Result<()> {
        let boxes = boxes(mesh, parts);
        let of_dim = |dim| {
            self.physical
                .iter()
                .filter(move |(entity, _)| entity.dim == dim)
        };
        let counts = [0, 1, 2, 3].map(|dim| of_dim(dim).count());
        writeln!(
            to,
            "$Entities\n{} {} {} {}",
            counts[0], counts[1], counts[2], counts[3]
        )?;
        for dim in 0..=3 {
            for (entity, physical) in of_dim(dim) {
                let (low, high) = boxes.get(entity).copied().unwrap_or_default();
                write!(to, "{} {:?} {:?} {:?} ", entity.tag, low[0], low[1], low[2])?;
                if dim > 0 {
                    write!(to, "{:?} {:?} {:?} ", high[0], high[1], high[2])?;
                }
                write!(to, "{}", physical.len())?;
                for tag in physical {
                    write!(to, " {tag}")?;
                }
                writeln!(to, "{}", if dim > 0 { " 0" } else { "" })?;
            }
        }
        writeln!(to, "$EndEntities")
    }
}

/// Entities that the mesh does not use.
struct FreshEntities {
    used: HashSet<Entity>,
    last: [i32; 4],
}

impl FreshEntities {
    fn beside(mesh: &Mesh) -> FreshEntities {
        let of_cells = mesh.cells.iter().flat_map(|block| {
            let dim = block.kind.dim();
            block
                .geometrical
                .iter()
                .map(move |&tag| Entity { dim, tag })
        });
        FreshEntities {
            used: of_cells.chain(mesh.node_entities.iter().copied()).collect(),
            last: [0; 4],
        }
    }

    fn next(&mut self, dim: u8) -> Entity {
        let last = self.last.get(usize::from(dim)).copied().unwrap_or(0);
        let is_free = |tag: &i32| !self.used.contains(&Entity { dim, tag: *tag });
        // More than 2^31 entities do not fit into memory, so a free one is found.
        let tag = (last..i32::MAX)
            .map(|tag| tag + 1)
            .find(is_free)
            .unwrap_or(i32::MAX);
        if let Some(last) = self.last.get_mut(usize::from(dim)) {
            *last = tag;
        }
        Entity { dim, tag }
    }
}

/// Where to start numbering cells that have no tags.
fn first_free_element_tag(mesh: &Mesh) -> u64 {
    let greatest = mesh
        .cells
        .iter()
        .flat_map(|block| &block.element_tags)
        .max()
        .copied();
    let cells: usize = mesh.cells.iter().map(CellBlock::len).sum();
    match greatest {
        Some(greatest) if greatest.checked_add(cells as u64 + 1).is_some() => greatest + 1,
        _ => 1,
    }
}

type Bounds = ([f64; 3], [f64; 3]);

/// The boxes of the entities, from their cells.
fn boxes(mesh: &Mesh, parts: &[Part<'_>]) -> HashMap<Entity, Bounds> {
    let mut boxes: HashMap<Entity, Bounds> = HashMap::new();
    for part in parts {
        for &node in part.rows().flat_map(|(_, row)| row) {
            let Some(&point) = mesh.points.get(node as usize) else {
                continue;
            };
            let (low, high) = boxes.entry(part.entity).or_insert((point, point));
            for ((low, high), x) in low.iter_mut().zip(high).zip(point) {
                *low = low.min(x);
                *high = high.max(x);
            }
        }
    }
    boxes
}

fn write_physical_names(mesh: &Mesh, to: &mut impl Write) -> io::Result<()> {
    if mesh.physical_names.is_empty() {
        return Ok(());
    }
    writeln!(to, "$PhysicalNames\n{}", mesh.physical_names.len())?;
    for ((dim, tag), name) in &mesh.physical_names {
        writeln!(to, "{dim} {tag} \"{name}\"")?;
    }
    writeln!(to, "$EndPhysicalNames")
}

fn write_nodes(mesh: &Mesh, entities: &Entities, to: &mut impl Write) -> io::Result<()> {
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
    let least = nodes.iter().map(|node| node.0).min().unwrap_or(0);
    let greatest = nodes.iter().map(|node| node.0).max().unwrap_or(0);
    writeln!(
        to,
        "$Nodes\n{} {} {least} {greatest}",
        blocks.len(),
        nodes.len()
    )?;
    for block in blocks {
        let entity = block
            .first()
            .map_or(entities.default_for_nodes, |node| node.2);
        writeln!(to, "{} {} 0 {}", entity.dim, entity.tag, block.len())?;
        for (tag, ..) in block {
            writeln!(to, "{tag}")?;
        }
        for (_, [x, y, z], _) in block {
            writeln!(to, "{x:?} {y:?} {z:?}")?;
        }
    }
    writeln!(to, "$EndNodes")
}

fn write_elements(mesh: &Mesh, parts: &[Part<'_>], to: &mut impl Write) -> io::Result<()> {
    let tags_of = |part: &Part<'_>| -> Vec<u64> {
        match part.first_element_tag {
            Some(first) => (first..).take(part.cells).collect(),
            None => part
                .block
                .element_tags
                .iter()
                .skip(part.first)
                .take(part.cells)
                .copied()
                .collect(),
        }
    };
    let total: usize = parts.iter().map(|part| part.cells).sum();
    let least = parts.iter().flat_map(tags_of).min().unwrap_or(0);
    let greatest = parts.iter().flat_map(tags_of).max().unwrap_or(0);
    writeln!(to, "$Elements\n{} {total} {least} {greatest}", parts.len())?;
    for part in parts {
        let kind = part.block.kind;
        let Entity { dim, tag } = part.entity;
        writeln!(to, "{dim} {tag} {} {}", kind.gmsh_id(), part.cells)?;
        let vtk_index = vtk_index_of_gmsh_node(kind);
        for (element_tag, (_, row)) in tags_of(part).into_iter().zip(part.rows()) {
            write!(to, "{element_tag}")?;
            for &i in &vtk_index {
                let node = row.get(i).copied().unwrap_or_default();
                write!(to, " {}", mesh.node_tag(node))?;
            }
            writeln!(to)?;
        }
    }
    writeln!(to, "$EndElements")
}

/// `gmsh_row[i] = vtk_row[order[i]]`: the inverse of [`CellType::vtk_order_in_gmsh_row`].
fn vtk_index_of_gmsh_node(kind: CellType) -> Vec<usize> {
    let mut order: Vec<usize> = (0..kind.node_count()).collect();
    if let Some(vtk_order) = kind.vtk_order_in_gmsh_row() {
        order.sort_by_key(|&vtk| vtk_order.get(vtk));
    }
    order
}
