//! Folders that several outputs go to.

use std::fs;
use std::path::{Path, PathBuf};

use super::place::folder_of;
use super::whole_file::WholeFile;
use super::{Destination, OutputError};

/// A folder for outputs, made when the first of them is written. Each file in it goes through the
/// door of a [`Destination`].
#[derive(Debug, Clone)]
pub struct OutputFolder {
    path: PathBuf,
    inputs: Vec<PathBuf>,
}

impl OutputFolder {
    /// The folder at `path` for a run that reads `inputs`. Nothing is looked at yet.
    #[must_use]
    pub fn new(path: impl Into<PathBuf>, inputs: &[PathBuf]) -> Self {
        Self {
            path: path.into(),
            inputs: inputs.to_vec(),
        }
    }

    /// Its path as it was given.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Checks, before long work, that the folder is there or can be made, takes new files, and that
    /// files of these names may be written in it. Nothing stays of the check.
    ///
    /// # Errors
    /// [`OutputError`] for the first that is refused.
    pub fn check(&self, names: &[String]) -> Result<(), OutputError> {
        let exists = |path: &&Path| path.as_os_str().is_empty() || path.symlink_metadata().is_ok();
        let nearest = self.path.ancestors().find(exists).unwrap_or(&self.path);
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
        if nearest != self.path {
            return Ok(());
        }
        for name in names {
            Destination::new(self.path.join(name), &self.inputs)?;
        }
        Ok(())
    }

    /// Writes a file of this name and tells its path.
    ///
    /// # Errors
    /// [`OutputError`]; a file that was there is then as it was.
    pub fn write(&self, name: &str, content: &[u8]) -> Result<PathBuf, OutputError> {
        let path = self.path.join(name);
        let folder = folder_of(&path);
        fs::create_dir_all(folder).map_err(|source| OutputError::NotOpened {
            path: folder.to_owned(),
            source,
        })?;
        // A reader that left asked for no more; there is nobody to tell.
        let _ = Destination::new(&path, &self.inputs)?.write(content)?;
        Ok(path)
    }
}
