//! The sources of numbers for section decoders.
//!
//! A decoder names the kind of each number, and the source knows how that kind is encoded. So the text and the binary
//! form of a version share one decoder. Each long table has a separate method, which the two sources implement
//! differently.

use super::places::Layout;
use super::tag_list::TagList;
use crate::reading::cursor::{Cursor, Token};
use crate::reading::fault::Fault;
use crate::reading::number;

/// The numbers of one section, in order.
pub(super) trait Source {
    /// Offset of the next number.
    fn next_offset(&mut self) -> usize;
    /// The format's `int`.
    fn int(&mut self, what: &str) -> Result<i32, Fault>;
    /// The format's `size_t`.
    fn size(&mut self, what: &str) -> Result<u64, Fault>;
    /// The format's `double`; may be infinite or NaN.
    fn double(&mut self, what: &str) -> Result<f64, Fault>;
    /// The least number of bytes of a record.
    fn least_bytes(&self, record: Record) -> u64;
    /// Bytes left in the file.
    fn bytes_left(&self) -> u64;
    /// The layout of rows of these numbers.
    fn layout(&self, row: Record) -> Layout;

    /// `count` node tags.
    fn node_tags(&mut self, count: usize, tags: &mut Vec<u64>) -> Result<(), Fault>;
    /// Rows of three coordinates and `parameters` numbers that are skipped.
    fn points(
        &mut self,
        rows: usize,
        parameters: usize,
        points: &mut Vec<[f64; 3]>,
    ) -> Result<(), Fault>;
    /// Rows of an element tag, encoded as `kind`, and the tags of `nodes` nodes.
    fn element_rows(
        &mut self,
        kind: TagKind,
        rows: usize,
        nodes: usize,
        element_tags: &mut Vec<u64>,
        node_tags: &mut TagList,
    ) -> Result<(), Fault>;

    /// A tag encoded as `kind`.
    #[inline]
    fn tag(&mut self, kind: TagKind, what: &str) -> Result<u64, Fault> {
        match kind {
            TagKind::Size => self.size(what),
            TagKind::Int => {
                let offset = self.next_offset();
                let value = self.int(what)?;
                u64::try_from(value).map_err(|_| negative(offset, what, value))
            }
        }
    }

    /// A `double` that must be finite.
    fn finite(&mut self, what: &str) -> Result<f64, Fault> {
        let offset = self.next_offset();
        let value = self.double(what)?;
        if value.is_finite() {
            Ok(value)
        } else {
            Err(not_finite(offset, what, value))
        }
    }

    /// The tag of a node, which is at least 1.
    fn node_tag(&mut self, kind: TagKind) -> Result<u64, Fault> {
        let offset = self.next_offset();
        match self.tag(kind, "the node tag")? {
            0 => Err(zero_tag(offset)),
            tag => Ok(tag),
        }
    }

    fn point(&mut self) -> Result<[f64; 3], Fault> {
        let x = self.finite(COORDINATES[0])?;
        let y = self.finite(COORDINATES[1])?;
        let z = self.finite(COORDINATES[2])?;
        Ok([x, y, z])
    }

    /// The count as a `usize`, if that many records can still follow. So the memory reserved for them is bounded by the
    /// size of the file.
    fn room_for(&mut self, count: u64, what: &str, record: Record) -> Result<usize, Fault> {
        let offset = self.next_offset();
        let needed = count.checked_mul(self.least_bytes(record));
        let left = self.bytes_left();
        match (needed, usize::try_from(count)) {
            (Some(needed), Ok(count)) if needed <= left => Ok(count),
            _ => Err(Fault::new(
                offset,
                format!("{what} is {count}, but only {left} bytes of the file are left"),
                "a count that fits into the file",
            )),
        }
    }

    /// A count and that many ints.
    fn int_list(&mut self, what: &str) -> Result<Vec<i32>, Fault> {
        let count_of = format!("the number of {what}");
        let count = self.size(&count_of)?;
        let count = self.room_for(count, &count_of, Record::ints(1))?;
        (0..count).map(|_| self.int(what)).collect()
    }
}

