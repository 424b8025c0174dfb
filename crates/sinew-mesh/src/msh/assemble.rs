//! Turns tables of tags into a mesh of indices.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::assemble_data;
use super::contents::{Contents, Tables};
use super::elements::{BlockPlace, ElementSection, RawGroups};
use super::entities::Entities;
use super::nodes::RawNodes;
use super::physical_names::{NamesWithoutDim, PhysicalNames};
use super::tag_list::{TagList, Tags};
use crate::bounds::Bounds;
use crate::cell_type::CellType;
use crate::check::empty_groups;
use crate::mesh::{CellBlock, Entity, Mesh};
use crate::physical_tags::PhysicalTags;
use crate::reading::fault::Fault;
use crate::reading::remarks::Remarks;
use crate::reading::tag_index::TagIndex;

pub(super) fn mesh(contents: Contents, bytes: &[u8], remarks: &mut Remarks) -> Result<Mesh, Fault> {
    if contents.nodes.tags.is_empty() {
        return Err(no_nodes(&contents));
    }
    let tables = contents.tables;
    let Nodes {
        tags,
        points,
        entities,
        index,
    } = unique_nodes(contents.nodes, tables, bytes, remarks)?;
    if contents.elements.is_empty() {
        remarks.general(format!("the file has no {} section", tables.elements));
    }
    let groups = Groups {
        entities: contents.entities,
        parts: contents.parts,
        unlisted: HashSet::new(),
    };
    let resolver = Resolver {
        index: &index,
        tables,
        bytes,
    };
    let cells = cells(contents.elements, resolver, groups, remarks)?;
    remark_repeated_element_tags(&cells, tables, remarks);
    let mut physical_names = contents.physical_names;
    add_dimensions(contents.names_without_dim, &cells, &mut physical_names);
    let mut mesh = Mesh {
        points,
        node_tags: tags,
        node_entities: entities,
        cells,
        physical_names,
        periodic: contents.periodic,
        skipped_sections: contents.skipped,
        ..Mesh::default()
    };
    assemble_data::add(contents.data, &mut mesh, &index, bytes.len(), remarks)?;
    take_groups_from_data(&mut mesh, remarks);
    remark_unknown_periodic_nodes(&mesh, &index, remarks);
    remark_repeated_volume_cells(&mesh, tables, remarks);
    remark_empty_groups(&mesh, remarks);
    Ok(mesh)
}

fn no_nodes(contents: &Contents) -> Fault {
    let section = contents.tables.nodes;
    let problem = match (contents.has_nodes, contents.skipped.as_slice()) {
        (true, _) => format!("the file has no nodes: {section} is empty"),
        (false, []) => format!("the file has no nodes: it has no {section} section"),
        (false, skipped) => {
            let skipped: Vec<String> = skipped
                .iter()
                .take(5)
                .map(|name| format!("${}", name.escape_debug()))
                .collect();
            format!(
                "the file has no nodes: it has no {section} section (skipped: {})",
                skipped.join(", ")
            )
        }
    };
    let expected = format!("a {section} section with nodes");
    Fault::new(contents.length, problem, expected)
}

/// The nodes, each once.
struct Nodes {
    tags: Vec<u64>,
    points: Vec<[f64; 3]>,
    entities: Vec<Entity>,
    index: TagIndex,
}

/// Drops repeated rows, and indexes the rest by tag.
fn unique_nodes(
    raw: RawNodes,
    tables: Tables,
    bytes: &[u8],
    remarks: &mut Remarks,
) -> Result<Nodes, Fault> {
    let mut index = TagIndex::of_range(&raw.tags);
    let mut nodes = Nodes {
        entities: if raw.entities.len() == raw.tags.len() {
            raw.entities
        } else {
            Vec::new()
        },
        tags: raw.tags,
        points: raw.points,
        index: TagIndex::of_range(&[]),
    };
    next_index(nodes.tags.len().saturating_sub(1), tables)?;
    if !index.is_complete() {
        let mut is_repeated = Vec::new();
        let mut unique = 0;
        for (row, &tag) in nodes.tags.iter().enumerate() {
            if index.get(tag).is_none() {
                index.insert(tag, next_index(unique, tables)?);
                unique += 1;
            } else {
                is_repeated.resize(row, false);
                is_repeated.push(true);
            }
        }
        if !is_repeated.is_empty() {
            is_repeated.resize(nodes.tags.len(), false);
            drop_repeated(
                &mut nodes,
                &is_repeated,
                &index,
                |row| raw.places.offset(row, bytes),
                tables,
                remarks,
            )?;
        }
    }
    nodes.index = index;
    Ok(nodes)
}

