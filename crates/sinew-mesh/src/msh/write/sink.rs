//! The sink of a writer's numbers: text in rows, or bytes.

use std::io::{self, Write};

/// Encoding of the numbers in a .msh file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MshEncoding {
    /// Text, with the fewest digits that read back exactly.
    Text,
    /// Bytes, least significant first.
    Binary,
}

pub(super) struct Sink<W> {
    to: W,
    encoding: MshEncoding,
    /// True if, in text, the row already has a number.
    is_inside_row: bool,
}

impl<W: Write> Sink<W> {
    pub(super) fn new(to: W, encoding: MshEncoding) -> Sink<W> {
        Sink {
            to,
            encoding,
            is_inside_row: false,
        }
    }

    pub(super) fn is_binary(&self) -> bool {
        self.encoding == MshEncoding::Binary
    }

    pub(super) fn header(&mut self, version: &str) -> io::Result<()> {
        self.line("$MeshFormat")?;
        self.line(&format!("{version} {} 8", u8::from(self.is_binary())))?;
        if self.is_binary() {
            self.int(1)?;
            self.line("")?;
        }
        self.line("$EndMeshFormat")
    }

    /// Writes a line of text, in either encoding.
    pub(super) fn line(&mut self, text: &str) -> io::Result<()> {
        writeln!(self.to, "{text}")
    }

    /// Writes the end of a section of numbers.
    pub(super) fn end(&mut self, section: &str) -> io::Result<()> {
        if self.is_binary() {
            self.line("")?;
        }
        self.line(&format!("$End{section}"))
    }

    pub(super) fn int(&mut self, value: i32) -> io::Result<()> {
        match self.encoding {
            MshEncoding::Text => self.word(format_args!("{value}")),
            MshEncoding::Binary => self.to.write_all(&value.to_le_bytes()),
        }
    }

    pub(super) fn size(&mut self, value: u64) -> io::Result<()> {
        match self.encoding {
            MshEncoding::Text => self.word(format_args!("{value}")),
            MshEncoding::Binary => self.to.write_all(&value.to_le_bytes()),
        }
    }

    pub(super) fn double(&mut self, value: f64) -> io::Result<()> {
        match self.encoding {
            MshEncoding::Text => self.word(format_args!("{value:?}")),
            MshEncoding::Binary => self.to.write_all(&value.to_le_bytes()),
        }
    }

    pub(super) fn doubles(&mut self, values: &[f64]) -> io::Result<()> {
        values.iter().try_for_each(|&value| self.double(value))
    }

    fn word(&mut self, word: std::fmt::Arguments<'_>) -> io::Result<()> {
        if self.is_inside_row {
            self.to.write_all(b" ")?;
        }
        self.is_inside_row = true;
        self.to.write_fmt(word)
    }

    /// Ends a row of text; does nothing in a binary file.
    pub(super) fn end_row(&mut self) -> io::Result<()> {
        if self.encoding == MshEncoding::Text {
            self.is_inside_row = false;
            self.line("")?;
        }
        Ok(())
    }

    pub(super) fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}
