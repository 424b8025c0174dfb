//! Where section decoders take their numbers from.
//!
//! A decoder names the kind of each number; the source knows how that kind is encoded. So the text and the binary
//! form of a version can share one decoder.

use super::cursor::Cursor;
use super::fault::Fault;
use super::number;

/// The numbers of one section, in order.
pub(super) trait Source {
    /// Offset of the next number.
    fn next_offset(&mut self) -> usize;
    /// The format's `int`.
    fn int(&mut self, what: &str) -> Result<i32, Fault>;
    /// The format's `size_t`.
    fn size(&mut self, what: &str) -> Result<u64, Fault>;
    /// The format's `double`; may be infinite or not a number.
    fn double(&mut self, what: &str) -> Result<f64, Fault>;
    /// The least number of bytes that a record takes.
    fn least_bytes(&self, record: Record) -> u64;
    /// Bytes left in the file.
    fn bytes_left(&self) -> u64;

    /// A `double` that must be finite.
    fn finite(&mut self, what: &str) -> Result<f64, Fault> {
        let offset = self.next_offset();
        let value = self.double(what)?;
        if value.is_finite() {
            Ok(value)
        } else {
            Err(Fault::new(
                offset,
                format!("{what} is {value}"),
                "a finite number",
            ))
        }
    }

    /// The count as a `usize`, if as many records can still follow: what is reserved for them is bounded by the
    /// size of the file, whatever a count claims.
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
}

/// How many numbers of each kind a record has at least.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Record {
    pub(super) ints: u64,
    pub(super) sizes: u64,
    pub(super) doubles: u64,
}

/// Numbers written as text, separated by blanks; line breaks mean nothing.
pub(super) struct Text<'c, 'a> {
    cursor: &'c mut Cursor<'a>,
}

impl<'c, 'a> Text<'c, 'a> {
    pub(super) fn new(cursor: &'c mut Cursor<'a>) -> Text<'c, 'a> {
        Text { cursor }
    }
}

impl Source for Text<'_, '_> {
    fn next_offset(&mut self) -> usize {
        self.cursor.skip_blanks();
        self.cursor.offset()
    }

    fn int(&mut self, what: &str) -> Result<i32, Fault> {
        number::signed(self.cursor.token(what)?, what)
    }

    fn size(&mut self, what: &str) -> Result<u64, Fault> {
        number::unsigned(self.cursor.token(what)?, what)
    }

    fn double(&mut self, what: &str) -> Result<f64, Fault> {
        number::double(self.cursor.token(what)?, what)
    }

    fn least_bytes(&self, record: Record) -> u64 {
        // A digit and a blank.
        2 * (record.ints + record.sizes + record.doubles)
    }

    fn bytes_left(&self) -> u64 {
        self.cursor.rest().len() as u64
    }
}
