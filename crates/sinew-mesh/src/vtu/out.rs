//! The text and the arrays of a .vtu file.

use std::io::{self, Write};

use super::base64::Base64;
use super::grid::Values;

/// Encoding of the numbers in a .vtu file. All are exact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum VtuEncoding {
    /// Bytes after the text: fastest, but not valid XML.
    RawAppended,
    /// Bytes after the text, compressed by zlib: smaller, and several times as slow to write.
    #[cfg(feature = "compress")]
    CompressedAppended,
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
    fn write_with_length(self, to: &mut impl Write) -> io::Result<()> {
        to.write_all(&self.byte_length().to_le_bytes())?;
        self.write(to)
    }

    fn write(self, to: &mut impl Write) -> io::Result<()> {
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

/// Writes numbers as bytes, some hundred at a time: writing them one by one would be slower than the disk.
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

/// Numbers that follow the text.
enum Appended<'a> {
    Plain(Numbers<'a>),
    #[cfg(feature = "compress")]
    Compressed(Vec<u8>),
}

impl Appended<'_> {
    fn byte_length(&self) -> u64 {
        match self {
            Appended::Plain(numbers) => size_of::<u64>() as u64 + numbers.byte_length(),
            #[cfg(feature = "compress")]
            Appended::Compressed(bytes) => bytes.len() as u64,
        }
    }

    fn write(&self, to: &mut impl Write) -> io::Result<()> {
        match self {
            Appended::Plain(numbers) => numbers.write_with_length(to),
            #[cfg(feature = "compress")]
            Appended::Compressed(bytes) => to.write_all(bytes),
        }
    }
}

pub(super) struct Out<'a, W: Write> {
    to: io::BufWriter<W>,
    encoding: VtuEncoding,
    /// The numbers that follow the text, if numbers are appended.
    appended: Vec<Appended<'a>>,
    appended_bytes: u64,
}

/// Size (bytes) of the buffer.
const BUFFER: usize = 1 << 17;

impl<'a, W: Write> Out<'a, W> {
    pub(super) fn new(to: W, encoding: VtuEncoding) -> Out<'a, W> {
        Out {
            to: io::BufWriter::with_capacity(BUFFER, to),
            encoding,
            appended: Vec::new(),
            appended_bytes: 0,
        }
    }

    /// Attributes of the file that state the encoding of its numbers.
    pub(super) fn attributes(&self) -> &'static str {
        match self.encoding {
            VtuEncoding::RawAppended | VtuEncoding::Base64 => "",
            #[cfg(feature = "compress")]
            VtuEncoding::CompressedAppended => " compressor=\"vtkZLibDataCompressor\"",
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
        numbers: Numbers<'a>,
    ) -> io::Result<()> {
        let name = escaped(name);
        let start = format!(
            "<DataArray type=\"{vtk_type}\" Name=\"{name}\" NumberOfComponents=\"{components}\""
        );
        let appended = match self.encoding {
            VtuEncoding::RawAppended => Appended::Plain(numbers),
            #[cfg(feature = "compress")]
            VtuEncoding::CompressedAppended => Appended::Compressed(compressed(numbers)?),
            VtuEncoding::Base64 => {
                self.text(&format!("{start} format=\"binary\">\n"))?;
                let mut base64 = Base64::new(&mut self.to);
                numbers.write_with_length(&mut base64)?;
                base64.finish()?;
                return self.text("\n</DataArray>\n");
            }
        };
        let offset = self.appended_bytes;
        self.text(&format!(
            "{start} format=\"appended\" offset=\"{offset}\"/>\n"
        ))?;
        self.appended_bytes += appended.byte_length();
        self.appended.push(appended);
        Ok(())
    }

    pub(super) fn finish(mut self) -> io::Result<()> {
        if self.encoding != VtuEncoding::Base64 {
            self.text("<AppendedData encoding=\"raw\">\n_")?;
            for numbers in &self.appended {
                numbers.write(&mut self.to)?;
            }
            self.text("\n</AppendedData>\n")?;
        }
        self.text("</VTKFile>\n")?;
        self.to.flush()
    }
}

/// Numbers in VTK's compressed form: the number of blocks, the size of a block before compression and that of the last
/// one if it is smaller, the size of each after compression, then the blocks, each a separate zlib stream
/// (vtkXMLWriter, "compressed data").
#[cfg(feature = "compress")]
fn compressed(numbers: Numbers<'_>) -> io::Result<Vec<u8>> {
    use flate2::{Compression, write::ZlibEncoder};

    const BLOCK: usize = 1 << 16;
    let mut plain = Vec::with_capacity(numbers.byte_length() as usize);
    numbers.write(&mut plain)?;
    let mut sizes = Vec::new();
    let mut blocks = Vec::new();
    for block in plain.chunks(BLOCK) {
        let before = blocks.len();
        let mut encoder = ZlibEncoder::new(&mut blocks, Compression::fast());
        encoder.write_all(block)?;
        encoder.finish()?;
        sizes.push(blocks.len() - before);
    }
    let head = [sizes.len(), BLOCK, plain.len() % BLOCK];
    let mut bytes = Vec::with_capacity((head.len() + sizes.len()) * 8 + blocks.len());
    for number in head.iter().chain(&sizes) {
        bytes.extend((*number as u64).to_le_bytes());
    }
    bytes.extend(blocks);
    Ok(bytes)
}
