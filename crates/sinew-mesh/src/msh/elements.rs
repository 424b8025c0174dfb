//! `$Elements`: node tags of cells, by type.

use super::cursor::Cursor;
use super::fault::Fault;
use super::nodes::compare_with_header;
use super::physical_names::dimension;
use super::remarks::Remarks;
use super::rows_of_lines::read_row;
use super::section::end_section;
use super::source::{Record, Source, Text};
use crate::cell_type::CellType;
use crate::mesh::Entity;
use crate::physical_tags::PhysicalTags;

/// One `$Elements` section.
#[derive(Debug, Default)]
pub(super) struct ElementSection {
    pub(super) blocks: Vec<RawBlock>,
}

/// Elements of one type, nodes by tag and in gmsh's order.
#[derive(Debug)]
pub(super) struct RawBlock {
    pub(super) kind: CellType,
    pub(super) element_tags: Vec<u64>,
    pub(super) node_tags: Vec<u64>,
    /// Where the row of each element starts.
    pub(super) offsets: Vec<usize>,
    pub(super) groups: RawGroups,
    pub(super) number: BlockNumber,
}

/// How a block's elements are attached to groups.
#[derive(Debug)]
pub(super) enum RawGroups {
    /// Version 4: by the entity of the block, which stands at `offset`.
    OfEntity { entity: Entity, offset: usize },
    /// Version 2: each by its own row.
    OfEach {
        physical: PhysicalTags,
        geometrical: Vec<i32>,
    },
}

/// How messages count the elements of a block.
#[derive(Debug, Clone, Copy)]
pub(super) enum BlockNumber {
    /// Version 4: within the block with this number, from 1.
    InFile(u64),
    /// Version 2 has no blocks: from the number, from 1, of this block's first element.
    FirstElement(u64),
}

impl RawBlock {
    fn new(kind: CellType, groups: RawGroups, number: BlockNumber) -> RawBlock {
        RawBlock {
            kind,
            element_tags: Vec::new(),
            node_tags: Vec::new(),
            offsets: Vec::new(),
            groups,
            number,
        }
    }

    /// Adds to a fault which of the block's elements it is about; `cell` counts from 0.
    pub(super) fn place(&self, fault: Fault, cell: usize) -> Fault {
        let cell = cell as u64;
        let fault = match self.number {
            BlockNumber::InFile(block) => fault
                .inside(format!("element {}", cell + 1))
                .inside(format!("block {block}")),
            BlockNumber::FirstElement(first) => fault.inside(format!("element {}", first + cell)),
        };
        fault.inside("$Elements")
    }
}

fn cell_type(id: i32, offset: usize) -> Result<CellType, Fault> {
    CellType::from_gmsh_id(id).ok_or_else(|| {
        let name = CellType::name_of_unread_gmsh_id(id);
        let problem = format!("the element type is {id} ({name}), which is not supported");
        Fault::new(
            offset,
            problem,
            "a supported type, e.g. 2 (triangle) or 4 (tetra)",
        )
    })
}

/// The whole section of version 2.2 as text, up to and including `$EndElements`.
pub(super) fn read_v22_text(
    cursor: &mut Cursor<'_>,
    remarks: &mut Remarks,
) -> Result<ElementSection, Fault> {
    let mut source = Text::new(cursor);
    let total = source.size("the number of elements")?;
    let row = Record {
        ints: 4,
        ..Record::default()
    };
    source.room_for(total, "the number of elements", row)?;
    let mut section = ElementSection::default();
    for number in 1..=total {
        read_row(cursor, ("element", number, total), |cursor| {
            read_v22_row(&mut Text::new(cursor), number, &mut section)
        })?;
    }
    let after = format!("the declared {total} elements");
    end_section(cursor, "Elements", &after, remarks)?;
    Ok(section)
}

