//! The bytes of an array: plain or as base64, compressed or uncompressed.

use super::base64::Base64;
use crate::reading::cursor::quoted;
use crate::reading::fault::Fault;
use crate::unstructured::{ByteOrder, Scalar};

/// Properties that a file states for all of its arrays.
#[derive(Debug, Clone, Copy)]
pub(super) struct Encoding {
    pub(super) order: ByteOrder,
    /// The type of the numbers that give lengths in bytes.
    pub(super) header: Scalar,
    pub(super) is_compressed: bool,
}

/// A compressor whose numbers cannot be read. Files name it even if all their numbers are text.
pub(super) struct UnreadCompressor {
    pub(super) name: String,
    /// The place of its name.
    pub(super) offset: usize,
}

impl UnreadCompressor {
    pub(super) fn fault(&self) -> Fault {
        let problem = format!(
            "the numbers are compressed by {}",
            quoted(self.name.as_bytes())
        );
        let advice = match cfg!(feature = "compress") {
            true => {
                "zlib and plain numbers are read: in ParaView, Save Data with the compressor ZLib or None"
            }
            false => {
                "this program was built without decompression: in ParaView, Save Data with the compressor None"
            }
        };
        Fault::unsupported(self.offset, problem, advice)
    }
}

/// Bytes that are taken one after another.
pub(super) enum Source<'a> {
    Raw(&'a [u8]),
    Base64(Base64<'a>),
}

impl Source<'_> {
    fn take(&mut self, length: usize) -> Option<Vec<u8>> {
        match self {
            Source::Raw(bytes) => {
                let (taken, rest) = bytes.split_at_checked(length)?;
                *bytes = rest;
                Some(taken.to_vec())
            }
            Source::Base64(base64) => base64.take(length),
        }
    }
}

impl Encoding {
    /// The bytes of the array that begins here; `None` if they are cut off or damaged.
    pub(super) fn bytes_of(self, mut source: Source<'_>) -> Option<Vec<u8>> {
        if self.is_compressed {
            return self.inflated(&mut source);
        }
        let length = self.length(&mut source)?;
        source.take(length)
    }

    /// The next number of the array's head.
    fn length(self, source: &mut Source<'_>) -> Option<usize> {
        let bytes = source.take(self.header.size())?;
        let numbers = self.header.integers(&bytes, self.order)?;
        usize::try_from(*numbers.first()?).ok()
    }

    /// The numbers of a compressed array: the number of blocks, the size of a block before compression and that of the
    /// last one if it is smaller, the size of each after compression, then the blocks, each a separate zlib stream.
    #[cfg(feature = "compress")]
    fn inflated(self, source: &mut Source<'_>) -> Option<Vec<u8>> {
        use std::io::Read;

        let (blocks, size) = (self.length(source)?, self.length(source)?);
        let last = self.length(source)?;
        let mut compressed = Vec::new();
        for _ in 0..blocks {
            compressed.push(self.length(source)?);
        }
        let mut bytes = Vec::new();
        for (number, compressed) in (1..).zip(compressed) {
            let block = source.take(compressed)?;
            let expected = match number == blocks && last > 0 {
                true => last,
                false => size,
            };
            let before = bytes.len();
            // One byte more than it should have shows that it has too many.
            let most = (expected as u64).saturating_add(1);
            let mut stream = flate2::read::ZlibDecoder::new(block.as_slice()).take(most);
            stream.read_to_end(&mut bytes).ok()?;
            if bytes.len() - before != expected {
                return None;
            }
        }
        Some(bytes)
    }

    /// Without decompression every compressor is an [`UnreadCompressor`].
    #[cfg(not(feature = "compress"))]
    fn inflated(self, _: &mut Source<'_>) -> Option<Vec<u8>> {
        None
    }
}
