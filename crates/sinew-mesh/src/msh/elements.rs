//! `$Elements`: node tags of cells, by type.

use super::framing::count_line;
use super::header::{Format, Version, with_source};
use super::nodes::{Header, entity_of_block};
use super::places::{Layout, RowPlaces};
use super::rows_of_lines::read_row;
use super::source::{Record, Source, TagKind, Text};
use super::tag_list::TagList;
use crate::cell_type::CellType;
use crate::mesh::Entity;
use crate::physical_tags::PhysicalTags;
use crate::reading::cursor::Cursor;
use crate::reading::fault::Fault;
use crate::reading::remarks::Remarks;

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
    pub(super) node_tags: TagList,
    pub(super) groups: RawGroups,
    pub(super) place: BlockPlace,
}

/// The groups of a block's elements, in the form of the file.
#[derive(Debug)]
pub(super) enum RawGroups {
    /// Version 4: the groups of the entity of the block, which is at `offset`.
    OfEntity { entity: Entity, offset: usize },
    /// Versions 1 and 2: the groups in each element's row.
    OfEach {
        physical: PhysicalTags,
        geometrical: Vec<i32>,
    },
}

/// The places of a block's elements in the file, for messages.
#[derive(Debug)]
pub(super) struct BlockPlace {
    number: BlockNumber,
    rows: RowPlaces,
}

/// The numbering of a block's elements in messages.
#[derive(Debug, Clone, Copy)]
enum BlockNumber {
    /// Version 4: within the block with this number, from 1.
    InFile(u64),
    /// Versions 1 and 2 have no blocks: from the number, from 1, of this block's first element.
    FirstElement(u64),
}

impl BlockPlace {
    /// A fault in one of the block's elements; `cell` counts from 0, `section` is that of the elements.
    pub(super) fn fault(
        &self,
        section: &str,
        cell: usize,
        bytes: &[u8],
        problem: String,
        expected: &str,
    ) -> Fault {
        let fault = Fault::new(self.rows.offset(cell, bytes), problem, expected);
        let cell = cell as u64;
        let fault = match self.number {
            BlockNumber::InFile(block) => fault
                .inside(format!("element {}", cell + 1))
                .inside(format!("block {block}")),
            BlockNumber::FirstElement(first) => fault.inside(format!("element {}", first + cell)),
        };
        fault.inside(section)
    }
}

impl RawBlock {
    fn new(kind: CellType, groups: RawGroups, number: BlockNumber) -> RawBlock {
        RawBlock {
            kind,
            element_tags: Vec::new(),
            node_tags: TagList::default(),
            groups,
            place: BlockPlace {
                number,
                rows: RowPlaces::default(),
            },
        }
    }