fn read_v22_row(
    source: &mut impl Source,
    number: u64,
    section: &mut ElementSection,
) -> Result<(), Fault> {
    let offset = source.next_offset();
    let element_tag = source.size("the element tag")?;
    let type_offset = source.next_offset();
    let kind = cell_type(source.int("the element type")?, type_offset)?;
    let tag_count = source.size("the number of tags")?;
    let each = Record {
        ints: 1,
        ..Record::default()
    };
    source.room_for(tag_count, "the number of tags", each)?;
    let (mut physical_tag, mut geometrical_tag) = (0, 0);
    for index in 0..tag_count {
        // Partitions, parents and domains follow; they belong to no group.
        match index {
            0 => physical_tag = source.int("the physical tag")?,
            1 => geometrical_tag = source.int("the geometrical tag")?,
            _ => {
                source.int("a further tag")?;
            }
        }
    }
    // Consecutive rows of one type share a block, as in meshio.
    let mut block = match section.blocks.pop() {
        Some(last) if last.kind == kind => last,
        last => {
            section.blocks.extend(last);
            let groups = RawGroups::OfEach {
                physical: PhysicalTags::new(),
                geometrical: Vec::new(),
            };
            RawBlock::new(kind, groups, BlockNumber::FirstElement(number))
        }
    };
    block.element_tags.push(element_tag);
    block.offsets.push(offset);
    if let RawGroups::OfEach {
        physical,
        geometrical,
    } = &mut block.groups
    {
        physical.push(&[physical_tag]);
        geometrical.push(geometrical_tag);
    }
    read_nodes(source, &mut block)?;
    section.blocks.push(block);
    Ok(())
}

fn read_nodes(source: &mut impl Source, block: &mut RawBlock) -> Result<(), Fault> {
    for _ in 0..block.kind.node_count() {
        block.node_tags.push(source.size("a node tag")?);
    }
    Ok(())
}

/// The section of version 4.1 without its last line.
pub(super) fn read_v41(
    source: &mut impl Source,
    remarks: &mut Remarks,
) -> Result<ElementSection, Fault> {
    let header = source.next_offset();
    let blocks = source.size("the number of blocks")?;
    let total = source.size("the number of elements")?;
    let declared_range = (
        source.size("the least element tag")?,
        source.size("the greatest element tag")?,
    );
    let block_header = Record {
        ints: 3,
        sizes: 1,
        ..Record::default()
    };
    source.room_for(blocks, "the number of blocks", block_header)?;
    let mut section = ElementSection::default();
    for number in 1..=blocks {
        let block = read_v41_block(source, number)
            .map_err(|fault| fault.in_record("block", number, blocks))?;
        section.blocks.push(block);
    }
    let tags: Vec<u64> = section
        .blocks
        .iter()
        .flat_map(|b| &b.element_tags)
        .copied()
        .collect();
    compare_with_header(
        &tags,
        total,
        declared_range,
        header,
        "$Elements",
        "elements",
        remarks,
    );
    Ok(section)
}

fn read_v41_block(source: &mut impl Source, number: u64) -> Result<RawBlock, Fault> {
    let header = source.next_offset();
    let dim = dimension(source.int("the entity dimension")?, header)?;
    let entity = Entity {
        dim,
        tag: source.int("the entity tag")?,
    };
    let type_offset = source.next_offset();
    let kind = cell_type(source.int("the element type")?, type_offset)?;
    if kind.dim() != dim {
        let problem = format!(
            "the element type is {} ({kind}, dimension {}) on an entity of dimension {dim}",
            kind.gmsh_id(),
            kind.dim()
        );
        return Err(Fault::new(
            type_offset,
            problem,
            format!("a type of dimension {dim}"),
        ));
    }
    let total = source.size("the number of elements in the block")?;
    let row = Record {
        sizes: 1 + kind.node_count() as u64,
        ..Record::default()
    };
    let count = source.room_for(total, "the number of elements in the block", row)?;
    let groups = RawGroups::OfEntity {
        entity,
        offset: header,
    };
    let mut block = RawBlock::new(kind, groups, BlockNumber::InFile(number));
    block.element_tags.reserve(count);
    block.offsets.reserve(count);
    block.node_tags.reserve(count * kind.node_count());
    for number in 1..=total {
        read_v41_row(source, &mut block)
            .map_err(|fault| fault.in_record("element", number, total))?;
    }
    Ok(block)
}

fn read_v41_row(source: &mut impl Source, block: &mut RawBlock) -> Result<(), Fault> {
    block.offsets.push(source.next_offset());
    block.element_tags.push(source.size("the element tag")?);
    read_nodes(source, block)
}