const COORDINATES: [&str; 3] = ["the x coordinate", "the y coordinate", "the z coordinate"];

fn not_finite(offset: usize, what: &str, value: f64) -> Fault {
    Fault::new(offset, format!("{what} is {value}"), "a finite number")
}

fn zero_tag(offset: usize) -> Fault {
    Fault::new(offset, "the node tag is 0", "a tag of at least 1")
}

fn negative(offset: usize, what: &str, value: i32) -> Fault {
    let problem = format!("{what} is {value}");
    Fault::new(offset, problem, "a non-negative whole number")
}

/// The encoding of a tag in binary files. In text all tags have the same form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TagKind {
    Int,
    Size,
}

/// The fewest numbers of each kind that a record has.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Record {
    pub(super) ints: u64,
    pub(super) sizes: u64,
    pub(super) doubles: u64,
}

impl Record {
    pub(super) fn ints(ints: u64) -> Record {
        Record {
            ints,
            ..Record::default()
        }
    }

    /// A record of `count` tags, encoded as `kind`.
    pub(super) fn tags(kind: TagKind, count: u64) -> Record {
        match kind {
            TagKind::Int => Record::ints(count),
            TagKind::Size => Record {
                sizes: count,
                ..Record::default()
            },
        }
    }

    fn numbers(self) -> u64 {
        let integers = self.ints.saturating_add(self.sizes);
        integers.saturating_add(self.doubles)
    }

    pub(super) fn and_doubles(self, doubles: u64) -> Record {
        Record { doubles, ..self }
    }
}

/// Numbers written as text, separated by blanks or line breaks.
pub(super) struct Text<'c, 'a> {
    cursor: &'c mut Cursor<'a>,
    first_of_numpy: Option<usize>,
}

impl<'c, 'a> Text<'c, 'a> {
    pub(super) fn new(cursor: &'c mut Cursor<'a>) -> Text<'c, 'a> {
        Text {
            cursor,
            first_of_numpy: None,
        }
    }

    /// The offset of the first number in the form in which Python shows those of NumPy 2, if there is one:
    /// `np.float64(0.5)`.
    pub(super) fn first_of_numpy(&self) -> Option<usize> {
        self.first_of_numpy
    }

    #[inline]
    fn token(&mut self, what: &str) -> Result<Token<'a>, Fault> {
        let token = self.cursor.token(what)?;
        if token.text.starts_with(number::NUMPY) {
            self.first_of_numpy.get_or_insert(token.offset);
        }
        Ok(token)
    }
}

impl Source for Text<'_, '_> {
    #[inline]
    fn next_offset(&mut self) -> usize {
        self.cursor.skip_blanks();
        self.cursor.offset()
    }

    #[inline]
    fn int(&mut self, what: &str) -> Result<i32, Fault> {
        let start = self.cursor.clone();
        if let Some(number) = self.cursor.plain_number() {
            if let Ok(number) = i32::try_from(number) {
                return Ok(number);
            }
            *self.cursor = start;
        }
        number::signed(self.token(what)?, what)
    }

    #[inline]
    fn size(&mut self, what: &str) -> Result<u64, Fault> {
        match self.cursor.plain_number() {
            Some(number) => Ok(number),
            None => number::unsigned(self.token(what)?, what),
        }
    }

    #[inline]
    fn double(&mut self, what: &str) -> Result<f64, Fault> {
        number::double(self.token(what)?, what)
    }

    #[inline]
    fn finite(&mut self, what: &str) -> Result<f64, Fault> {
        let token = self.token(what)?;
        match number::double(token, what)? {
            value if value.is_finite() => Ok(value),
            value => Err(not_finite(token.offset, what, value)),
        }
    }

