//! Folders for several outputs.

use std::fs;
use std::io::ErrorKind;
use std::path::{Component, Path, PathBuf};

use super::destination::Destination;
use super::error::OutputError;
use super::target::folder_of;
use super::whole_file::WholeFile;

/// A folder for outputs, created when the first of them is written. Each file in it is written
/// through a [`Destination`].
#[derive(Debug, Clone)]
pub struct OutputFolder {
    path: PathBuf,
    inputs: Vec<PathBuf>,
}

impl OutputFolder {
    /// The folder at `path` for a run that reads `inputs`. Nothing is checked yet.
    #[must_use]
    pub fn new(path: impl Into<PathBuf>, inputs: &[PathBuf]) -> Self {
        Self {
            path: path.into(),
            inputs: inputs.to_vec(),
        }
    }

    /// Its path as given.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Checks, before long work, that the folder exists or can be created, that it accepts new files, and that files of
    /// these names may be written in it, no two of them the same file. Leaves no files behind.
    ///
    /// # Errors
    /// [`OutputError`] for the first path that is refused.
    pub fn check(&self, names: &[String]) -> Result<(), OutputError> {
        let folder = once_made(&self.path);
        let exists = |path: &&Path| path.as_os_str().is_empty() || path.symlink_metadata().is_ok();
        let nearest = folder.ancestors().find(exists).unwrap_or(&folder);
        let missing = folder.strip_prefix(nearest).unwrap_or(&folder);
        let nearest = if nearest.as_os_str().is_empty() {
            Path::new(".")
        } else {
            nearest
        };
        if !nearest.is_dir() {
            let path = nearest.to_owned();
            return Err(OutputError::NotAFolder { path });
        }
        WholeFile::create(&nearest.join("check")).map_err(|source| OutputError::NotOpened {
            path: self.path.clone(),
            source,
        })?;
        if missing.as_os_str().is_empty() {
            return self.check_files(nearest, names);
        }
        let new_names = missing.iter().map(Path::new);
        for name in new_names.chain(names.iter().map(Path::new)) {
            may_be_called(&nearest.join(name))?;
        }
        names
            .iter()
            .try_for_each(|name| may_be_called(&self.path.join(name)))
    }

    /// Checks the files in a folder that exists.
    fn check_files(&self, folder: &Path, names: &[String]) -> Result<(), OutputError> {
        let mut outputs: Vec<Destination> = Vec::with_capacity(names.len());
        for name in names {
            let output = Destination::new(folder.join(name), &self.inputs)?;
            if let Some(other) = outputs.iter().find(|other| other.is_same_file(&output)) {
                return Err(OutputError::Shared {
                    path: output.path().to_owned(),
                    other: other.path().to_owned(),
                });
            }
            outputs.push(output);
        }
        Ok(())
    }

    /// Writes a file of this name and returns its path.
    ///
    /// # Errors
    /// [`OutputError`]; an existing file is then unchanged.
    pub fn write(&self, name: &str, content: &[u8]) -> Result<PathBuf, OutputError> {
        let path = self.path.join(name);
        let folder = folder_of(&path);
        fs::create_dir_all(folder).map_err(|source| OutputError::NotOpened {
            path: folder.to_owned(),
            source,
        })?;
        // A reader that closed its pipe wants no more, which is no error.
        let _ = Destination::new(&path, &self.inputs)?.write(content)?;
        Ok(path)
    }
}

/// A folder's path without components that `..` cancels: `new/..` is the folder that contains `new`.
fn once_made(path: &Path) -> PathBuf {
    let mut folder = PathBuf::new();
    for component in path.components() {
        let is_new = folder.file_name().is_some() && folder.symlink_metadata().is_err();
        if component == Component::ParentDir && is_new {
            folder.pop();
        } else {
            folder.push(component);
        }
    }
    folder
}

/// Refuses a path that no file can have, for instance one with too long a name.
fn may_be_called(path: &Path) -> Result<(), OutputError> {
    match path.symlink_metadata() {
        Err(source) if source.kind() != ErrorKind::NotFound => Err(OutputError::NotOpened {
            path: path.to_owned(),
            source,
        }),
        _ => Ok(()),
    }
}
