//! An error that is passed up. Every level adds its own place to it.

use super::error::MeshError;
use crate::warning::Position;

/// An error of the decoders. It is boxed, because it is returned from the innermost loops.
#[derive(Debug)]
pub(crate) struct Fault(Box<Details>);

#[derive(Debug)]
struct Details {
    offset: usize,
    /// The places, innermost first.
    places: Vec<String>,
    problem: String,
    expected: String,
    is_shortage: bool,
    is_unsupported: bool,
}

impl Fault {
    pub(crate) fn new(
        offset: usize,
        problem: impl Into<String>,
        expected: impl Into<String>,
    ) -> Fault {
        Fault(Box::new(Details {
            offset,
            places: Vec::new(),
            problem: problem.into(),
            expected: expected.into(),
            is_shortage: false,
            is_unsupported: false,
        }))
    }

    /// An error of data that end too early. The place of the record adds the declared number.
    pub(crate) fn shortage(
        offset: usize,
        problem: impl Into<String>,
        expected: impl Into<String>,
    ) -> Fault {
        let mut fault = Fault::new(offset, problem, expected);
        fault.0.is_shortage = true;
        fault
    }

    /// An error of a file that may be valid, but that this reader cannot read.
    pub(crate) fn unsupported(
        offset: usize,
        problem: impl Into<String>,
        advice: impl Into<String>,
    ) -> Fault {
        let mut fault = Fault::new(offset, problem, advice);
        fault.0.is_unsupported = true;
        fault
    }

    pub(crate) fn offset(&self) -> usize {
        self.0.offset
    }

    pub(crate) fn inside(mut self, place: impl Into<String>) -> Fault {
        self.0.places.push(place.into());
        self
    }

    /// Adds the place of a record, whose `number` counts from 1.
    pub(crate) fn in_record(self, record: &str, number: u64, of: u64) -> Fault {
        if self.0.is_shortage {
            self.inside(format!("{record} {number} of {of}"))
        } else {
            self.inside(format!("{record} {number}"))
        }
    }

    pub(crate) fn into_error(self, bytes: &[u8], lines: Lines) -> MeshError {
        let details = *self.0;
        let at = position(bytes, details.offset, lines);
        let mut places = details.places;
        places.reverse();
        let place = places.join(", ");
        if details.is_unsupported {
            MeshError::Unsupported {
                at,
                place,
                problem: details.problem,
                advice: details.expected,
            }
        } else {
            MeshError::Malformed {
                at,
                place,
                problem: details.problem,
                expected: details.expected,
            }
        }
    }
}

/// Use of line numbers for places in a file.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) enum Lines {
    #[default]
    Count,
    /// No line numbers: the file is binary.
    DoNot,
}

/// The position of an offset: its byte, and its line in a text file.
fn position(bytes: &[u8], offset: usize, lines: Lines) -> Position {
    let before = bytes.get(..offset).unwrap_or(bytes);
    let line = || before.iter().filter(|&&byte| byte == b'\n').count() as u64 + 1;
    Position {
        line: (lines == Lines::Count).then(line),
        byte: offset as u64,
    }
}