    fn add_run(&mut self, offset: usize, layout: Layout) {
        let first_row = self.element_tags.len();
        self.place.rows.add_run(first_row, offset, layout);
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

/// The blocks of versions 1 and 2: consecutive rows of one type share a block, as in meshio.
#[derive(Default)]
struct BlocksOfRows {
    complete: Vec<RawBlock>,
    open: Option<RawBlock>,
}

impl BlocksOfRows {
    /// The block for a row of this type; `number` is the row's, from 1.
    fn block(&mut self, kind: CellType, number: u64) -> &mut RawBlock {
        if self.open.as_ref().is_some_and(|open| open.kind != kind) {
            self.complete.extend(self.open.take());
        }
        self.open.get_or_insert_with(|| {
            let groups = RawGroups::OfEach {
                physical: PhysicalTags::new(),
                geometrical: Vec::new(),
            };
            RawBlock::new(kind, groups, BlockNumber::FirstElement(number))
        })
    }

    fn into_section(mut self) -> ElementSection {
        self.complete.extend(self.open.take());
        ElementSection {
            blocks: self.complete,
        }
    }
}

/// The tags of a row of version 1 or 2. The first is the physical group, the second the geometrical entity; partitions,
/// parents and domains follow, and belong to no group.
fn read_tags(source: &mut impl Source, count: u64, block: &mut RawBlock) -> Result<(), Fault> {
    let (mut physical_tag, mut geometrical_tag) = (0, 0);
    for index in 0..count {
        match index {
            0 => physical_tag = source.int("the physical tag")?,
            1 => geometrical_tag = source.int("the geometrical tag")?,
            _ => {
                source.int("a further tag")?;
            }
        }
    }
    if let RawGroups::OfEach {
        physical,
        geometrical,
    } = &mut block.groups
    {
        physical.push(&[physical_tag]);
        geometrical.push(geometrical_tag);
    }
    Ok(())
}

fn read_nodes(source: &mut impl Source, kind: TagKind, block: &mut RawBlock) -> Result<(), Fault> {
    for _ in 0..block.kind.node_count() {
        block.node_tags.push(source.tag(kind, "a node tag")?);
    }
    Ok(())
}

/// The section of version 1, without its last line, and the number of elements it declares.
pub(super) fn read_v1(cursor: &mut Cursor<'_>) -> Result<(ElementSection, u64), Fault> {
    let mut source = Text::new(cursor);
    let total = source.size("the number of elements")?;
    // The row of a point: five numbers and a node.
    source.room_for(total, "the number of elements", Record::ints(6))?;
    let mut blocks = BlocksOfRows::default();
    for number in 1..=total {
        read_row(cursor, ("element", number, total), |cursor| {
            read_v1_row(&mut Text::new(cursor), number, &mut blocks)
        })?;
    }
    Ok((blocks.into_section(), total))
}

/// Reads `tag type physical geometrical nodes`, then the nodes.
fn read_v1_row(
    source: &mut Text<'_, '_>,
    number: u64,
    blocks: &mut BlocksOfRows,
) -> Result<(), Fault> {
    let offset = source.next_offset();
    let element_tag = source.size("the element tag")?;
    let type_offset = source.next_offset();
    let kind = cell_type(source.int("the element type")?, type_offset)?;
    let nodes = kind.node_count();
    let block = blocks.block(kind, number);
    if block.element_tags.is_empty() {
        block.add_run(offset, Layout::Words(5 + nodes));
    }
    block.element_tags.push(element_tag);
    read_tags(source, 2, block)?;
    let count_offset = source.next_offset();
    let count = source.size("the number of nodes")?;
    if count != nodes as u64 {
        let problem = format!(
            "the number of nodes is {count} for element type {} ({kind})",
            kind.gmsh_id()
        );
        return Err(Fault::new(count_offset, problem, nodes.to_string()));
    }
    read_nodes(source, TagKind::Int, block)
}

/// The section of version 2 as text, without its last line, and the number of elements it declares.
pub(super) fn read_v2_text(cursor: &mut Cursor<'_>) -> Result<(ElementSection, u64), Fault> {
    let mut source = Text::new(cursor);
    let total = source.size("the number of elements")?;
    source.room_for(total, "the number of elements", Record::ints(4))?;
    let mut blocks = BlocksOfRows::default();
    for number in 1..=total {
        read_row(cursor, ("element", number, total), |cursor| {
            read_v2_text_row(&mut Text::new(cursor), number, &mut blocks)
        })?;
    }
    Ok((blocks.into_section(), total))
}

fn read_v2_text_row(
    source: &mut Text<'_, '_>,
    number: u64,
    blocks: &mut BlocksOfRows,
) -> Result<(), Fault> {
    let offset = source.next_offset();
    let element_tag = source.size("the element tag")?;
    let type_offset = source.next_offset();
    let kind = cell_type(source.int("the element type")?, type_offset)?;
    let tag_count = source.size("the number of tags")?;
    source.room_for(tag_count, "the number of tags", Record::ints(1))?;
    let block = blocks.block(kind, number);
    if block.element_tags.is_empty() {
        let nodes = kind.node_count();
        block.add_run(offset, Layout::ElementWords { nodes });
    }
    block.element_tags.push(element_tag);
    read_tags(source, tag_count, block)?;
    read_nodes(source, TagKind::Int, block)
}

/// The section of version 2 as bytes, without its last line, and the number of elements it declares. The number of
/// elements is text even in this case.
pub(super) fn read_v2_bytes(
    cursor: &mut Cursor<'_>,
    format: Format,
) -> Result<(ElementSection, u64), Fault> {
    let total = count_line(cursor, "the number of elements")?;
    let section = with_source!(format, cursor, source => read_v2_runs(source, total))?;
    Ok((section, total))
}

fn read_v2_runs(source: &mut impl Source, total: u64) -> Result<ElementSection, Fault> {
    // A row has at least its number and a node.
    source.room_for(total, "the number of elements", Record::ints(2))?;
    let mut blocks = BlocksOfRows::default();
    let mut done = 0;
    while done < total {
        let run = read_v2_run_header(source, done, total)
            .map_err(|fault| fault.in_record("element", done + 1, total))?;
        let block = blocks.block(run.kind, done + 1);
        let first = source.next_offset();
        block.add_run(first, source.layout(run.row()));
        for number in done + 1..=done + run.rows {
            read_v2_binary_row(source, run.tags, block)
                .map_err(|fault| fault.in_record("element", number, total))?;
        }
        done += run.rows;
    }
    Ok(blocks.into_section())
}

/// The header of rows of one type with the same number of tags.
struct Run {
    kind: CellType,
    rows: u64,
    tags: u64,
}

impl Run {
    fn row(&self) -> Record {
        Record::ints(1 + self.tags + self.kind.node_count() as u64)
    }
}

fn read_v2_run_header(source: &mut impl Source, done: u64, total: u64) -> Result<Run, Fault> {
    let type_offset = source.next_offset();
    let kind = cell_type(source.int("the element type")?, type_offset)?;
    let count_offset = source.next_offset();
    let count = source.int("the number of elements under the header")?;
    let left = total - done;
    let rows = match u64::try_from(count) {
        Ok(rows) if rows > 0 && rows <= left => rows,
        _ => {
            let problem = format!("the number of elements under the header is {count}");
            let expected = format!("1 to {left}, since the section has {total}");
            return Err(Fault::new(count_offset, problem, expected));
        }
    };
    let tags_offset = source.next_offset();
    let tags = source.int("the number of tags")?;
    let tags = u64::try_from(tags).map_err(|_| {
        let problem = format!("the number of tags is {tags}");
        Fault::new(tags_offset, problem, "a non-negative whole number")
    })?;
    let run = Run { kind, rows, tags };
    source.room_for(rows, "the number of elements under the header", run.row())?;
    Ok(run)
}

fn read_v2_binary_row(
    source: &mut impl Source,
    tags: u64,
    block: &mut RawBlock,
) -> Result<(), Fault> {
    let element_tag = source.tag(TagKind::Int, "the element tag")?;
    block.element_tags.push(element_tag);
    read_tags(source, tags, block)?;
    read_nodes(source, TagKind::Int, block)
}

/// The section of version 4 without its last line.
pub(super) fn read_v4(
    source: &mut impl Source,
    version: Version,
    remarks: &mut Remarks,
) -> Result<ElementSection, Fault> {
    let header = Header::read(source, version, "elements", "element")?;
    let mut section = ElementSection::default();
    for number in 1..=header.blocks {
        let block = read_v4_block(source, version, number)
            .map_err(|fault| fault.in_record("block", number, header.blocks))?;
        section.blocks.push(block);
    }
    let tags = section.blocks.iter().flat_map(|b| &b.element_tags).copied();
    header.compare("$Elements", "elements", tags, remarks);
    Ok(section)
}

fn read_v4_block(
    source: &mut impl Source,
    version: Version,
    number: u64,
) -> Result<RawBlock, Fault> {
    let header = source.next_offset();
    let entity = entity_of_block(source, version)?;
    let type_offset = source.next_offset();
    let kind = cell_type(source.int("the element type")?, type_offset)?;
    if kind.dim() != entity.dim {
        let problem = format!(
            "the element type is {} ({kind}, dimension {}) on an entity of dimension {}",
            kind.gmsh_id(),
            kind.dim(),
            entity.dim
        );
        return Err(Fault::new(
            type_offset,
            problem,
            format!("a type of dimension {}", entity.dim),
        ));
    }
    let what = "the number of elements in the block";
    let total = source.size(what)?;
    let tag_kind = match version {
        Version::V41 => TagKind::Size,
        _ => TagKind::Int,
    };
    let nodes = kind.node_count();
    let row = Record::tags(tag_kind, 1 + nodes as u64);
    let count = source.room_for(total, what, row)?;
    let groups = RawGroups::OfEntity {
        entity,
        offset: header,
    };
    let mut block = RawBlock::new(kind, groups, BlockNumber::InFile(number));
    let first = source.next_offset();
    block.add_run(first, source.layout(row));
    block.element_tags.reserve_exact(count);
    block.node_tags.reserve_exact(count * nodes);
    source.element_rows(
        tag_kind,
        count,
        nodes,
        &mut block.element_tags,
        &mut block.node_tags,
    )?;
    Ok(block)
}
