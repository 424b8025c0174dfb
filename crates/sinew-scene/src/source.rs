//! The text of a scene and its origin.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sinew_mesh::TetMesh;

/// The text of a scene file, kept so that messages can point at a line of it, and further files that a program has in
/// memory.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SceneSource {
    path: PathBuf,
    text: String,
    /// True if the text was made from values of a program: the user has no lines.
    is_of_values: bool,
    /// Files by their resolved paths.
    given: BTreeMap<PathBuf, Given>,
}

/// A file that a program has in memory.
#[derive(Debug, Clone)]
struct Given {
    content: Arc<[u8]>,
    /// The mesh, if it is not read from the content.
    mesh: Option<Arc<TetMesh>>,
}

/// Files are compared by their content.
impl PartialEq for Given {
    fn eq(&self, other: &Self) -> bool {
        self.content == other.content && self.mesh.is_some() == other.mesh.is_some()
    }
}

impl Eq for Given {}

impl SceneSource {
    /// A text and the path that messages show. Paths in the text are relative to the folder of this
    /// path.
    #[must_use]
    pub fn new(path: impl Into<PathBuf>, text: impl Into<String>) -> Self {
        Self {
            path: path.into(),
            text: text.into(),
            is_of_values: false,
            given: BTreeMap::new(),
        }
    }

    /// A text that was made from values of a program. Messages name its keys instead of lines.
    #[must_use]
    pub fn of_values(path: impl Into<PathBuf>, text: impl Into<String>) -> Self {
        Self {
            is_of_values: true,
            ..Self::new(path, text)
        }
    }

    /// The same scene with another text.
    pub(crate) fn with_text(&self, text: String) -> Self {
        Self {
            text,
            ..self.clone()
        }
    }

    /// Adds a file that the scene reads: this content replaces that of the file at the path, which is a resolved one.
    ///
    /// ```
    /// use sinew_mesh::structured::{Split, cube};
    /// use sinew_mesh::write_msh41_ascii;
    /// use sinew_scene::{Scene, SceneSource};
    ///
    /// let mut mesh = Vec::new();
    /// write_msh41_ascii(&cube(2, 0.1, Split::Mirrored)?.to_mesh(), &mut mesh)?;
    /// let text = "[mesh]\nfile = \"mine.msh\"\n\
    ///     [[region]]\ndensity = 1000.0\nmodel = \"linear\"\nyoungs_modulus = 3000.0\npoissons_ratio = 0.4\n\
    ///     [run]\nduration = 0.1\nintegrator = \"central-difference\"\ndt = \"auto\"\n";
    /// let source = SceneSource::new("scene.toml", text).with_file("mine.msh", mesh);
    /// assert_eq!(Scene::parse(source)?.build()?.system().dofs(), 81);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_file(mut self, path: impl Into<PathBuf>, content: impl Into<Arc<[u8]>>) -> Self {
        let path = path.into();
        let content = content.into();
        let mesh = None;
        self.given.insert(path, Given { content, mesh });
        self
    }

    /// Adds the mesh of a scene, with the order of its nodes and tetrahedra, instead of the file at a resolved path.
    /// The content, bytes that the caller chooses, identifies the mesh.
    #[must_use]
    pub fn with_mesh(
        mut self,
        path: impl Into<PathBuf>,
        mesh: Arc<TetMesh>,
        content: impl Into<Arc<[u8]>>,
    ) -> Self {
        let path = path.into();
        let content = content.into();
        let mesh = Some(mesh);
        self.given.insert(path, Given { content, mesh });
        self
    }

    /// The content of a file that was given; `None` for one that is read from the disk. The path is a resolved one.
    #[must_use]
    pub fn given_file(&self, path: &Path) -> Option<&[u8]> {
        self.given.get(path).map(|given| &*given.content)
    }

    /// The mesh that was given for a resolved path.
    #[must_use]
    pub fn given_mesh(&self, path: &Path) -> Option<&Arc<TetMesh>> {
        self.given.get(path)?.mesh.as_ref()
    }

    /// The content of a file that the scene reads, by its resolved path.
    ///
    /// # Errors
    /// Errors of the file system, for a file that was not given.
    pub fn read(&self, path: &Path) -> io::Result<Cow<'_, [u8]>> {
        match self.given_file(path) {
            Some(content) => Ok(content.into()),
            None => fs::read(path).map(Cow::Owned),
        }
    }

    /// True if messages name keys instead of lines.
    #[must_use]
    pub fn is_of_values(&self) -> bool {
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

/// Largest size of a scene file (bytes).
const LARGEST: u64 = 16 << 20;

/// The text of a scene file. Pipes, devices and files without end are refused.
pub(crate) fn text_of(path: &Path) -> io::Result<String> {
    let refused = |reason: String| io::Error::new(ErrorKind::InvalidInput, reason);
    // Checked before it is opened, which would wait for the writer of a pipe.
    if !fs::metadata(path)?.is_file() {
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
