//! The text and the arrays of a .vtu file.

use std::io::{self, Write};

use super::base64::Base64;
use super::grid::Values;

/// Encoding of the numbers in a .vtu file. Both are exact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum VtuEncoding {
    /// Bytes after the text: smallest and fastest, but not valid XML.
    RawAppended,
    /// Base64 in valid XML.
    Base64,
}

/// Text with the characters replaced that XML reserves.
pub(super) fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            // XML 1.0 has no other control characters.
            c if c.is_control() => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

/// Numbers to be written as bytes.
#[derive(Clone, Copy)]
pub(super) enum Numbers<'a> {
    F64(&'a [f64]),
    F32(&'a [f32]),
    I64(&'a [i64]),
    U8(&'a [u8]),
    U32(&'a [&'a [u32]]),
}

impl<'a> From<&'a Values<'_>> for Numbers<'a> {
    fn from(values: &'a Values<'_>) -> Numbers<'a> {
        match values {
            Values::F64(values) => Numbers::F64(values),
            Values::F32(values) => Numbers::F32(values),
            Values::U8(values) => Numbers::U8(values),
            Values::I64(values) => Numbers::I64(values),
        }
    }
}

impl Numbers<'_> {
    fn byte_length(self) -> u64 {
        let (count, size) = match self {
            Numbers::F64(values) => (values.len(), 8),
            Numbers::F32(values) => (values.len(), 4),
            Numbers::I64(values) => (values.len(), 8),
            Numbers::U8(values) => (values.len(), 1),
            Numbers::U32(lists) => (lists.iter().map(|list| list.len()).sum(), 4),
        };
        (count * size) as u64
    }

    /// Writes their length in bytes, then the bytes.
    fn write(self, to: &mut impl Write) -> io::Result<()> {
        to.write_all(&self.byte_length().to_le_bytes())?;
        match self {
            Numbers::F64(values) => in_blocks(values, f64::to_le_bytes, to),
            Numbers::F32(values) => in_blocks(values, f32::to_le_bytes, to),
            Numbers::I64(values) => in_blocks(values, i64::to_le_bytes, to),
            Numbers::U8(values) => to.write_all(values),
            Numbers::U32(lists) => lists
                .iter()
                .try_for_each(|list| in_blocks(list, u32::to_le_bytes, to)),
        }
    }
}

/// Writes numbers as bytes, some hundred at a time: one by one they would take longer than the disk.
fn in_blocks<T: Copy, const N: usize>(
    values: &[T],
    bytes: impl Fn(T) -> [u8; N],
    to: &mut impl Write,
) -> io::Result<()> {
    let mut block = [[0; N]; 512];
    for values in values.chunks(block.len()) {
        for (place, value) in block.iter_mut().zip(values) {
            *place = bytes(*value);
        }
        to.write_all(block[..values.len()].as_flattened())?;
    }
    Ok(())
}

pub(super) struct Out<W: Write> {
    to: io::BufWriter<W>,
    encoding: VtuEncoding,
    /// The bytes that follow the text, if numbers are appended.
    appended: Vec<u8>,
    appended_bytes: u64,
}

impl<W: Write> Out<W> {
    pub(super) fn new(to: W, encoding: VtuEncoding) -> Out<W> {
        Out {
            to: io::BufWriter::new(to),
            encoding,
            appended: Vec::new(),
            appended_bytes: 0,
        }
    }

    pub(super) fn text(&mut self, text: &str) -> io::Result<()> {
        self.to.write_all(text.as_bytes())
    }

    pub(super) fn array(
        &mut self,
        name: &str,
        vtk_type: &str,
        components: usize,
        numbers: Numbers<'_>,
    ) -> io::Result<()> {
        let name = escaped(name);
        let start = format!(
            "<DataArray type=\"{vtk_type}\" Name=\"{name}\" NumberOfComponents=\"{components}\""
        );
        match self.encoding {
            VtuEncoding::RawAppended => {
                let offset = self.appended_bytes;
                self.text(&format!(
                    "{start} format=\"appended\" offset=\"{offset}\"/>\n"
                ))?;
                numbers.write(&mut self.appended)?;
                self.appended_bytes = self.appended.len() as u64;
            }
            VtuEncoding::Base64 => {
                self.text(&format!("{start} format=\"binary\">\n"))?;
                let mut base64 = Base64::new(&mut self.to);
                numbers.write(&mut base64)?;
                base64.finish()?;
                self.text("\n</DataArray>\n")?;
            }
        }
        Ok(())
    }

    pub(super) fn finish(mut self) -> io::Result<()> {
        if self.encoding == VtuEncoding::RawAppended {
            self.text("<AppendedData encoding=\"raw\">\n_")?;
            self.to.write_all(&self.appended)?;
            self.text("\n</AppendedData>\n")?;
        }
        self.text("</VTKFile>\n")?;
        self.to.flush()
    }
}
