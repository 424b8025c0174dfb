//! Collects warnings while a file is read.

use super::fault::Lines;
use crate::warning::{Position, Warning};

/// Greatest number of warnings that are kept.
const KEPT: usize = 100;

#[derive(Debug, Default)]
pub(crate) struct Remarks {
    kept: Vec<(Option<usize>, String)>,
    dropped: usize,
    lines: Lines,
    /// The file's version is a bare 4, whose meaning had to be assumed.
    pub(crate) version_is_open: bool,
}

impl Remarks {
    /// Gives places by byte only from now on, because the file is binary.
    pub(crate) fn lines_mean_nothing(&mut self) {
        self.lines = Lines::DoNot;
    }

    /// Use of line numbers for places, as far as the file has been read.
    pub(crate) fn lines(&self) -> Lines {
        self.lines
    }

    /// Adds a remark about one place of the file.
    pub(crate) fn at(&mut self, offset: usize, message: impl Into<String>) {
        self.add(Some(offset), message.into());
    }

    /// Adds a remark if no line break closes the last line of a text, which may then have been cut inside a number.
    pub(crate) fn open_end(&mut self, bytes: &[u8]) {
        if bytes.last().is_some_and(|byte| !byte.is_ascii_whitespace()) {
            self.at(
                bytes.len(),
                "the file ends without a line break: its last line may have been cut",
            );
        }
    }

    /// Adds a remark about the file as a whole.
    pub(crate) fn general(&mut self, message: impl Into<String>) {
        self.add(None, message.into());
    }

    fn add(&mut self, offset: Option<usize>, message: String) {
        if self.kept.len() < KEPT {
            self.kept.push((offset, message));
        } else {
            self.dropped += 1;
        }
    }

    pub(crate) fn into_warnings(self, bytes: &[u8]) -> Vec<Warning> {
        let mut offsets: Vec<usize> = self.kept.iter().filter_map(|(offset, _)| *offset).collect();
        offsets.sort_unstable();
        let mut positions = positions(bytes, &offsets);
        if self.lines == Lines::DoNot {
            positions.iter_mut().for_each(|at| at.line = None);
        }
        let place = |offset: usize| {
            offsets
                .binary_search(&offset)
                .ok()
                .and_then(|i| positions.get(i))
        };
        let mut warnings: Vec<Warning> = self
            .kept
            .into_iter()
            .map(|(offset, message)| Warning {
                at: offset.and_then(|offset| place(offset).copied()),
                message,
            })
            .collect();
        if self.dropped > 0 {
            warnings.push(Warning {
                at: None,
                message: format!("{} more warnings", self.dropped),
            });
        }
        warnings
    }
}

/// Positions of ascending offsets, in one pass over the bytes.
fn positions(bytes: &[u8], ascending: &[usize]) -> Vec<Position> {
    let mut line = 1;
    let mut counted = 0;
    let mut positions = Vec::with_capacity(ascending.len());
    for &offset in ascending {
        let between = bytes.get(counted..offset).unwrap_or_default();
        line += between.iter().filter(|&&byte| byte == b'\n').count() as u64;
        counted = counted.max(offset);
        positions.push(Position {
            line: Some(line),
            byte: offset as u64,
        });
    }
    positions
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_found_whatever_their_order() {
        let mut remarks = Remarks::default();
        remarks.at(6, "third line");
        remarks.at(0, "start");
        remarks.general("everywhere");
        remarks.at(6, "again");
        let shown: Vec<String> = remarks
            .into_warnings(b"ab\ncd\nef\n")
            .iter()
            .map(Warning::to_string)
            .collect();
        assert_eq!(
            shown,
            [
                "line 3 (byte 6): third line",
                "line 1 (byte 0): start",
                "everywhere",
                "line 3 (byte 6): again"
            ]
        );
    }

    #[test]
    fn a_flood_is_counted_not_kept() {
        let mut remarks = Remarks::default();
        for _ in 0..1000 {
            remarks.general("again");
        }
        let warnings = remarks.into_warnings(b"");
        assert_eq!(warnings.len(), KEPT + 1);
        assert_eq!(
            warnings.last().map(|w| w.message.as_str()),
            Some("900 more warnings")
        );
    }
}
