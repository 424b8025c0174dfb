//! From tables of tags to a mesh of indices.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::elements::{ElementSection, RawBlock, RawGroups};
use super::entities::Entities;
use super::fault::Fault;
use super::nodes::RawNodes;
use super::remarks::Remarks;
use super::section::Contents;
use crate::cell_type::CellType;
use crate::duplicates::duplicate_cells;
use crate::mesh::{CellBlock, Entity, Mesh};
use crate::physical_tags::PhysicalTags;

pub(super) fn mesh(contents: Contents, remarks: &mut Remarks) -> Result<Mesh, Fault> {
    if contents.nodes.tags.is_empty() {
        return Err(no_nodes(&contents));
    }
    let (nodes, index) = unique_nodes(contents.nodes, remarks)?;
    if contents.elements.is_empty() {
        remarks.general("the file has no $Elements section");
    }
    let blocks = merged_sections(contents.elements, remarks)?;
    remark_repeated_element_tags(&blocks, remarks);
    let mut unlisted = HashSet::new();
    let mut cells = Vec::with_capacity(blocks.len());
    for block in blocks {
        let connectivity = resolved(&block, &index)?;
        let listed = contents.entities.as_ref();
        let RawBlock {
            kind,
            element_tags,
            groups,
            ..
        } = block;
        let (physical, geometrical) =
            groups_of(groups, element_tags.len(), listed, &mut unlisted, remarks);
        cells.push(CellBlock {
            kind,
            connectivity,
            element_tags,
            physical,
            geometrical,
        });
    }
    let mesh = Mesh {
        points: nodes.points,
        node_tags: nodes.tags,
        node_entities: nodes.entities,
        cells,
        physical_names: contents.physical_names,
        skipped_sections: contents.skipped,
        ..Mesh::default()
    };
    remark_repeated_volume_cells(&mesh, remarks);
    remark_empty_groups(&mesh, remarks);
    Ok(mesh)
}

fn no_nodes(contents: &Contents) -> Fault {
    let problem = match (contents.has_nodes, contents.skipped.as_slice()) {
        (true, _) => "the file has no nodes: $Nodes is empty".to_owned(),
        (false, []) => "the file has no nodes: it has no $Nodes section".to_owned(),
        (false, skipped) => {
            let skipped: Vec<String> = skipped
                .iter()
                .take(5)
                .map(|name| format!("${}", name.escape_debug()))
                .collect();
            format!(
                "the file has no nodes: it has no $Nodes section (skipped: {})",
                skipped.join(", ")
            )
        }
    };
    Fault::new(contents.length, problem, "a $Nodes section with nodes")
}

/// Finds the index of a node by its tag.
struct NodeIndex {
    lookup: Lookup,
    least: u64,
    greatest: u64,
}

enum Lookup {
    /// `table[tag - least]` is the index plus one; 0 means there is no such node.
    Table(Vec<u32>),
    Map(HashMap<u64, u32>),
}

impl NodeIndex {
    fn of_range(tags: &[u64]) -> NodeIndex {
        let least = tags.iter().min().copied().unwrap_or(0);
        let greatest = tags.iter().max().copied().unwrap_or(0);
        let span = greatest - least;
        // A table is several times faster, but its size must not depend on tags that may be as large as 2^64.
        let lookup = if span <= 4 * tags.len() as u64 + 1024 {
            Lookup::Table(vec![0; usize::try_from(span).map_or(0, |span| span + 1)])
        } else {
            Lookup::Map(HashMap::with_capacity(tags.len()))
        };
        NodeIndex {
            lookup,
            least,
            greatest,
        }
    }

    fn get(&self, tag: u64) -> Option<u32> {
        match &self.lookup {
            Lookup::Map(map) => map.get(&tag).copied(),
            Lookup::Table(table) => {
                let slot = usize::try_from(tag.checked_sub(self.least)?).ok()?;
                table.get(slot)?.checked_sub(1)
            }
        }
    }

    /// The tag must be in the range the index was made for.
    fn insert(&mut self, tag: u64, index: u32) {
        match &mut self.lookup {
            Lookup::Map(map) => {
                map.insert(tag, index);
            }
            Lookup::Table(table) => {
                let slot = tag
                    .checked_sub(self.least)
                    .and_then(|slot| usize::try_from(slot).ok());
                if let Some(entry) = slot.and_then(|slot| table.get_mut(slot)) {
                    *entry = index + 1;
                }
            }
        }
    }
}

