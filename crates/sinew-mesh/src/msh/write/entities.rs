//! The geometrical entities of a file of version 4.1, where groups belong to entities and each cell to one entity.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::io::{self, Write};

use super::sink::Sink;
use crate::mesh::{CellBlock, Entity, Mesh};

/// Consecutive cells of a block that share an entity. The file calls them a block.
pub(super) struct Part<'m> {
    pub(super) block: &'m CellBlock,
    /// Index of the first cell within the block.
    pub(super) first: usize,
    pub(super) cells: usize,
    pub(super) entity: Entity,
    pub(super) first_element_tag: Option<u64>,
}

impl Part<'_> {
    pub(super) fn rows(&self) -> impl Iterator<Item = (usize, &[u32])> {
        self.block
            .cells()
            .enumerate()
            .skip(self.first)
            .take(self.cells)
    }

    /// The tag of each row.
    pub(super) fn element_tags(&self) -> impl Iterator<Item = u64> {
        let given = self.block.element_tags.iter().copied().skip(self.first);
        let counted = (self.first_element_tag.unwrap_or(1)..).take(self.cells);
        let is_given = self.first_element_tag.is_none();
        let given = given.take(if is_given { self.cells } else { 0 });
        given.chain(counted.take(if is_given { 0 } else { self.cells }))
    }
}

/// The entities that the file must list, with their physical tags.
pub(super) struct Entities {
    physical: BTreeMap<Entity, Vec<i32>>,
    /// The entity of the nodes if the mesh gives none.
    pub(super) default_for_nodes: Entity,
}

impl Entities {
    pub(super) fn of_nodes(mesh: &Mesh) -> Entities {
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
    pub(super) fn assign_cells<'m>(&mut self, mesh: &'m Mesh) -> Vec<Part<'m>> {
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

    pub(super) fn write(
        &self,
        mesh: &Mesh,
        parts: &[Part<'_>],
        to: &mut Sink<impl Write>,
    ) -> io::Result<()> {
        let boxes = boxes(mesh, parts);
        let of_dim = |dim| {
            self.physical
                .iter()
                .filter(move |(entity, _)| entity.dim == dim)
        };
        to.line("$Entities")?;
        for dim in 0..=3 {
            to.size(of_dim(dim).count() as u64)?;
        }
        to.end_row()?;
        for dim in 0..=3 {
            for (entity, physical) in of_dim(dim) {
                let (low, high) = boxes.get(entity).copied().unwrap_or_default();
                to.int(entity.tag)?;
                to.doubles(&low)?;
                if dim > 0 {
                    to.doubles(&high)?;
                }
                to.size(physical.len() as u64)?;
                for &tag in physical {
                    to.int(tag)?;
                }
                if dim > 0 {
                    to.size(0)?;
                }
                to.end_row()?;
            }
        }
        to.end("Entities")
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

/// The first number for cells that have no tags.
pub(super) fn first_free_element_tag(mesh: &Mesh) -> u64 {
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
