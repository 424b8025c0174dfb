//! Values as bytes: a name with its version, the length of the content, the content and a checksum.
//! Numbers are little-endian on every machine.

use crate::hash::Hash;

/// Reasons for which bytes cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BytesError {
    /// The bytes begin with another name.
    #[error("these bytes are no {kind} written by this version of sinew")]
    Unknown {
        /// Kind of value that was expected.
        kind: &'static str,
    },
    /// Too few bytes.
    #[error("the {kind} is cut off: {found} of at least {expected} bytes")]
    Cut {
        /// Kind of value that was expected.
        kind: &'static str,
        /// Bytes given.
        found: usize,
        /// Bytes that the head announces, or those of the shortest content where the head itself is cut.
        expected: usize,
    },
    /// Too many bytes.
    #[error("something follows the {kind}: {found} bytes, expected {expected}")]
    Longer {
        /// Kind of value that was expected.
        kind: &'static str,
        /// Bytes given.
        found: usize,
        /// Bytes that the head announces.
        expected: usize,
    },
    /// Bytes that were changed.
    #[error("the {kind} is damaged: its checksum is another")]
    Damaged {
        /// Kind of value that was expected.
        kind: &'static str,
    },
    /// A content that is never written.
    #[error("the {kind} is of another make: its {part} cannot be")]
    Content {
        /// Kind of value that was expected.
        kind: &'static str,
        /// The part at fault.
        part: &'static str,
    },
}

/// A kind of value.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kind {
    /// Name and version, with which the bytes begin.
    pub(crate) name: &'static [u8; 16],
    /// Description of the kind.
    pub(crate) words: &'static str,
}

/// Bytes of the name and of the content's length.
const HEAD: usize = 16 + 8;
const CHECKSUM: usize = 8;

/// Content on its way to bytes.
pub(crate) struct Writer(Vec<u8>);

impl Writer {
    pub(crate) fn new(kind: Kind) -> Self {
        let mut bytes = kind.name.to_vec();
        bytes.resize(HEAD, 0);
        Self(bytes)
    }

    pub(crate) fn flags(&mut self, flags: [u8; 4]) {
        self.0.extend(flags);
    }

    pub(crate) fn dof(&mut self, dof: u32) {
        self.0.extend(dof.to_le_bytes());
    }

    pub(crate) fn count(&mut self, count: u64) {
        self.0.extend(count.to_le_bytes());
    }

    pub(crate) fn number(&mut self, number: f64) {
        self.0.extend(number.to_le_bytes());
    }

    pub(crate) fn finish(mut self) -> Vec<u8> {
        let content = (self.0.len() - HEAD) as u64;
        self.0[HEAD - 8..HEAD].copy_from_slice(&content.to_le_bytes());
        let checksum = Hash::of(&self.0);
        self.0.extend(checksum.to_le_bytes());
        self.0
    }
}