    /// Reads a tag; in text all tags have the same form, for any size.
    #[inline]
    fn tag(&mut self, _: TagKind, what: &str) -> Result<u64, Fault> {
        self.size(what)
    }

    fn least_bytes(&self, record: Record) -> u64 {
        // A digit and a blank.
        record.numbers().saturating_mul(2)
    }

    fn bytes_left(&self) -> u64 {
        self.cursor.rest().len() as u64
    }

    fn layout(&self, row: Record) -> Layout {
        Layout::Words(row.numbers() as usize)
    }

    fn node_tags(&mut self, count: usize, tags: &mut Vec<u64>) -> Result<(), Fault> {
        for number in 1..=count {
            let tag = self
                .node_tag(TagKind::Size)
                .map_err(|fault| fault.in_record("tag", number as u64, count as u64))?;
            tags.push(tag);
        }
        Ok(())
    }

    fn points(
        &mut self,
        rows: usize,
        parameters: usize,
        points: &mut Vec<[f64; 3]>,
    ) -> Result<(), Fault> {
        for number in 1..=rows {
            let mut row = || {
                points.push(self.point()?);
                (0..parameters).try_for_each(|_| self.double("a parametric coordinate").map(drop))
            };
            row().map_err(|fault| fault.in_record("node", number as u64, rows as u64))?;
        }
        Ok(())
    }

    fn element_rows(
        &mut self,
        _: TagKind,
        rows: usize,
        nodes: usize,
        element_tags: &mut Vec<u64>,
        node_tags: &mut TagList,
    ) -> Result<(), Fault> {
        for number in 1..=rows {
            let mut row = || {
                element_tags.push(self.size("the element tag")?);
                for _ in 0..nodes {
                    node_tags.push(self.size("a node tag")?);
                }
                Ok(())
            };
            row().map_err(|fault: Fault| fault.in_record("element", number as u64, rows as u64))?;
        }
        Ok(())
    }
}

/// The number format of a binary file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Binary {
    pub(super) order: ByteOrder,
    pub(super) size_width: SizeWidth,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ByteOrder {
    Little,
    Big,
}

/// Bytes of a `size_t`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SizeWidth {
    Four,
    Eight,
}

impl ByteOrder {
    pub(super) fn int(self, bytes: [u8; 4]) -> i32 {
        match self {
            ByteOrder::Little => i32::from_le_bytes(bytes),
            ByteOrder::Big => i32::from_be_bytes(bytes),
        }
    }

    #[inline]
    fn double(self, bytes: [u8; 8]) -> f64 {
        match self {
            ByteOrder::Little => f64::from_le_bytes(bytes),
            ByteOrder::Big => f64::from_be_bytes(bytes),
        }
    }
}

/// Numbers as bytes.
pub(super) struct Bytes<'c, 'a> {
    cursor: &'c mut Cursor<'a>,
    binary: Binary,
}

impl<'c, 'a> Bytes<'c, 'a> {
    pub(super) fn new(cursor: &'c mut Cursor<'a>, binary: Binary) -> Bytes<'c, 'a> {
        Bytes { cursor, binary }
    }

    #[inline]
    fn take<const N: usize>(&mut self, what: &str) -> Result<[u8; N], Fault> {
        let offset = self.cursor.offset();
        self.cursor
            .take(N)
            .and_then(|bytes| bytes.first_chunk().copied())
            .ok_or_else(|| Fault::shortage(offset, "the file ends here", what))
    }

    /// The offset and the bytes of `rows` rows of `row_bytes` bytes each.
    fn rows(
        &mut self,
        rows: usize,
        row_bytes: usize,
        record: &str,
    ) -> Result<(usize, &'a [u8]), Fault> {
        let offset = self.cursor.offset();
        let bytes = rows
            .checked_mul(row_bytes)
            .and_then(|length| self.cursor.take(length));
        bytes.map(|bytes| (offset, bytes)).ok_or_else(|| {
            let end = self.cursor.file_length();
            let complete = (end - offset) / row_bytes.max(1);
            Fault::shortage(
                end,
                "the file ends here",
                format!("the rest of the {record}"),
            )
            .in_record(record, complete as u64 + 1, rows as u64)
        })
    }

