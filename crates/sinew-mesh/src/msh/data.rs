//! `$NodeData`, `$ElementData` and `$ElementNodeData`: values under tags.

use super::framing::count_line;
use super::header::{Encoding, Format};
use super::source::{Binary, Bytes, Record, SizeWidth, Source, TagKind, Text};
use crate::reading::cursor::{Cursor, LONGEST, Token, quoted};
use crate::reading::fault::Fault;
use crate::reading::number;
use crate::reading::remarks::Remarks;

/// The holders of the values of a section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Holder {
    Nodes,
    Elements,
    ElementNodes,
}

/// One section, its values under the tags of the file.
#[derive(Debug)]
pub(super) struct RawData {
    pub(super) holder: Holder,
    pub(super) name: String,
    pub(super) step: i32,
    pub(super) time: f64,
    pub(super) components: usize,
    pub(super) tags: Vec<u64>,
    /// Number of nodes of each row, for values at nodes of elements.
    pub(super) node_counts: Vec<u32>,
    pub(super) values: Vec<f64>,
    /// Offset of the section's first number.
    pub(super) offset: usize,
}

/// A section without its last line.
pub(super) fn read(
    cursor: &mut Cursor<'_>,
    format: Format,
    holder: Holder,
    remarks: &mut Remarks,
) -> Result<RawData, Fault> {
    let offset = cursor.offset();
    let name = read_name(cursor, remarks)?;
    let time = read_times(cursor)?;
    let [step, components, rows] = read_numbers(cursor)?;
    let step = number::signed(step, "the time step")?;
    let components = match number::unsigned(components, "the number of components")? {
        0 => {
            let problem = "the number of components is 0";
            return Err(Fault::new(components.offset, problem, "at least 1"));
        }
        count => usize::try_from(count).unwrap_or(usize::MAX),
    };
    let rows = number::unsigned(rows, "the number of rows")?;
    let mut data = RawData {
        holder,
        name,
        step,
        time,
        components,
        tags: Vec::new(),
        node_counts: Vec::new(),
        values: Vec::new(),
        offset,
    };
    match format.encoding {
        Encoding::Text => {
            let mut source = Text::new(cursor);
            read_rows(&mut source, rows, TagKind::Size, &mut data)?;
            if let Some(offset) = source.first_of_numpy() {
                remarks.at(
                    offset,
                    "numbers are written as np.float64(...), as meshio does with NumPy 2; they were read as meant",
                );
            }
        }
        Encoding::Binary(binary) => {
            read_binary_rows(cursor, binary, rows, &mut data, remarks)?;
        }
    }
    Ok(data)
}

/// The string tags, of which the first is the name.
fn read_name(cursor: &mut Cursor<'_>, remarks: &mut Remarks) -> Result<String, Fault> {
    let what = "the number of string tags";
    cursor.skip_blanks();
    let offset = cursor.offset();
    let count = count_line(cursor, what)?;
    let left = cursor.rest().len() as u64;
    if count > left {
        let problem = format!("{what} is {count}, but only {left} bytes of the file are left");
        return Err(Fault::new(
            offset,
            problem,
            "a count that fits into the file",
        ));
    }
    let mut name = None;
    for number in 1..=count {
        let offset = cursor.offset();
        if cursor.is_at_end() {
            let fault = Fault::shortage(offset, "the file ends here", "a string tag");
            return Err(fault.in_record("string tag", number, count));
        }
        let line = cursor.line();
        if line.len() > LONGEST || line.starts_with(b"$") {
            let problem = format!("the string tag is {}", quoted(line));
            let fault = Fault::new(offset, problem, "a text in double quotes");
            return Err(fault.in_record("string tag", number, count));
        }
        if name.is_none() {
            name = Some(without_quotes(line, offset, remarks));
        }
    }
    Ok(name.unwrap_or_default())
}

fn without_quotes(line: &[u8], offset: usize, remarks: &mut Remarks) -> String {
    let inner = line
        .strip_prefix(b"\"")
        .map_or(line, |rest| rest.strip_suffix(b"\"").unwrap_or(rest));
    String::from_utf8(inner.to_vec()).unwrap_or_else(|_| {
        remarks.at(offset, format!("the name {} is not UTF-8", quoted(inner)));
        String::from_utf8_lossy(inner).into_owned()
    })
}