fn drop_repeated(
    nodes: &mut Nodes,
    is_repeated: &[bool],
    index: &TagIndex,
    offset: impl Fn(usize) -> usize,
    tables: Tables,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    let repeated: Vec<(usize, u64, [f64; 3])> = nodes
        .tags
        .iter()
        .zip(&nodes.points)
        .zip(is_repeated)
        .enumerate()
        .filter_map(|(row, ((&tag, &point), &again))| again.then_some((row, tag, point)))
        .collect();
    keep_first(&mut nodes.tags, is_repeated);
    keep_first(&mut nodes.points, is_repeated);
    keep_first(&mut nodes.entities, is_repeated);
    let rounding = ROUNDING * extent(&nodes.points);
    let mut apart = Vec::new();
    for &(row, tag, point) in &repeated {
        let first = index.get(tag).and_then(|i| nodes.points.get(i as usize));
        let distance = first.map_or(f64::INFINITY, |first| distance(*first, point));
        if distance > rounding {
            let problem = format!("node tag {tag} occurs again, with other coordinates");
            return Err(Fault::new(offset(row), problem, "each tag once").inside(tables.nodes));
        }
        if distance > 0.0 {
            apart.push((tag, distance));
        }
    }
    if let Some(&(row, tag, _)) = repeated.first() {
        let by_rounding = match apart.as_slice() {
            [] => String::new(),
            [(tag, distance), ..] => format!(
                "; {} of them differ from it by rounding (first: tag {tag}, by {distance:.1e}), and its coordinates count",
                apart.len()
            ),
        };
        let message = format!(
            "{}: rows that repeat an earlier node and were merged with it: {} (first: tag {tag}){by_rounding}",
            tables.nodes,
            repeated.len()
        );
        remarks.at(offset(row), message);
    }
    Ok(())
}

/// The share of a mesh's extent by which rounding may change the position of a node.
const ROUNDING: f64 = 1e-9;

/// The longest side of the box about points.
fn extent(points: &[[f64; 3]]) -> f64 {
    let mut bounds = Bounds::default();
    points.iter().for_each(|&point| bounds.add(point));
    bounds.longest_side()
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
    squares.sum::<f64>().sqrt()
}

fn keep_first<T>(rows: &mut Vec<T>, is_repeated: &[bool]) {
    let mut again = is_repeated.iter();
    rows.retain(|_| !again.next().copied().unwrap_or(false));
}

fn next_index(count: usize, tables: Tables) -> Result<u32, Fault> {
    match u32::try_from(count) {
        // The last value means "no node" elsewhere.
        Ok(index) if index < u32::MAX => Ok(index),
        _ => Err(Fault::unsupported(
            0,
            format!("the file has more than {} nodes", u32::MAX - 1),
            "split the mesh",
        )
        .inside(tables.nodes)),
    }
}

/// The nodes, the file and the names of its sections: turns node tags into indices, or reports the place of a wrong
/// one.
#[derive(Clone, Copy)]
struct Resolver<'a> {
    index: &'a TagIndex,
    tables: Tables,
    bytes: &'a [u8],
}

/// The blocks of all sections of elements; rows of later sections that repeat an earlier one are dropped.
fn cells(
    sections: Vec<ElementSection>,
    resolver: Resolver<'_>,
    mut groups: Groups,
    remarks: &mut Remarks,
) -> Result<Vec<CellBlock>, Fault> {
    let mut cells: Vec<CellBlock> = Vec::new();
    for section in sections {
        let earlier = rows_by_tag(&cells);
        let mut repeated = 0;
        let mut new_blocks = Vec::with_capacity(section.blocks.len());
        for block in section.blocks {
            let place = block.place;
            let connectivity = resolver.resolved(block.kind, block.node_tags, &place)?;
            let mut cells = CellBlock::new(block.kind, connectivity);
            cells.element_tags = block.element_tags;
            (cells.physical, cells.geometrical) =
                groups.of_block(block.groups, cells.element_tags.len(), remarks);
            let dropped = match earlier.is_empty() {
                true => 0,
                false => resolver.drop_known_rows(&mut cells, &earlier, &place)?,
            };
            repeated += dropped;
            if dropped == 0 || !cells.is_empty() {
                new_blocks.push(cells);
            }
        }
        if repeated > 0 {
            remarks.general(format!(
                "{} occurs again: rows that repeat earlier ones and were merged with them: {repeated}",
                resolver.tables.elements
            ));
        }
        cells.extend(new_blocks);
    }
    Ok(cells)
}

