//! Numbers as text, or as bytes, most significant first.

use crate::reading::cursor::{Cursor, Token, quoted};
use crate::reading::fault::Fault;
use crate::reading::number;
use crate::unstructured::{ByteOrder, Scalar};

/// The encoding of a file's numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Numbers {
    Text,
    Bytes,
}

/// A type of values, by its name in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ValueType {
    Number(Scalar),
    /// Bits, eight in a byte.
    Bit,
    Text,
}

impl ValueType {
    /// Reads a type's name.
    pub(super) fn read(cursor: &mut Cursor<'_>) -> Result<ValueType, Fault> {
        let token = cursor.token("the type of the numbers")?;
        let name = token.text.to_ascii_lowercase();
        Ok(ValueType::Number(match name.as_slice() {
            b"char" | b"signed_char" | b"vtktypeint8" => Scalar::I8,
            b"unsigned_char" | b"vtktypeuint8" => Scalar::U8,
            b"short" | b"vtktypeint16" => Scalar::I16,
            b"unsigned_short" | b"vtktypeuint16" => Scalar::U16,
            b"int" | b"vtkidtype" | b"vtktypeint32" => Scalar::I32,
            b"unsigned_int" | b"vtktypeuint32" => Scalar::U32,
            b"long" | b"long_long" | b"vtktypeint64" => Scalar::I64,
            b"unsigned_long" | b"unsigned_long_long" | b"vtktypeuint64" => Scalar::U64,
            b"float" | b"vtktypefloat32" => Scalar::F32,
            b"double" | b"vtktypefloat64" => Scalar::F64,
            b"bit" | b"vtktypebit" => return Ok(ValueType::Bit),
            b"string" | b"utf8_string" => return Ok(ValueType::Text),
            _ => {
                let problem = format!("the type of the numbers is {}", quoted(token.text));
                let expected = "a type such as int, vtktypeint64, float or double";
                return Err(Fault::new(token.offset, problem, expected));
            }
        }))
    }

    pub(super) fn is_integer(self) -> bool {
        match self {
            ValueType::Number(scalar) => scalar.is_integer(),
            ValueType::Bit => true,
            ValueType::Text => false,
        }
    }
}

impl Numbers {
    /// `count` numbers of a type, which begin on the next line.
    pub(super) fn doubles(
        self,
        cursor: &mut Cursor<'_>,
        kind: ValueType,
        count: u64,
    ) -> Result<Vec<f64>, Fault> {
        match (self, kind) {
            (Numbers::Text, _) => {
                let is_single = kind == ValueType::Number(Scalar::F32);
                words(cursor, count, |token, what| {
                    let value = number::double(token, what)?;
                    // The number that the text represents has single precision.
                    Ok(if is_single {
                        f64::from(value as f32)
                    } else {
                        value
                    })
                })
            }
            (Numbers::Bytes, ValueType::Number(scalar)) => {
                let bytes = bytes(cursor, count, scalar.size() as u64)?;
                Ok(scalar.doubles(bytes, ByteOrder::Big))
            }
            (Numbers::Bytes, ValueType::Bit) => {
                let packed = bytes(cursor, count.div_ceil(8), 1)?;
                let bits = packed
                    .iter()
                    .flat_map(|byte| (0..8).rev().map(move |bit| f64::from(byte >> bit & 1)));
                Ok(bits
                    .take(usize::try_from(count).unwrap_or(usize::MAX))
                    .collect())
            }
            (Numbers::Bytes, ValueType::Text) => Ok(Vec::new()),
        }
    }

    /// `count` whole numbers of a type, which begin on the next line.
    pub(super) fn integers(
        self,
        cursor: &mut Cursor<'_>,
        scalar: Scalar,
        count: u64,
    ) -> Result<Vec<i64>, Fault> {
        match self {
            Numbers::Text => words(cursor, count, number::signed_long),
            Numbers::Bytes => {
                let offset = cursor.offset();
                let bytes = bytes(cursor, count, scalar.size() as u64)?;
                let integers = scalar.integers(bytes, ByteOrder::Big);
                integers.ok_or_else(|| {
                    let problem = "the numbers have fractions by their type";
                    Fault::new(offset, problem, "a type of whole numbers")
                })
            }
        }
    }

    /// Skips `count` texts: one on each line, or bytes after their length.
    pub(super) fn skip_texts(self, cursor: &mut Cursor<'_>, count: u64) -> Result<(), Fault> {
        cursor.line_end("the type of texts")?;
        for _ in 0..count {
            let offset = cursor.offset();
            let is_there = match self {
                Numbers::Text => {
                    !cursor.is_at_end() && {
                        let _ = cursor.line();
                        true
                    }
                }
                Numbers::Bytes => skip_text(cursor).is_some(),
            };
            if !is_there {
                let expected = format!("{count} texts");
                return Err(Fault::new(offset, "the file ends here", expected));
            }
        }
        Ok(())
    }
}

/// Skips a text: the first two bits give the number of bytes of its length.
fn skip_text(cursor: &mut Cursor<'_>) -> Option<()> {
    let &[first] = cursor.take(1)? else {
        return None;
    };
    let more = match first >> 6 {
        3 => 0,
        2 => 1,
        1 => 3,
        _ => 7,
    };
    let rest = cursor.take(more)?;
    let length = rest.iter().fold(u64::from(first & 0x3f), |length, byte| {
        length << 8 | u64::from(*byte)
    });
    cursor.take(usize::try_from(length).ok()?).map(drop)
}

fn words<'a, T>(
    cursor: &mut Cursor<'a>,
    count: u64,
    read: impl Fn(Token<'a>, &str) -> Result<T, Fault>,
) -> Result<Vec<T>, Fault> {
    let mut numbers = Vec::new();
    for number in 0..count {
        let in_entry = |fault: Fault| fault.in_record("entry", number + 1, count);
        let token = cursor.token("a number").map_err(in_entry)?;
        numbers.push(read(token, "a number").map_err(in_entry)?);
    }
    Ok(numbers)
}

fn bytes<'a>(cursor: &mut Cursor<'a>, count: u64, size: u64) -> Result<&'a [u8], Fault> {
    cursor.line_end("the type or the count of the numbers")?;
    let offset = cursor.offset();
    let length = count
        .checked_mul(size)
        .and_then(|length| usize::try_from(length).ok());
    length
        .and_then(|length| cursor.take(length))
        .ok_or_else(|| {
            let left = cursor.rest().len();
            let expected = format!("{count} numbers of {size} bytes");
            Fault::new(
                offset,
                format!("the file ends after {left} bytes"),
                expected,
            )
        })
}

/// The numbers of `count` points or cells with `components` numbers each.
pub(super) fn times(count: u64, components: u64, offset: usize) -> Result<u64, Fault> {
    count.checked_mul(components).ok_or_else(|| {
        let problem = format!("{components} numbers for each of {count} are too many");
        Fault::new(offset, problem, "fewer than 2^64")
    })
}