/// The real tags, of which the first is the time.
fn read_times(cursor: &mut Cursor<'_>) -> Result<f64, Fault> {
    let mut source = Text::new(cursor);
    let what = "the number of real tags";
    let count = source.size(what)?;
    source.room_for(count, what, Record::default().and_doubles(1))?;
    let mut time = 0.0;
    for index in 0..count {
        let value = source.double("a real tag")?;
        if index == 0 {
            time = value;
        }
    }
    Ok(time)
}

/// The first three integer tags: step, components and rows. A partition may follow.
fn read_numbers<'a>(cursor: &mut Cursor<'a>) -> Result<[Token<'a>; 3], Fault> {
    let what = "the number of integer tags";
    let token = cursor.token(what)?;
    let count = number::unsigned(token, what)?;
    let left = cursor.rest().len() as u64;
    if count < 3 || count > left {
        let problem = format!("{what} is {count}");
        let expected = "at least 3: time step, components, rows";
        return Err(Fault::new(token.offset, problem, expected));
    }
    let numbers = [
        cursor.token("the time step")?,
        cursor.token("the number of components")?,
        cursor.token("the number of rows")?,
    ];
    for _ in 3..count {
        number::signed(
            cursor.token("a further integer tag")?,
            "a further integer tag",
        )?;
    }
    cursor.line_end("the integer tags")?;
    Ok(numbers)
}

/// Reads binary rows. In practice tags are ints, in contrast to gmsh's manual; files that follow the manual are read as
/// well.
fn read_binary_rows(
    cursor: &mut Cursor<'_>,
    binary: Binary,
    rows: u64,
    data: &mut RawData,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    let start = cursor.clone();
    let as_ints = read_rows(&mut Bytes::new(cursor, binary), rows, TagKind::Int, data);
    if as_ints.is_ok() && is_before_end(cursor) {
        return Ok(());
    }
    let mut other = start.clone();
    data.clear();
    let as_sizes = read_rows(
        &mut Bytes::new(&mut other, binary),
        rows,
        TagKind::Size,
        data,
    );
    if binary.size_width == SizeWidth::Eight && as_sizes.is_ok() && is_before_end(&other) {
        *cursor = other;
        remarks.at(
            start.offset(),
            "tags of rows take 8 bytes, as the manual says; gmsh and meshio write 4",
        );
        return Ok(());
    }
    data.clear();
    *cursor = start;
    read_rows(&mut Bytes::new(cursor, binary), rows, TagKind::Int, data)
}

fn is_before_end(cursor: &Cursor<'_>) -> bool {
    let mut ahead = cursor.clone();
    ahead.skip_blanks();
    ahead.rest().starts_with(b"$End")
}

impl RawData {
    fn clear(&mut self) {
        self.tags.clear();
        self.node_counts.clear();
        self.values.clear();
    }
}

fn read_rows(
    source: &mut impl Source,
    rows: u64,
    kind: TagKind,
    data: &mut RawData,
) -> Result<(), Fault> {
    let what = "the number of rows";
    let per_row = if data.holder == Holder::ElementNodes {
        Record::ints(2)
    } else {
        Record::ints(1).and_doubles(data.components as u64)
    };
    let count = source.room_for(rows, what, per_row)?;
    data.tags.reserve_exact(count);
    if data.holder != Holder::ElementNodes {
        data.values.reserve_exact(count * data.components);
    }
    for number in 1..=rows {
        read_row(source, kind, data).map_err(|fault| fault.in_record("row", number, rows))?;
    }
    Ok(())
}

fn read_row(source: &mut impl Source, kind: TagKind, data: &mut RawData) -> Result<(), Fault> {
    let tag = match data.holder {
        Holder::Nodes => source.node_tag(kind)?,
        Holder::Elements | Holder::ElementNodes => source.tag(kind, "the element tag")?,
    };
    let mut values = data.components;
    if data.holder == Holder::ElementNodes {
        let offset = source.next_offset();
        let nodes = source.tag(TagKind::Int, "the number of nodes")?;
        let row = Record::default().and_doubles(data.components as u64);
        source.room_for(nodes, "the number of nodes", row)?;
        let wrong = || {
            let problem = format!("the number of nodes is {nodes}");
            Fault::new(offset, problem, "the number of nodes of an element")
        };
        data.node_counts
            .push(u32::try_from(nodes).map_err(|_| wrong())?);
        values = (nodes as usize).checked_mul(values).ok_or_else(wrong)?;
    }
    for _ in 0..values {
        data.values.push(source.double("a value")?);
    }
    data.tags.push(tag);
    Ok(())
}
