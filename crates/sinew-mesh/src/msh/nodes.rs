//! `$Nodes` and `$ParametricNodes`: coordinates under tags.

use super::framing::count_line;
use super::header::{Format, Version, with_source};
use super::physical_names::dimension;
use super::places::{Layout, RowPlaces};
use super::rows_of_lines::read_row;
use super::source::{Record, Source, TagKind, Text};
use crate::mesh::Entity;
use crate::reading::cursor::Cursor;
use crate::reading::fault::Fault;
use crate::reading::remarks::Remarks;

/// Node rows in file order, duplicates included.
#[derive(Debug, Default)]
pub(super) struct RawNodes {
    pub(super) tags: Vec<u64>,
    pub(super) points: Vec<[f64; 3]>,
    /// The place of each node's tag in the file.
    pub(super) places: RowPlaces,
    /// The entity of each node; empty in versions 1 and 2, except for nodes with parametric coordinates.
    pub(super) entities: Vec<Entity>,
}

impl RawNodes {
    fn reserve(&mut self, count: usize) {
        self.tags.reserve_exact(count);
        self.points.reserve_exact(count);
    }
}

/// The section of version 1, or of version 2 as text, without its last line.
pub(super) fn read_rows(cursor: &mut Cursor<'_>, nodes: &mut RawNodes) -> Result<u64, Fault> {
    let mut source = Text::new(cursor);
    let total = source.size("the number of nodes")?;
    let row = Record::ints(1).and_doubles(3);
    let count = source.room_for(total, "the number of nodes", row)?;
    nodes.reserve(count);
    let first = source.next_offset();
    let layout = source.layout(row);
    nodes.places.add_run(nodes.tags.len(), first, layout);
    for number in 1..=total {
        read_row(cursor, ("node", number, total), |cursor| {
            let mut source = Text::new(cursor);
            nodes.tags.push(source.node_tag(TagKind::Int)?);
            nodes.points.push(source.point()?);
            Ok(())
        })?;
    }
    Ok(total)
}

/// The section of version 2 as bytes, without its last line. Its count is text even in this case.
pub(super) fn read_v2_bytes(
    cursor: &mut Cursor<'_>,
    format: Format,
    nodes: &mut RawNodes,
) -> Result<u64, Fault> {
    let total = count_line(cursor, "the number of nodes")?;
    with_source!(format, cursor, source => {
        read_tagged_points(source, total, "the number of nodes", 0, nodes)?;
    });
    Ok(total)
}

/// Reads rows of a node's tag, its coordinates and numbers that are skipped.
fn read_tagged_points(
    source: &mut impl Source,
    total: u64,
    what: &str,
    parameters: usize,
    nodes: &mut RawNodes,
) -> Result<(), Fault> {
    let row = Record::ints(1).and_doubles(3 + parameters as u64);
    let count = source.room_for(total, what, row)?;
    nodes.reserve(count);
    let first = source.next_offset();
    let layout = source.layout(row);
    nodes.places.add_run(nodes.tags.len(), first, layout);
    for number in 1..=total {
        let mut row = || {
            nodes.tags.push(source.node_tag(TagKind::Int)?);
            nodes.points.push(source.point()?);
            (0..parameters).try_for_each(|_| source.double("a parametric coordinate").map(drop))
        };
        row().map_err(|fault| fault.in_record("node", number, total))?;
    }
    Ok(())
}

/// `$ParametricNodes` of version 2, without its last line: nodes with their entity, and their parameters on it.
pub(super) fn read_v2_parametric(
    source: &mut impl Source,
    total: u64,
    nodes: &mut RawNodes,
) -> Result<(), Fault> {
    let least = Record::ints(3).and_doubles(3);
    let count = source.room_for(total, "the number of nodes", least)?;
    nodes.reserve(count);
    for number in 1..=total {
        read_parametric_row(source, nodes)
            .map_err(|fault| fault.in_record("node", number, total))?;
    }
    Ok(())
}

fn read_parametric_row(source: &mut impl Source, nodes: &mut RawNodes) -> Result<(), Fault> {
    let offset = source.next_offset();
    nodes
        .places
        .add_run(nodes.tags.len(), offset, Layout::Bytes(0));
    let tag = source.node_tag(TagKind::Int)?;
    let point = source.point()?;
    let dim_offset = source.next_offset();
    let dim = dimension(source.int("the entity dimension")?, dim_offset)?;
    let entity = Entity {
        dim,
        tag: source.int("the entity tag")?,
    };
    // gmsh gives one number on a curve, two on a surface, and none at a point or in a volume.
    let parameters = if dim == 3 { 0 } else { dim };
    for _ in 0..parameters {
        source.double("a parametric coordinate")?;
    }
    if nodes.entities.len() == nodes.tags.len() {
        nodes.entities.push(entity);
    }
    nodes.tags.push(tag);
    nodes.points.push(point);
    Ok(())
}

