//! Files that grow line by line.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::PathBuf;

use super::error::OutputError;

/// A file that grows line by line. Flushed content remains if the process is killed.
#[derive(Debug)]
pub struct GrowingFile {
    path: PathBuf,
    length: u64,
    file: BufWriter<File>,
}

impl GrowingFile {
    /// A file that is open for writing at its end, after this number of bytes.
    pub(super) fn new(path: PathBuf, length: u64, file: File) -> Self {
        Self {
            path,
            length,
            file: BufWriter::new(file),
        }
    }

    /// Appends to its end.
    ///
    /// # Errors
    /// [`OutputError::Failed`].
    pub fn push(&mut self, content: &str) -> Result<(), OutputError> {
        let written = self.file.write_all(content.as_bytes());
        written.map_err(|source| OutputError::failed(&self.path, source))?;
        self.length += content.len() as u64;
        Ok(())
    }

    /// Makes sure that all of its content is on the disk, and returns its length in bytes.
    ///
    /// # Errors
    /// [`OutputError::Failed`].
    pub fn secure(&mut self) -> Result<u64, OutputError> {
        let secured = self
            .file
            .flush()
            .and_then(|()| self.file.get_ref().sync_data());
        secured.map_err(|source| OutputError::failed(&self.path, source))?;
        Ok(self.length)
    }
}