    fn size_bytes(&self) -> usize {
        match self.binary.size_width {
            SizeWidth::Four => 4,
            SizeWidth::Eight => 8,
        }
    }

    fn bytes_of(&self, record: Record) -> u64 {
        let sizes = record.sizes.saturating_mul(self.size_bytes() as u64);
        let ints = record.ints.saturating_mul(4);
        let doubles = record.doubles.saturating_mul(8);
        sizes.saturating_add(ints).saturating_add(doubles)
    }
}

/// Calls a function with the width of tags in bytes, and a decoder for them. Negative tags come out above `i64::MAX`.
macro_rules! with_decoder {
    ($binary:expr, $kind:expr, $function:expr, ($($argument:expr),*)) => {
        match ($kind, $binary.size_width, $binary.order) {
            (TagKind::Int, _, ByteOrder::Little) => {
                $function($($argument,)* |b: [u8; 4]| i64::from(i32::from_le_bytes(b)) as u64)
            }
            (TagKind::Int, _, ByteOrder::Big) => {
                $function($($argument,)* |b: [u8; 4]| i64::from(i32::from_be_bytes(b)) as u64)
            }
            (TagKind::Size, SizeWidth::Four, ByteOrder::Little) => {
                $function($($argument,)* |b: [u8; 4]| u64::from(u32::from_le_bytes(b)))
            }
            (TagKind::Size, SizeWidth::Four, ByteOrder::Big) => {
                $function($($argument,)* |b: [u8; 4]| u64::from(u32::from_be_bytes(b)))
            }
            (TagKind::Size, SizeWidth::Eight, ByteOrder::Little) => {
                $function($($argument,)* u64::from_le_bytes)
            }
            (TagKind::Size, SizeWidth::Eight, ByteOrder::Big) => {
                $function($($argument,)* u64::from_be_bytes)
            }
        }
    };
}

impl Source for Bytes<'_, '_> {
    #[inline]
    fn next_offset(&mut self) -> usize {
        self.cursor.offset()
    }

    fn int(&mut self, what: &str) -> Result<i32, Fault> {
        let bytes = self.take(what)?;
        Ok(self.binary.order.int(bytes))
    }

    fn size(&mut self, what: &str) -> Result<u64, Fault> {
        Ok(match (self.binary.size_width, self.binary.order) {
            (SizeWidth::Four, ByteOrder::Little) => u32::from_le_bytes(self.take(what)?).into(),
            (SizeWidth::Four, ByteOrder::Big) => u32::from_be_bytes(self.take(what)?).into(),
            (SizeWidth::Eight, ByteOrder::Little) => u64::from_le_bytes(self.take(what)?),
            (SizeWidth::Eight, ByteOrder::Big) => u64::from_be_bytes(self.take(what)?),
        })
    }

    fn double(&mut self, what: &str) -> Result<f64, Fault> {
        let bytes = self.take(what)?;
        Ok(self.binary.order.double(bytes))
    }

    fn least_bytes(&self, record: Record) -> u64 {
        self.bytes_of(record)
    }

    fn bytes_left(&self) -> u64 {
        self.cursor.rest().len() as u64
    }

    fn layout(&self, row: Record) -> Layout {
        Layout::Bytes(self.bytes_of(row) as usize)
    }

    fn node_tags(&mut self, count: usize, tags: &mut Vec<u64>) -> Result<(), Fault> {
        let width = self.size_bytes();
        let (offset, bytes) = self.rows(count, width, "tag")?;
        let first = tags.len();
        with_decoder!(self.binary, TagKind::Size, extend_tags, (bytes, tags));
        let new = tags.get(first..).unwrap_or_default();
        match new.iter().position(|&tag| tag == 0) {
            None => Ok(()),
            Some(row) => {
                Err(zero_tag(offset + row * width).in_record("tag", row as u64 + 1, count as u64))
            }
        }
    }

