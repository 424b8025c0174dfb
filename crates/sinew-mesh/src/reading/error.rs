//! Errors in the bytes of a mesh file.

use crate::warning::Position;

/// Error of bytes that are not a readable mesh file of their format.
///
/// The message is `place in the file: section, block, row: what is wrong; expected ...`.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// The contents break the format or contradict themselves.
    #[error("{at}: {}{problem}; expected {expected}", before_problem(place))]
    Malformed {
        /// Place in the file.
        at: Position,
        /// Section, block and row, e.g. `$Elements, block 2, element 17` or `CellData, array "labels"`; empty outside of them.
        place: String,
        /// The problem.
        problem: String,
        /// The contents that are expected there.
        expected: String,
    },
    /// The file may be valid, but uses a feature that this reader does not support.
    #[error("{at}: {}{problem}; {advice}", before_problem(place))]
    Unsupported {
        /// Place in the file.
        at: Position,
        /// Section, block and row; empty outside sections.
        place: String,
        /// The feature that is not supported.
        problem: String,
        /// Advice to the user.
        advice: String,
    },
}

impl MeshError {
    /// Place of the error in the file.
    #[must_use]
    pub fn position(&self) -> Position {
        match self {
            MeshError::Malformed { at, .. } | MeshError::Unsupported { at, .. } => *at,
        }
    }

    /// The message for a named file: `file.msh:57 (byte 2310): ...`.
    pub(crate) fn message_for(&self, file: &str) -> String {
        let at = self.position();
        let message = self.to_string();
        let without_position = message.strip_prefix(&at.to_string()).unwrap_or(&message);
        match at.line {
            Some(line) => format!("{file}:{line} (byte {}){without_position}", at.byte),
            None => format!("{file} (byte {}){without_position}", at.byte),
        }
    }
}

fn before_problem(place: &str) -> String {
    if place.is_empty() {
        String::new()
    } else {
        format!("{place}: ")
    }
}
