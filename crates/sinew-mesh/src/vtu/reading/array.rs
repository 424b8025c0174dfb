//! Arrays of a file: the positions of their numbers, and the numbers.

use std::ops::Range;

use super::base64::Base64;
use super::encoding::{Encoding, Source, UnreadCompressor};
use super::xml::Tag;
use crate::reading::cursor::{Cursor, quoted};
use crate::reading::fault::Fault;
use crate::reading::number;
use crate::unstructured::Scalar;

/// An array, as described by its tag.
pub(super) struct Array {
    pub(super) name: String,
    /// The type of its numbers, by its name in the file.
    type_name: String,
    pub(super) components: usize,
    /// The tag's place.
    pub(super) offset: usize,
    place: Place,
}

/// The place of an array's numbers.
enum Place {
    Text(Range<usize>),
    Base64(Range<usize>),
    /// Offset in bytes from the beginning of the appended numbers.
    Appended(usize),
}

/// The numbers that follow the tags.
#[derive(Clone, Copy)]
pub(super) enum Appended<'a> {
    None,
    Raw(&'a [u8]),
    Base64(&'a [u8]),
}

/// All bytes of a file, with the data needed to find an array's numbers among them.
pub(super) struct File<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) encoding: Encoding,
    pub(super) unread_compressor: Option<&'a UnreadCompressor>,
    pub(super) appended: Appended<'a>,
}

impl Array {
    /// An array without numbers inside its tag so far.
    pub(super) fn of(tag: &Tag<'_>, otherwise: &str) -> Result<Array, Fault> {
        let name = tag.attribute("Name").filter(|name| !name.trim().is_empty());
        let name = name.unwrap_or_else(|| otherwise.to_owned());
        let fault = |problem: String, expected: &str| {
            Fault::new(tag.offset, problem, expected).inside(format!("array \"{name}\""))
        };
        let components = tag.count("NumberOfComponents", Some(1))?.max(1);
        let place = match tag.attribute("format").as_deref() {
            None | Some("ascii") => Place::Text(0..0),
            Some("binary") => Place::Base64(0..0),
            Some("appended") => Place::Appended(tag.count("offset", None)?),
            Some(other) => {
                let problem = format!("the format is {}", quoted(other.as_bytes()));
                return Err(fault(problem, "ascii, binary or appended"));
            }
        };
        let type_name = tag.attribute("type").unwrap_or_default();
        Ok(Array {
            type_name,
            components,
            offset: tag.offset,
            place,
            name,
        })
    }

    /// Takes the first text inside the tag that is not blank as the numbers.
    pub(super) fn take_text(&mut self, offset: usize, text: &[u8]) {
        if let Place::Text(range) | Place::Base64(range) = &mut self.place
            && range.start == range.end
            && !text.trim_ascii().is_empty()
        {
            *range = offset..offset + text.len();
        }
    }

    /// The type of the numbers; `None` for texts, bits and unknown types.
    pub(super) fn scalar(&self) -> Option<Scalar> {
        Some(match self.type_name.as_str() {
            "Int8" => Scalar::I8,
            "UInt8" => Scalar::U8,
            "Int16" => Scalar::I16,
            "UInt16" => Scalar::U16,
            "Int32" => Scalar::I32,
            "UInt32" => Scalar::U32,
            "Int64" => Scalar::I64,
            "UInt64" => Scalar::U64,
            "Float32" => Scalar::F32,
            "Float64" => Scalar::F64,
            _ => return None,
        })
    }

    /// Description of the type of the numbers.
    pub(super) fn type_in_words(&self) -> String {
        match self.type_name.as_str() {
            "" => "without a type".to_owned(),
            name => format!("of type {name}"),
        }
    }

    /// The numbers as f64.
    pub(super) fn doubles(&self, file: &File<'_>) -> Result<Vec<f64>, Fault> {
        let scalar = self.number_type()?;
        match self.text(file) {
            Some(text) => {
                let mut values = self.words(file, text, number::double)?;
                if scalar == Scalar::F32 {
                    // The number that the text represents has single precision.
                    values
                        .iter_mut()
                        .for_each(|value| *value = f64::from(*value as f32));
                }
                Ok(values)
            }
            None => Ok(scalar.doubles(&self.whole_bytes(file, scalar)?, file.encoding.order)),
        }
    }