/// Drops repeated rows, and indexes the rest by tag.
fn unique_nodes(raw: RawNodes, remarks: &mut Remarks) -> Result<(RawNodes, NodeIndex), Fault> {
    let mut index = NodeIndex::of_range(&raw.tags);
    let mut unique = RawNodes {
        tags: Vec::with_capacity(raw.tags.len()),
        points: Vec::with_capacity(raw.tags.len()),
        ..RawNodes::default()
    };
    let mut entities = raw.entities.into_iter();
    let mut first_repeated = None;
    let mut repeated: usize = 0;
    for ((tag, point), offset) in raw.tags.into_iter().zip(raw.points).zip(raw.offsets) {
        let entity = entities.next();
        let Some(earlier) = index.get(tag) else {
            index.insert(tag, next_index(unique.tags.len(), offset)?);
            unique.tags.push(tag);
            unique.points.push(point);
            unique.entities.extend(entity);
            continue;
        };
        if unique.points.get(earlier as usize) != Some(&point) {
            let problem = format!("node tag {tag} occurs again, with other coordinates");
            return Err(Fault::new(offset, problem, "each tag once").inside("$Nodes"));
        }
        first_repeated = first_repeated.or(Some((tag, offset)));
        repeated += 1;
    }
    if let Some((tag, offset)) = first_repeated {
        let message = format!(
            "$Nodes: rows that repeat an earlier node and were merged with it: {repeated} (first: tag {tag})"
        );
        remarks.at(offset, message);
    }
    Ok((unique, index))
}

fn next_index(count: usize, offset: usize) -> Result<u32, Fault> {
    match u32::try_from(count) {
        // The last value stands for "no node" elsewhere.
        Ok(index) if index < u32::MAX => Ok(index),
        _ => Err(Fault::unsupported(
            offset,
            format!("the file has more than {} nodes", u32::MAX - 1),
            "split the mesh",
        )
        .inside("$Nodes")),
    }
}

/// The blocks of all `$Elements` sections; rows of later sections that repeat an earlier one are dropped.
fn merged_sections(
    sections: Vec<ElementSection>,
    remarks: &mut Remarks,
) -> Result<Vec<RawBlock>, Fault> {
    let mut sections = sections.into_iter();
    let mut blocks = sections.next().unwrap_or_default().blocks;
    for section in sections {
        let mut known: HashMap<u64, (CellType, &[u64])> = HashMap::new();
        for block in &blocks {
            let rows = block.node_tags.chunks_exact(block.kind.node_count());
            for (&tag, row) in block.element_tags.iter().zip(rows) {
                known.insert(tag, (block.kind, row));
            }
        }
        let mut new_blocks = Vec::new();
        let mut repeated = 0;
        for block in section.blocks {
            let (block, dropped) = without_known_rows(block, &known)?;
            repeated += dropped;
            new_blocks.push(block);
        }
        if repeated > 0 {
            remarks.general(format!(
                "$Elements occurs again: rows that repeat earlier ones and were merged with them: {repeated}"
            ));
        }
        blocks.extend(new_blocks);
    }
    Ok(blocks)
}

fn without_known_rows(
    block: RawBlock,
    known: &HashMap<u64, (CellType, &[u64])>,
) -> Result<(RawBlock, usize), Fault> {
    let mut is_new = Vec::with_capacity(block.element_tags.len());
    let rows = block.node_tags.chunks_exact(block.kind.node_count());
    for (cell, (&tag, row)) in block.element_tags.iter().zip(rows).enumerate() {
        match known.get(&tag) {
            None => is_new.push(true),
            Some(&(kind, nodes)) if kind == block.kind && nodes == row => is_new.push(false),
            Some(_) => {
                let offset = block.offsets.get(cell).copied().unwrap_or(0);
                let problem = format!(
                    "element tag {tag} occurs in an earlier $Elements section, with other nodes"
                );
                return Err(block.place(Fault::new(offset, problem, "each element once"), cell));
            }
        }
    }
    let dropped = is_new.iter().filter(|&&new| !new).count();
    Ok((keep_rows(block, &is_new), dropped))
}

fn keep_rows(block: RawBlock, keep: &[bool]) -> RawBlock {
    let kept = |cell: usize| keep.get(cell).copied().unwrap_or(false);
    let rows = block.node_tags.chunks_exact(block.kind.node_count());
    RawBlock {
        node_tags: rows
            .enumerate()
            .filter(|(cell, _)| kept(*cell))
            .flat_map(|(_, row)| row)
            .copied()
            .collect(),
        element_tags: kept_only(&block.element_tags, &kept),
        offsets: kept_only(&block.offsets, &kept),
        groups: match block.groups {
            RawGroups::OfEntity { entity, offset } => RawGroups::OfEntity { entity, offset },
            RawGroups::OfEach {
                physical,
                geometrical,
            } => RawGroups::OfEach {
                geometrical: kept_only(&geometrical, &kept),
                physical: {
                    let mut kept_physical = PhysicalTags::new();
                    for cell in (0..physical.len()).filter(|&cell| kept(cell)) {
                        kept_physical.push(physical.of(cell));
                    }
                    kept_physical
                },
            },
        },
        kind: block.kind,
        number: block.number,
    }
}