/// Content that is left to read.
pub(crate) struct Reader<'a> {
    kind: &'static str,
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    /// Opens the content of whole and undamaged bytes.
    pub(crate) fn open(kind: Kind, bytes: &'a [u8]) -> Result<Self, BytesError> {
        let Kind { name, words: kind } = kind;
        let found = bytes.len();
        let begins = found.min(name.len());
        if bytes[..begins] != name[..begins] {
            return Err(BytesError::Unknown { kind });
        }
        let cut = |expected| BytesError::Cut {
            kind,
            found,
            expected,
        };
        let head = bytes.get(name.len()..).unwrap_or_default();
        let Some((length, after)) = head.split_first_chunk() else {
            return Err(cut(HEAD + CHECKSUM));
        };
        let content = usize::try_from(u64::from_le_bytes(*length)).unwrap_or(usize::MAX);
        let expected = content.saturating_add(HEAD + CHECKSUM);
        if found > expected {
            return Err(BytesError::Longer {
                kind,
                found,
                expected,
            });
        }
        let Some((rest, checksum)) = after.split_last_chunk() else {
            return Err(cut(expected));
        };
        if found < expected {
            return Err(cut(expected));
        }
        if Hash::of(&bytes[..HEAD + content]) != u64::from_le_bytes(*checksum) {
            return Err(BytesError::Damaged { kind });
        }
        Ok(Self { kind, rest })
    }

    /// The error for a part with a content that is never written.
    pub(crate) fn impossible(&self, part: &'static str) -> BytesError {
        let kind = self.kind;
        BytesError::Content { kind, part }
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], BytesError> {
        let taken = self.rest.split_first_chunk();
        let (first, rest) = taken.ok_or_else(|| self.impossible("length"))?;
        self.rest = rest;
        Ok(*first)
    }

    pub(crate) fn flags(&mut self) -> Result<[u8; 4], BytesError> {
        self.take()
    }

    pub(crate) fn dof(&mut self) -> Result<u32, BytesError> {
        self.take().map(u32::from_le_bytes)
    }

    pub(crate) fn count(&mut self) -> Result<u64, BytesError> {
        self.take().map(u64::from_le_bytes)
    }

    /// Reads a number of items of `size` bytes or more each; an error where fewer bytes are left.
    pub(crate) fn count_of(&mut self, size: usize) -> Result<usize, BytesError> {
        let count = usize::try_from(self.count()?).ok();
        let fits = |count: &usize| {
            count
                .checked_mul(size)
                .is_some_and(|n| n <= self.rest.len())
        };
        count.filter(fits).ok_or_else(|| self.impossible("length"))
    }

    pub(crate) fn number(&mut self) -> Result<f64, BytesError> {
        self.take().map(f64::from_le_bytes)
    }

    /// Checks that the content ends here.
    pub(crate) fn end(&self) -> Result<(), BytesError> {
        match self.rest {
            [] => Ok(()),
            _ => Err(self.impossible("length")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KIND: Kind = Kind {
        name: b"sinew test v1 \r\n",
        words: "test",
    };

    fn sample() -> Vec<u8> {
        let mut writer = Writer::new(KIND);
        writer.flags([1, 2, 3, 4]);
        writer.count(2);
        writer.number(0.1);
        writer.dof(7);
        writer.finish()
    }

    #[test]
    fn what_was_written_is_read() {
        let bytes = sample();
        let mut reader = Reader::open(KIND, &bytes).unwrap();
        assert_eq!(reader.flags(), Ok([1, 2, 3, 4]));
        assert!(reader.end().is_err());
        assert_eq!(reader.count(), Ok(2));
        assert_eq!(reader.number(), Ok(0.1));
        assert_eq!(reader.dof(), Ok(7));
        assert_eq!(reader.end(), Ok(()));
        assert!(reader.number().is_err());
    }

    #[test]
    fn every_cut_says_so() {
        let bytes = sample();
        for length in 0..bytes.len() {
            let refused = Reader::open(KIND, &bytes[..length]).err();
            assert!(
                matches!(refused, Some(BytesError::Cut { found, .. }) if found == length),
                "{length}: {refused:?}"
            );
        }
        let mut longer = bytes;
        longer.push(0);
        let refused = Reader::open(KIND, &longer).err();
        assert!(
            matches!(refused, Some(BytesError::Longer { .. })),
            "{refused:?}"
        );
    }

    #[test]
    fn every_flipped_bit_is_noticed() {
        let bytes = sample();
        for bit in 0..8 * bytes.len() {
            let mut flipped = bytes.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            let refused = Reader::open(KIND, &flipped).err();
            let expected = match bit / 8 {
                0..16 => matches!(refused, Some(BytesError::Unknown { .. })),
                16..24 => refused.is_some(),
                _ => matches!(refused, Some(BytesError::Damaged { .. })),
            };
            assert!(expected, "bit {bit}: {refused:?}");
        }
    }

    #[test]
    fn no_room_is_made_for_what_is_not_there() {
        let mut writer = Writer::new(KIND);
        writer.count(u64::MAX / 8);
        writer.count(2);
        writer.number(1.0);
        let bytes = writer.finish();
        let mut reader = Reader::open(KIND, &bytes).unwrap();
        assert!(reader.count_of(8).is_err());
        assert!(reader.count_of(8).is_err(), "one of two is there");
    }
}
