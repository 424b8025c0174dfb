//! `$Nodes`: coordinates under tags.

use super::cursor::Cursor;
use super::fault::Fault;
use super::physical_names::dimension;
use super::remarks::Remarks;
use super::rows_of_lines::read_row;
use super::section::end_section;
use super::source::{Record, Source, Text};
use crate::mesh::Entity;

/// Node rows in file order, duplicates included.
#[derive(Debug, Default)]
pub(super) struct RawNodes {
    pub(super) tags: Vec<u64>,
    pub(super) points: Vec<[f64; 3]>,
    /// Where the tag of each node stands.
    pub(super) offsets: Vec<usize>,
    /// Empty in version 2.
    pub(super) entities: Vec<Entity>,
}

fn push_tag(source: &mut impl Source, nodes: &mut RawNodes) -> Result<(), Fault> {
    let offset = source.next_offset();
    let tag = source.size("the node tag")?;
    if tag == 0 {
        return Err(Fault::new(
            offset,
            "the node tag is 0",
            "a tag of at least 1",
        ));
    }
    nodes.tags.push(tag);
    nodes.offsets.push(offset);
    Ok(())
}

fn coordinates(source: &mut impl Source) -> Result<[f64; 3], Fault> {
    let x = source.finite("the x coordinate")?;
    let y = source.finite("the y coordinate")?;
    let z = source.finite("the z coordinate")?;
    Ok([x, y, z])
}

/// The whole section of version 2.2 as text, up to and including `$EndNodes`.
pub(super) fn read_v22_text(
    cursor: &mut Cursor<'_>,
    nodes: &mut RawNodes,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    let mut source = Text::new(cursor);
    let total = source.size("the number of nodes")?;
    let row = Record {
        ints: 1,
        doubles: 3,
        ..Record::default()
    };
    let count = source.room_for(total, "the number of nodes", row)?;
    nodes.tags.reserve(count);
    nodes.points.reserve(count);
    nodes.offsets.reserve(count);
    for number in 1..=total {
        read_row(cursor, ("node", number, total), |cursor| {
            let mut source = Text::new(cursor);
            push_tag(&mut source, nodes)?;
            nodes.points.push(coordinates(&mut source)?);
            Ok(())
        })?;
    }
    end_section(
        cursor,
        "Nodes",
        &format!("the declared {total} nodes"),
        remarks,
    )
}

/// The section of version 4.1 without its last line.
pub(super) fn read_v41(
    source: &mut impl Source,
    nodes: &mut RawNodes,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    let header = source.next_offset();
    let blocks = source.size("the number of blocks")?;
    let total = source.size("the number of nodes")?;
    let declared_range = (
        source.size("the least node tag")?,
        source.size("the greatest node tag")?,
    );
    let block_header = Record {
        ints: 3,
        sizes: 1,
        ..Record::default()
    };
    source.room_for(blocks, "the number of blocks", block_header)?;
    let first = nodes.tags.len();
    for number in 1..=blocks {
        read_v41_block(source, nodes).map_err(|fault| fault.in_record("block", number, blocks))?;
    }
    let tags = nodes.tags.get(first..).unwrap_or_default();
    compare_with_header(
        tags,
        total,
        declared_range,
        header,
        "$Nodes",
        "nodes",
        remarks,
    );
    Ok(())
}

/// Warns if a version 4 header does not describe what its blocks hold.
pub(super) fn compare_with_header(
    tags: &[u64],
    declared_total: u64,
    declared_range: (u64, u64),
    offset: usize,
    section: &str,
    things: &str,
    remarks: &mut Remarks,
) {
    let total = tags.len() as u64;
    if declared_total != total {
        remarks.at(
            offset,
            format!("{section}: the header says {declared_total} {things}, its blocks hold {total}; the blocks count"),
        );
    }
    if let (Some(&least), Some(&greatest)) = (tags.iter().min(), tags.iter().max())
        && declared_range != (least, greatest)
    {
        let (low, high) = declared_range;
        remarks.at(
            offset,
            format!("{section}: the header says tags {low}..{high}, they are {least}..{greatest}"),
        );
    }
}

fn read_v41_block(source: &mut impl Source, nodes: &mut RawNodes) -> Result<(), Fault> {
    let header = source.next_offset();
    let dim = dimension(source.int("the entity dimension")?, header)?;
    let entity = Entity {
        dim,
        tag: source.int("the entity tag")?,
    };
    let flag = source.next_offset();
    let parameters = match source.int("the parametric flag")? {
        0 => 0,
        1 => u64::from(dim),
        other => {
            let problem = format!("the parametric flag is {other}");
            return Err(Fault::new(flag, problem, "0 or 1"));
        }
    };
    let total = source.size("the number of nodes in the block")?;
    let row = Record {
        sizes: 1,
        doubles: 3 + parameters,
        ..Record::default()
    };
    let count = source.room_for(total, "the number of nodes in the block", row)?;
    nodes.tags.reserve(count);
    nodes.points.reserve(count);
    nodes.offsets.reserve(count);
    for number in 1..=total {
        push_tag(source, nodes).map_err(|fault| fault.in_record("tag", number, total))?;
    }
    for number in 1..=total {
        read_v41_point(source, parameters, nodes)
            .map_err(|fault| fault.in_record("node", number, total))?;
    }
    nodes.entities.resize(nodes.tags.len(), entity);
    Ok(())
}

fn read_v41_point(
    source: &mut impl Source,
    parameters: u64,
    nodes: &mut RawNodes,
) -> Result<(), Fault> {
    nodes.points.push(coordinates(source)?);
    for _ in 0..parameters {
        source.double("a parametric coordinate")?;
    }
    Ok(())
}