fn rows_by_tag(cells: &[CellBlock]) -> HashMap<u64, (CellType, Vec<u32>)> {
    let rows = cells.iter().flat_map(|block| {
        let rows = block.element_tags.iter().zip(block.cells());
        rows.map(|(&tag, row)| (tag, (block.kind, row.to_vec())))
    });
    rows.collect()
}

impl Resolver<'_> {
    fn drop_known_rows(
        self,
        block: &mut CellBlock,
        known: &HashMap<u64, (CellType, Vec<u32>)>,
        place: &BlockPlace,
    ) -> Result<usize, Fault> {
        let elements = self.tables.elements;
        let mut is_new = Vec::with_capacity(block.len());
        for (cell, (&tag, row)) in block.element_tags.iter().zip(block.cells()).enumerate() {
            match known.get(&tag) {
                None => is_new.push(true),
                Some((kind, nodes)) if *kind == block.kind && nodes == row => is_new.push(false),
                Some(_) => {
                    let problem = format!(
                        "element tag {tag} occurs in an earlier {elements} section, with other nodes"
                    );
                    return Err(place.fault(
                        elements,
                        cell,
                        self.bytes,
                        problem,
                        "each element once",
                    ));
                }
            }
        }
        let dropped = is_new.iter().filter(|&&new| !new).count();
        if dropped > 0 {
            block.keep(&is_new);
        }
        Ok(dropped)
    }

    /// Indices in VTK order for the node tags of a block.
    fn resolved(
        self,
        kind: CellType,
        node_tags: TagList,
        place: &BlockPlace,
    ) -> Result<Vec<u32>, Fault> {
        let Resolver {
            index,
            tables,
            bytes,
        } = self;
        let unknown = |entry: usize, tag: u64| {
            let (least, greatest) = index.range();
            let problem = format!(
                "node tag {tag} is not in {} (tags {least}..{greatest})",
                tables.nodes
            );
            place.fault(
                tables.elements,
                entry / kind.node_count(),
                bytes,
                problem,
                "an existing node tag",
            )
        };
        let mut connectivity = match node_tags.into_tags() {
            Tags::Narrow(mut tags) if index.is_complete() => {
                // The tags are consecutive, so an index is a difference of tags.
                let (least, greatest) = index.range();
                let is_known = |tag: u32| (least..=greatest).contains(&u64::from(tag));
                if !tags.iter().fold(true, |all, &tag| all & is_known(tag)) {
                    let entry = tags.iter().position(|&tag| !is_known(tag)).unwrap_or(0);
                    let tag = tags.get(entry).copied().map_or(0, u64::from);
                    return Err(unknown(entry, tag));
                }
                tags.iter_mut().for_each(|tag| *tag -= least as u32);
                tags
            }
            Tags::Narrow(mut tags) => {
                for (entry, tag) in tags.iter_mut().enumerate() {
                    match index.get(u64::from(*tag)) {
                        Some(node) => *tag = node,
                        None => return Err(unknown(entry, u64::from(*tag))),
                    }
                }
                tags
            }
            Tags::Wide(tags) => {
                let nodes = tags.into_iter().enumerate();
                nodes
                    .map(|(entry, tag)| index.get(tag).ok_or_else(|| unknown(entry, tag)))
                    .collect::<Result<_, _>>()?
            }
        };
        if let Some(order) = kind.vtk_order_in_gmsh_row() {
            let mut gmsh_row = Vec::with_capacity(kind.node_count());
            for row in connectivity.chunks_exact_mut(kind.node_count()) {
                gmsh_row.clear();
                gmsh_row.extend_from_slice(row);
                for (node, &i) in row.iter_mut().zip(order) {
                    *node = gmsh_row.get(usize::from(i)).copied().unwrap_or(*node);
                }
            }
        }
        Ok(connectivity)
    }
}

/// Lookup of the groups that a block's elements belong to.
struct Groups {
    entities: Option<Entities>,
    /// In a partitioned mesh, blocks refer to these first.
    parts: Option<Entities>,
    /// Entities with a remark.
    unlisted: HashSet<Entity>,
}