/// The section of version 4 without its last line.
pub(super) fn read_v4(
    source: &mut impl Source,
    version: Version,
    nodes: &mut RawNodes,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    let header = Header::read(source, version, "nodes", "node")?;
    let first = nodes.tags.len();
    for number in 1..=header.blocks {
        read_v4_block(source, version, nodes)
            .map_err(|fault| fault.in_record("block", number, header.blocks))?;
    }
    let tags = nodes.tags.get(first..).unwrap_or_default();
    header.compare("$Nodes", "nodes", tags.iter().copied(), remarks);
    Ok(())
}

/// The first line of `$Nodes` and `$Elements` in version 4.
pub(super) struct Header {
    offset: usize,
    pub(super) blocks: u64,
    total: u64,
    /// Version 4.1: least and greatest tag.
    range: Option<(u64, u64)>,
}

impl Header {
    pub(super) fn read(
        source: &mut impl Source,
        version: Version,
        things: &str,
        thing: &str,
    ) -> Result<Header, Fault> {
        let offset = source.next_offset();
        let blocks = source.size("the number of blocks")?;
        let total = source.size(&format!("the number of {things}"))?;
        let range = if version == Version::V40 {
            None
        } else {
            Some((
                source.size(&format!("the least {thing} tag"))?,
                source.size(&format!("the greatest {thing} tag"))?,
            ))
        };
        let block_header = Record {
            ints: 3,
            sizes: 1,
            ..Record::default()
        };
        source.room_for(blocks, "the number of blocks", block_header)?;
        Ok(Header {
            offset,
            blocks,
            total,
            range,
        })
    }

    /// Warns if the header contradicts the blocks.
    pub(super) fn compare(
        &self,
        section: &str,
        things: &str,
        tags: impl Iterator<Item = u64>,
        remarks: &mut Remarks,
    ) {
        let (mut total, mut least, mut greatest) = (0u64, u64::MAX, 0);
        for tag in tags {
            total += 1;
            least = least.min(tag);
            greatest = greatest.max(tag);
        }
        if self.total != total {
            remarks.at(
                self.offset,
                format!(
                    "{section}: the header says {} {things}, its blocks hold {total}; the blocks count",
                    self.total
                ),
            );
        }
        if let Some((low, high)) = self.range
            && total > 0
            && (low, high) != (least, greatest)
        {
            remarks.at(
                self.offset,
                format!(
                    "{section}: the header says tags {low}..{high}, they are {least}..{greatest}"
                ),
            );
        }
    }
}

/// The entity of a block: in version 4.0 the tag comes first.
pub(super) fn entity_of_block(source: &mut impl Source, version: Version) -> Result<Entity, Fault> {
    let first = source.next_offset();
    if version == Version::V40 {
        let tag = source.int("the entity tag")?;
        let offset = source.next_offset();
        let dim = dimension(source.int("the entity dimension")?, offset)?;
        return Ok(Entity { dim, tag });
    }
    let dim = dimension(source.int("the entity dimension")?, first)?;
    let tag = source.int("the entity tag")?;
    Ok(Entity { dim, tag })
}

fn read_v4_block(
    source: &mut impl Source,
    version: Version,
    nodes: &mut RawNodes,
) -> Result<(), Fault> {
    let entity = entity_of_block(source, version)?;
    let flag = source.next_offset();
    let parameters = match source.int("the parametric flag")? {
        0 => 0,
        1 => usize::from(entity.dim),
        other => {
            let problem = format!("the parametric flag is {other}");
            return Err(Fault::new(flag, problem, "0 or 1"));
        }
    };
    let what = "the number of nodes in the block";
    let total = source.size(what)?;
    if version == Version::V40 {
        read_tagged_points(source, total, what, parameters, nodes)?;
    } else {
        let row = Record::tags(TagKind::Size, 1).and_doubles(3 + parameters as u64);
        let count = source.room_for(total, what, row)?;
        nodes.reserve(count);
        let first = source.next_offset();
        let layout = source.layout(Record::tags(TagKind::Size, 1));
        nodes.places.add_run(nodes.tags.len(), first, layout);
        source.node_tags(count, &mut nodes.tags)?;
        source.points(count, parameters, &mut nodes.points)?;
    }
    nodes
        .entities
        .reserve_exact(nodes.tags.len() - nodes.entities.len());
    nodes.entities.resize(nodes.tags.len(), entity);
    Ok(())
}
