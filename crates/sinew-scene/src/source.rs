//! The text of a scene and where it came from.

use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};

/// The text of a scene file, kept so that messages can point at a line of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SceneSource {
    path: PathBuf,
    text: String,
    /// True if the text was made of values that a program gave: nobody has seen its lines.
    is_of_values: bool,
}

impl SceneSource {
    /// A text and the path that messages show. Paths in the text are relative to the folder of this
    /// path.
    #[must_use]
    pub fn new(path: impl Into<PathBuf>, text: impl Into<String>) -> Self {
        Self {
            path: path.into(),
            text: text.into(),
            is_of_values: false,
        }
    }

    /// A text that was made of values of a program, of which messages name keys in the place of lines.
    pub(crate) fn of_values(path: impl Into<PathBuf>, text: impl Into<String>) -> Self {
        Self {
            is_of_values: true,
            ..Self::new(path, text)
        }
    }

    /// True if messages name keys in the place of lines.
    pub(crate) fn is_of_values(&self) -> bool {
        self.is_of_values
    }

    /// The path as the user gave it.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The whole text; empty if the file could not be read.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// A path written in the scene, made relative to the same folder as the scene's own path.
    #[must_use]
    pub fn resolve(&self, written: &Path) -> PathBuf {
        match self.path.parent() {
            Some(folder) => folder.join(written),
            None => written.to_owned(),
        }
    }

    /// Line and column of a byte, both counted from 1, the column in characters.
    #[must_use]
    pub fn position(&self, byte: usize) -> (usize, usize) {
        let before = self
            .text
            .as_bytes()
            .get(..byte)
            .unwrap_or(self.text.as_bytes());
        let line_start = before
            .iter()
            .rposition(|&b| b == b'\n')
            .map_or(0, |at| at + 1);
        let line = 1 + before.iter().filter(|&&b| b == b'\n').count();
        let column = 1 + String::from_utf8_lossy(&before[line_start..])
            .chars()
            .count();
        (line, column)
    }
}

/// Size of a file beyond which it is no scene that someone wrote (bytes).
const LARGEST: u64 = 16 << 20;

/// The text of a scene file. Pipes, devices and files without end are not waited for.
pub(crate) fn text_of(path: &Path) -> io::Result<String> {
    let refused = |reason: String| io::Error::new(ErrorKind::InvalidInput, reason);
    // Checked before it is opened, which would wait for the writer of a pipe.
    if !std::fs::metadata(path)?.is_file() {
        return Err(refused("it is no file; expected a file of TOML".to_owned()));
    }
    let mut text = String::new();
    let read = File::open(path)?
        .take(LARGEST + 1)
        .read_to_string(&mut text);
    if text.len() as u64 > LARGEST {
        let reason = format!("it is larger than {} MB; expected a scene", LARGEST >> 20);
        return Err(refused(reason));
    }
    read.map(|_| text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_count_lines_and_characters_from_one() {
        let source = SceneSource::new("a/b.toml", "x = 1\né = 2\n");
        assert_eq!(source.position(0), (1, 1));
        assert_eq!(source.position(4), (1, 5));
        assert_eq!(source.position(6), (2, 1));
        assert_eq!(
            source.position(9),
            (2, 3),
            "é is two bytes and one character"
        );
        assert_eq!(source.position(999), (3, 1), "past the end is the end");
    }

    #[test]
    fn paths_are_relative_to_the_scene() {
        let source = SceneSource::new("a/b.toml", "");
        assert_eq!(
            source.resolve(Path::new("../m.msh")),
            Path::new("a/../m.msh")
        );
        assert_eq!(source.resolve(Path::new("/m.msh")), Path::new("/m.msh"));
    }
}