    /// The numbers as whole ones.
    pub(super) fn integers(&self, file: &File<'_>) -> Result<Vec<i64>, Fault> {
        let scalar = self.number_type()?;
        if !scalar.is_integer() {
            let problem = format!("it is {}", self.type_in_words());
            return Err(self.fault(problem, "whole numbers"));
        }
        match self.text(file) {
            Some(text) => self.words(file, text, number::signed_long),
            None => {
                let bytes = self.whole_bytes(file, scalar)?;
                let integers = scalar.integers(&bytes, file.encoding.order);
                Ok(integers.unwrap_or_default())
            }
        }
    }

    fn number_type(&self) -> Result<Scalar, Fault> {
        let expected = "numbers of type Int8 to UInt64, Float32 or Float64";
        let problem = || format!("it is {}", self.type_in_words());
        self.scalar().ok_or_else(|| self.fault(problem(), expected))
    }

    fn text(&self, file: &File<'_>) -> Option<Range<usize>> {
        match &self.place {
            Place::Text(range) => Some(range.start..range.end.min(file.bytes.len())),
            Place::Base64(_) | Place::Appended(_) => None,
        }
    }

    /// The words of a text, each read by `read`.
    fn words<T>(
        &self,
        file: &File<'_>,
        text: Range<usize>,
        read: impl Fn(crate::reading::cursor::Token<'_>, &str) -> Result<T, Fault>,
    ) -> Result<Vec<T>, Fault> {
        let mut cursor = Cursor::at(file.bytes.get(..text.end).unwrap_or_default(), text.start);
        let mut numbers = Vec::new();
        loop {
            cursor.skip_blanks();
            if cursor.is_at_end() {
                return Ok(numbers);
            }
            let place = || format!("array \"{}\"", self.name);
            let token = cursor
                .token("a number")
                .map_err(|fault| fault.inside(place()))?;
            let number = read(token, "a number").map_err(|fault| {
                let ordinal = numbers.len() as u64 + 1;
                fault.in_record("entry", ordinal, 0).inside(place())
            })?;
            numbers.push(number);
        }
    }

    /// The bytes of the numbers, after a check that they are whole numbers of bytes.
    fn whole_bytes(&self, file: &File<'_>, scalar: Scalar) -> Result<Vec<u8>, Fault> {
        let source = match (&self.place, file.appended) {
            (Place::Base64(range) | Place::Text(range), _) => {
                let text = file.bytes.get(range.clone()).unwrap_or_default();
                if text.is_empty() {
                    return Ok(Vec::new());
                }
                Source::Base64(Base64::new(text))
            }
            (Place::Appended(offset), Appended::Raw(bytes)) => {
                Source::Raw(bytes.get(*offset..).unwrap_or_default())
            }
            (Place::Appended(offset), Appended::Base64(text)) => {
                Source::Base64(Base64::new(text.get(*offset..).unwrap_or_default()))
            }
            (Place::Appended(_), Appended::None) => {
                let problem = "its numbers are said to be appended, and the file has none";
                return Err(self.fault(problem, "<AppendedData> behind the grid"));
            }
        };
        if let Some(unread) = file.unread_compressor {
            return Err(unread.fault());
        }
        let bytes = file.encoding.bytes_of(source);
        let bytes = bytes.filter(|bytes| bytes.len().is_multiple_of(scalar.size()));
        bytes.ok_or_else(|| {
            let problem = "its bytes are cut off or damaged";
            self.fault(problem, "as many whole numbers as its head says")
        })
    }

    pub(super) fn fault(&self, problem: impl Into<String>, expected: impl Into<String>) -> Fault {
        Fault::new(self.offset, problem, expected).inside(format!("array \"{}\"", self.name))
    }
}
