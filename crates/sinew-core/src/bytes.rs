//! Values as bytes: a name with its version, the length of the content, the content by [`postcard`] and a checksum.

use serde::Serialize;
use serde::de::DeserializeOwned;

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
        /// Number of bytes stated in the header, or of the shortest content if the header itself is cut.
        expected: usize,
    },
    /// Too many bytes.
    #[error("something follows the {kind}: {found} bytes, expected {expected}")]
    Longer {
        /// Kind of value that was expected.
        kind: &'static str,
        /// Bytes given.
        found: usize,
        /// Number of bytes stated in the header.
        expected: usize,
    },
    /// Bytes that were modified.
    #[error("the {kind} is damaged: its checksum is another")]
    Damaged {
        /// Kind of value that was expected.
        kind: &'static str,
    },
    /// Content that is never written.
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
pub struct Kind {
    /// Name and version, with which the bytes begin.
    pub name: &'static [u8; 16],
    /// Description of the kind, for errors.
    pub words: &'static str,
}

/// Bytes of the name and of the content's length.
const HEAD: usize = 16 + 8;
const CHECKSUM: usize = 8;

/// Writes a value. Numbers keep their bits, and machines of either byte order write the same bytes.
///
/// # Errors
/// [`BytesError::Content`] for a value that its own type refuses to write.
pub fn write<T: Serialize>(kind: Kind, value: &T) -> Result<Vec<u8>, BytesError> {
    let mut bytes = kind.name.to_vec();
    bytes.resize(HEAD, 0);
    let mut bytes = postcard::to_extend(value, bytes).map_err(|_| kind.impossible("content"))?;
    let content = (bytes.len() - HEAD) as u64;
    bytes[HEAD - 8..HEAD].copy_from_slice(&content.to_le_bytes());
    let checksum = Hash::of(&bytes);
    bytes.extend(checksum.to_le_bytes());
    Ok(bytes)
}

/// Reads a value that [`write()`] wrote.
///
/// # Errors
/// [`BytesError`] for other bytes.
pub fn read<T: DeserializeOwned>(kind: Kind, bytes: &[u8]) -> Result<T, BytesError> {
    let content = kind.open(bytes)?;
    match postcard::take_from_bytes(content) {
        Ok((value, [])) => Ok(value),
        _ => Err(kind.impossible("content")),
    }
}

impl Kind {
    /// The error for a part of a content that is never written.
    pub(crate) fn impossible(self, part: &'static str) -> BytesError {
        let kind = self.words;
        BytesError::Content { kind, part }
    }

    /// Returns the content of complete, undamaged bytes.
    fn open(self, bytes: &[u8]) -> Result<&[u8], BytesError> {
        let Self { name, words: kind } = self;
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
        Ok(rest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KIND: Kind = Kind {
        name: b"sinew test v1 \r\n",
        words: "test",
    };

    type Sample = (Vec<f64>, Option<u32>, bool);

    fn sample() -> Vec<u8> {
        let value: Sample = (vec![0.1, -0.0, f64::NAN], Some(7), true);
        write(KIND, &value).unwrap()
    }

    #[test]
    fn what_was_written_is_read_with_the_same_bits() {
        let (numbers, name, flag): Sample = read(KIND, &sample()).unwrap();
        let bits: Vec<u64> = numbers.iter().map(|number| number.to_bits()).collect();
        assert_eq!(bits, [0.1, -0.0, f64::NAN].map(f64::to_bits));
        assert_eq!((name, flag), (Some(7), true));
        let longer = read::<Vec<f64>>(KIND, &sample());
        assert_eq!(longer.unwrap_err(), KIND.impossible("content"));
        let shorter = read::<(Sample, u64)>(KIND, &sample());
        assert_eq!(shorter.unwrap_err(), KIND.impossible("content"));
    }

    #[test]
    fn every_cut_says_so() {
        let bytes = sample();
        for length in 0..bytes.len() {
            let refused = read::<Sample>(KIND, &bytes[..length]).err();
            assert!(
                matches!(refused, Some(BytesError::Cut { found, .. }) if found == length),
                "{length}: {refused:?}"
            );
        }
        let mut longer = bytes;
        longer.push(0);
        let refused = read::<Sample>(KIND, &longer).err();
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
            let refused = read::<Sample>(KIND, &flipped).err();
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
        // A length without its items, as `Vec` begins with.
        let bytes = write(KIND, &(u64::MAX / 8)).unwrap();
        assert_eq!(
            read::<Vec<f64>>(KIND, &bytes).unwrap_err(),
            KIND.impossible("content")
        );
    }
}