    fn points(
        &mut self,
        rows: usize,
        parameters: usize,
        points: &mut Vec<[f64; 3]>,
    ) -> Result<(), Fault> {
        let row_bytes = 8 * (3 + parameters);
        let (offset, bytes) = self.rows(rows, row_bytes, "node")?;
        let order = self.binary.order;
        let mut all_finite = true;
        points.extend(bytes.chunks_exact(row_bytes).map(|row| {
            let point = decoded_point(row, order);
            all_finite &= point.iter().all(|x| x.is_finite());
            point
        }));
        if all_finite {
            return Ok(());
        }
        for (number, row) in bytes.chunks_exact(row_bytes).enumerate() {
            refuse_infinite(decoded_point(row, order), offset + number * row_bytes)
                .map_err(|fault| fault.in_record("node", number as u64 + 1, rows as u64))?;
        }
        Ok(())
    }

    fn element_rows(
        &mut self,
        kind: TagKind,
        rows: usize,
        nodes: usize,
        element_tags: &mut Vec<u64>,
        node_tags: &mut TagList,
    ) -> Result<(), Fault> {
        let width = match kind {
            TagKind::Int => 4,
            TagKind::Size => self.size_bytes(),
        };
        let row_bytes = width * (1 + nodes);
        let (offset, bytes) = self.rows(rows, row_bytes, "element")?;
        if kind == TagKind::Int {
            refuse_negative(bytes, self.binary.order, offset, 1 + nodes)?;
        }
        with_decoder!(
            self.binary,
            kind,
            extend_elements,
            (bytes, 1 + nodes, element_tags, node_tags)
        );
        Ok(())
    }
}

fn extend_tags<const N: usize>(bytes: &[u8], tags: &mut Vec<u64>, decode: impl Fn([u8; N]) -> u64) {
    tags.extend(bytes.as_chunks().0.iter().map(|&word| decode(word)));
}

fn extend_elements<const N: usize>(
    bytes: &[u8],
    row_words: usize,
    element_tags: &mut Vec<u64>,
    node_tags: &mut TagList,
    decode: impl Fn([u8; N]) -> u64 + Copy,
) {
    let rows = bytes.as_chunks().0.chunks_exact(row_words);
    let nodes = rows.map(|row| {
        let (first, nodes) = row.split_first().unwrap_or((&[0; N], &[]));
        element_tags.push(decode(*first));
        nodes
    });
    node_tags.extend_rows(nodes, decode);
}

/// Names the first negative tag among rows of ints.
fn refuse_negative(
    bytes: &[u8],
    order: ByteOrder,
    offset: usize,
    row_words: usize,
) -> Result<(), Fault> {
    let words = bytes.as_chunks().0;
    let is_negative = |&word: &[u8; 4]| order.int(word) < 0;
    let Some(index) = words.iter().position(is_negative) else {
        return Ok(());
    };
    let value = words.get(index).map_or(0, |&word| order.int(word));
    let what = if index % row_words == 0 {
        "the element tag"
    } else {
        "a node tag"
    };
    let (row, rows) = (index / row_words, words.len() / row_words);
    Err(negative(offset + 4 * index, what, value).in_record("element", row as u64 + 1, rows as u64))
}

fn decoded_point(row: &[u8], order: ByteOrder) -> [f64; 3] {
    match row.as_chunks().0 {
        [x, y, z, ..] => [order.double(*x), order.double(*y), order.double(*z)],
        _ => [f64::NAN; 3],
    }
}

fn refuse_infinite(point: [f64; 3], offset: usize) -> Result<(), Fault> {
    for (axis, (value, what)) in point.into_iter().zip(COORDINATES).enumerate() {
        if !value.is_finite() {
            return Err(not_finite(offset + 8 * axis, what, value));
        }
    }
    Ok(())
}