fn kept_only<T: Copy>(all: &[T], kept: &impl Fn(usize) -> bool) -> Vec<T> {
    all.iter()
        .enumerate()
        .filter(|(cell, _)| kept(*cell))
        .map(|(_, &value)| value)
        .collect()
}

/// Indices in VTK order for the node tags of a block.
fn resolved(block: &RawBlock, index: &NodeIndex) -> Result<Vec<u32>, Fault> {
    let order = block.kind.vtk_order_in_gmsh_row();
    let mut connectivity = Vec::with_capacity(block.node_tags.len());
    let mut row = Vec::with_capacity(block.kind.node_count());
    for (cell, tags) in block
        .node_tags
        .chunks_exact(block.kind.node_count())
        .enumerate()
    {
        row.clear();
        for &tag in tags {
            row.push(
                index
                    .get(tag)
                    .ok_or_else(|| unknown_node(block, cell, tag, index))?,
            );
        }
        match order {
            None => connectivity.extend_from_slice(&row),
            Some(order) => {
                connectivity.extend(order.iter().filter_map(|&i| row.get(usize::from(i))));
            }
        }
    }
    Ok(connectivity)
}

fn unknown_node(block: &RawBlock, cell: usize, tag: u64, index: &NodeIndex) -> Fault {
    let offset = block.offsets.get(cell).copied().unwrap_or(0);
    let problem = format!(
        "node tag {tag} is not in $Nodes (tags {}..{})",
        index.least, index.greatest
    );
    block.place(Fault::new(offset, problem, "an existing node tag"), cell)
}

fn groups_of(
    groups: RawGroups,
    cells: usize,
    entities: Option<&Entities>,
    unlisted: &mut HashSet<Entity>,
    remarks: &mut Remarks,
) -> (PhysicalTags, Vec<i32>) {
    match groups {
        RawGroups::OfEach {
            physical,
            geometrical,
        } => (physical, geometrical),
        RawGroups::OfEntity { entity, offset } => {
            let listed = entities.and_then(|entities| entities.get(&entity));
            if listed.is_none() && entities.is_some() && unlisted.insert(entity) {
                let message = format!(
                    "$Elements: entity {} of dimension {} is not in $Entities; its elements are in no group",
                    entity.tag, entity.dim
                );
                remarks.at(offset, message);
            }
            let tags = listed.map_or(&[] as &[i32], Vec::as_slice);
            (PhysicalTags::uniform(tags, cells), vec![entity.tag; cells])
        }
    }
}

fn remark_repeated_element_tags(blocks: &[RawBlock], remarks: &mut Remarks) {
    let tags = || blocks.iter().flat_map(|block| &block.element_tags).copied();
    if tags().is_sorted_by(|a, b| a < b) {
        return;
    }
    let mut sorted: Vec<u64> = tags().collect();
    sorted.sort_unstable();
    let repeats = || {
        sorted
            .iter()
            .zip(sorted.iter().skip(1))
            .filter(|(a, b)| a == b)
    };
    if let Some((tag, _)) = repeats().next() {
        remarks.general(format!(
            "$Elements: elements with the tag of another: {} (first: tag {tag}); all are kept",
            repeats().count()
        ));
    }
}

fn remark_repeated_volume_cells(mesh: &Mesh, remarks: &mut Remarks) {
    let mut by_kind: BTreeMap<CellType, (Vec<u32>, Vec<u64>)> = BTreeMap::new();
    for block in mesh.cells.iter().filter(|block| block.kind.dim() == 3) {
        let (connectivity, tags) = by_kind.entry(block.kind).or_default();
        connectivity.extend_from_slice(&block.connectivity);
        tags.extend_from_slice(&block.element_tags);
    }
    for (kind, (connectivity, tags)) in by_kind {
        let copies = duplicate_cells(&connectivity, kind.node_count());
        if let Some(&(first, copy)) = copies.first() {
            let tag = |cell: usize| tags.get(cell).copied().unwrap_or_default();
            remarks.general(format!(
                "$Elements: {kind} cells with the same nodes as another: {} (first: tag {} repeats tag {}); all are \
                 kept, so volumes count twice until they are merged",
                copies.len(),
                tag(copy),
                tag(first),
            ));
        }
    }
}

fn remark_empty_groups(mesh: &Mesh, remarks: &mut Remarks) {
    let mut used: HashSet<(u8, i32)> = HashSet::new();
    for block in &mesh.cells {
        for tag in block.physical.lists().flatten() {
            used.insert((block.kind.dim(), tag.saturating_abs()));
        }
    }
    for (&(dim, tag), name) in &mesh.physical_names {
        if !used.contains(&(dim, tag.saturating_abs())) {
            remarks.general(format!(
                "$PhysicalNames: group \"{}\" (dimension {dim}, tag {tag}) is named, but no cell belongs to it",
                name.escape_debug()
            ));
        }
    }
}
