//! Seals of files: their lengths and hashes, by which a continued run checks that they are unchanged.

use std::io::{self, Read, Write};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use sinew_scene::output::{GrowingFile, OwnedFolder};

use crate::error::RecordRunError;

/// Length and hash of the content of a file.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Seal {
    /// Length in bytes.
    pub(crate) length: u64,
    /// SHA-256 in hexadecimal digits.
    sha256: String,
}

/// A writer that passes everything on and seals it.
#[derive(Debug, Default)]
pub(crate) struct Sealing<W> {
    inner: W,
    length: u64,
    hash: Sha256,
}

impl<W> Sealing<W> {
    pub(crate) fn new(inner: W) -> Self {
        Self {
            inner,
            length: 0,
            hash: Sha256::new(),
        }
    }

    /// The seal of all bytes so far.
    pub(crate) fn seal(&self) -> Seal {
        let digest = self.hash.clone().finalize();
        Seal {
            length: self.length,
            sha256: digest.iter().map(|byte| format!("{byte:02x}")).collect(),
        }
    }

    fn see(&mut self, bytes: &[u8]) {
        self.hash.update(bytes);
        self.length += bytes.len() as u64;
    }
}

impl<W: Write> Write for Sealing<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.see(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

impl Seal {
    /// Reads the sealed part of a file in a folder and checks that it is unchanged; returns it with a seal that can be
    /// continued.
    ///
    /// # Errors
    /// [`RecordRunError::Altered`] with the difference.
    fn check(&self, folder: &OwnedFolder, name: &str) -> Result<Sealing<()>, RecordRunError> {
        let mut sealing = Sealing::new(());
        let Some(file) = folder.open(name)? else {
            return Err(altered(folder, name, "it is gone".to_owned()));
        };
        let mut sealed = file.take(self.length);
        let mut chunk = vec![0; 1 << 16];
        loop {
            match sealed.read(&mut chunk) {
                Ok(0) => break,
                Ok(read) => sealing.see(&chunk[..read]),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(altered(folder, name, error.to_string())),
            }
        }
        if sealing.length < self.length {
            let (found, expected) = (sealing.length, self.length);
            let reason = format!("{found} bytes are left of {expected}");
            return Err(altered(folder, name, reason));
        }
        match sealing.seal() == *self {
            true => Ok(sealing),
            false => Err(altered(folder, name, "its content is another".to_owned())),
        }
    }

    /// Checks that a whole file of a folder matches its seal.
    ///
    /// # Errors
    /// [`RecordRunError::Altered`].
    pub(crate) fn check_whole(
        &self,
        folder: &OwnedFolder,
        name: &str,
    ) -> Result<(), RecordRunError> {
        self.check_length(folder, name)?;
        self.check(folder, name)?;
        Ok(())
    }

    /// Checks, without reading it, that a file exists and has its length.
    ///
    /// # Errors
    /// [`RecordRunError::Altered`].
    pub(crate) fn check_length(
        &self,
        folder: &OwnedFolder,
        name: &str,
    ) -> Result<(), RecordRunError> {
        let file = folder.open(name)?;
        let found = file.and_then(|file| Some(file.metadata().ok()?.len()));
        match found {
            Some(found) if found == self.length => Ok(()),
            Some(found) => {
                let reason = format!("it has {found} bytes and had {}", self.length);
                Err(altered(folder, name, reason))
            }
            None => Err(altered(folder, name, "it is gone".to_owned())),
        }
    }
}

fn altered(folder: &OwnedFolder, name: &str, reason: String) -> RecordRunError {
    RecordRunError::Altered {
        path: folder.path().join(name),
        reason,
    }
}

/// A table that grows row by row under a seal.
#[derive(Debug)]
pub(crate) struct SealedTable {
    name: &'static str,
    file: GrowingFile,
    sealing: Sealing<()>,
}

impl SealedTable {
    /// Opens the file, truncated after the sealed bytes, or with its head only if nothing was sealed.
    ///
    /// # Errors
    /// [`RecordRunError`] for a file that differs from its seal.
    pub(crate) fn open(
        folder: &OwnedFolder,
        name: &'static str,
        sealed: &Seal,
        head: impl FnOnce() -> String,
    ) -> Result<Self, RecordRunError> {
        let is_new = sealed.length == 0;
        let sealing = match is_new {
            true => Sealing::new(()),
            false => sealed.check(folder, name)?,
        };
        let file = folder.append(name, sealed.length)?;
        let mut table = Self {
            name,
            file,
            sealing,
        };
        if is_new {
            table.push(&head())?;
        }
        Ok(table)
    }

    /// Appends a row.
    ///
    /// # Errors
    /// [`RecordRunError::Output`].
    pub(crate) fn push(&mut self, row: &str) -> Result<(), RecordRunError> {
        self.file.push(row)?;
        self.sealing.see(row.as_bytes());
        Ok(())
    }

    /// Makes sure that all of it is on the disk under its name, and seals it.
    ///
    /// # Errors
    /// [`RecordRunError`], also if its file was removed or replaced.
    pub(crate) fn secure(&mut self, folder: &OwnedFolder) -> Result<Seal, RecordRunError> {
        self.file.secure()?;
        let seal = self.sealing.seal();
        seal.check_length(folder, self.name)?;
        Ok(seal)
    }
}