impl Groups {
    fn of_block(
        &mut self,
        groups: RawGroups,
        cells: usize,
        remarks: &mut Remarks,
    ) -> (PhysicalTags, Vec<i32>) {
        let (entity, offset) = match groups {
            RawGroups::OfEach {
                physical,
                geometrical,
            } => return (physical, geometrical),
            RawGroups::OfEntity { entity, offset } => (entity, offset),
        };
        let is_told = self.entities.is_some() || self.parts.is_some();
        let listed = [&self.parts, &self.entities]
            .into_iter()
            .flatten()
            .find_map(|entities| entities.get(&entity));
        if listed.is_none() && is_told && self.unlisted.insert(entity) {
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

/// Gives names without a dimension, as version 2.0 has them, to the dimensions that have cells with the tag.
fn add_dimensions(names: NamesWithoutDim, cells: &[CellBlock], to: &mut PhysicalNames) {
    for (tag, name) in names {
        let mut dims: BTreeSet<u8> = BTreeSet::new();
        for block in cells {
            let is_in_group = |&other: &i32| other.saturating_abs() == tag;
            if block.physical.lists().flatten().any(is_in_group) {
                dims.insert(block.kind.dim());
            }
        }
        if dims.is_empty() {
            dims.insert(3);
        }
        for dim in dims {
            to.entry((dim, tag)).or_insert_with(|| name.clone());
        }
    }
}

/// Name of the data field under which meshio's version 4.0, which has no entities, stores the groups of cells.
fn take_groups_from_data(mesh: &mut Mesh, remarks: &mut Remarks) {
    const NAME: &str = "gmsh:physical";
    let is_in_group = |block: &CellBlock| block.physical.lists().flatten().next().is_some();
    let is_tag = |x: f64| x.fract() == 0.0 && x.abs() <= f64::from(i32::MAX);
    let data = mesh.cell_data.iter().find(|data| {
        let mut values = data.blocks.iter().flatten();
        data.name == NAME && data.components == 1 && values.all(|&x| is_tag(x))
    });
    let Some(data) = data else {
        return;
    };
    if mesh.cells.iter().any(is_in_group) {
        return;
    }
    for (block, values) in mesh.cells.iter_mut().zip(&data.blocks) {
        block.physical = PhysicalTags::new();
        for &tag in values {
            block.physical.push(&[tag as i32]);
        }
    }
    remarks.general(format!(
        "$ElementData: the groups of cells are those of \"{NAME}\", as meshio writes version 4.0"
    ));
}

fn remark_unknown_periodic_nodes(mesh: &Mesh, index: &TagIndex, remarks: &mut Remarks) {
    let tags = mesh.periodic.iter().flat_map(|link| &link.node_tags);
    let unknown = || {
        let tags = tags.clone().flatten().copied();
        tags.filter(|&tag| index.get(tag).is_none())
    };
    if let Some(first) = unknown().next() {
        remarks.general(format!(
            "$Periodic: node tags that are not in $Nodes: {} (first: {first})",
            unknown().count()
        ));
    }
}

fn remark_repeated_element_tags(blocks: &[CellBlock], tables: Tables, remarks: &mut Remarks) {
    if have_ascending_tags_apart(blocks) {
        return;
    }
    let tags = || blocks.iter().flat_map(|block| &block.element_tags).copied();
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
            "{}: elements with the tag of another: {} (first: tag {tag}); all are kept",
            tables.elements,
            repeats().count()
        ));
    }
}

/// True if the tags ascend within each block and the ranges of no two blocks overlap. Then no tag is repeated; most
/// files are like that.
fn have_ascending_tags_apart(blocks: &[CellBlock]) -> bool {
    let mut ranges = Vec::with_capacity(blocks.len());
    for block in blocks {
        let tags = &block.element_tags;
        if let (Some(first), Some(last)) = (tags.first(), tags.last()) {
            if !tags.is_sorted_by(|a, b| a < b) {
                return false;
            }
            ranges.push((first, last));
        }
    }
    ranges.sort_unstable();
    let mut neighbours = ranges.iter().zip(ranges.iter().skip(1));
    neighbours.all(|(before, after)| before.1 < after.0)
}

fn remark_repeated_volume_cells(mesh: &Mesh, tables: Tables, remarks: &mut Remarks) {
    for copies in mesh.duplicate_cells(3) {
        let Some(&(first, copy)) = copies.pairs.first() else {
            continue;
        };
        remarks.general(format!(
            "{}: {} cells with the same nodes as another: {} (first: tag {} repeats tag {}); all are \
             kept, so volumes count twice until they are merged",
            tables.elements,
            copies.kind,
            copies.pairs.len(),
            mesh.element_tag(copy),
            mesh.element_tag(first),
        ));
    }
}

fn remark_empty_groups(mesh: &Mesh, remarks: &mut Remarks) {
    for (dim, tag, name) in empty_groups(mesh) {
        remarks.general(format!(
            "$PhysicalNames: group \"{}\" (dimension {dim}, tag {tag}) is named, but no cell belongs to it",
            name.escape_debug()
        ));
    }
}
