//! Files that are kept up to date with a session.

use std::fs::{File, OpenOptions};
use std::io::{self, Seek, Write};
use std::path::{Path, PathBuf};

use super::Log;
use super::text::{end, head, push_entry};

/// A file that is kept up to date with the log of a session, so that one that is killed is not lost: [`Log::read`] takes it as far
/// as its last command.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
    /// Commands in the file; `None` as long as nothing stands in it.
    entries: Option<usize>,
    text: String,
}

/// A file of a journal that cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JournalError {
    /// The file of an earlier session.
    #[error(
        "{path}: the log of a session that was not recorded to its end; `sinew run SCENE --replay {path} --out DIR` repeats it: move it, or remove it",
        path = .path.display()
    )]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// A file that cannot be written.
    #[error("{path}: {source}", path = .path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The error.
        source: io::Error,
    },
}

impl Journal {
    /// Creates the file, which must not exist.
    ///
    /// # Errors
    /// [`JournalError`] where there is one, or it cannot be created.
    pub fn create(path: PathBuf) -> Result<Self, JournalError> {
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Ok(file) => Ok(Self {
                path,
                file,
                entries: None,
                text: String::new(),
            }),
            Err(source) if source.kind() == io::ErrorKind::AlreadyExists => {
                Err(JournalError::Exists { path })
            }
            Err(source) => Err(JournalError::Write { path, source }),
        }
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Forgets what stands in the file, for the log of another session.
    ///
    /// # Errors
    /// [`JournalError`].
    pub fn begin_anew(&mut self) -> Result<(), JournalError> {
        self.entries = None;
        let emptied = self.file.set_len(0).and_then(|()| self.file.rewind());
        emptied.map_err(|source| self.error(source))
    }

    /// Adds the commands that are new in a log, up to the last step: poses after it may give way to later ones.
    ///
    /// # Errors
    /// [`JournalError`].
    pub fn keep_up(&mut self, log: &Log) -> Result<(), JournalError> {
        let settled = log
            .entries()
            .partition_point(|entry| entry.step < log.steps());
        self.add(log, settled)
    }

    /// Adds all that is new in the log of a session that has ended, and its end.
    ///
    /// # Errors
    /// [`JournalError`].
    pub fn finish(mut self, log: &Log) -> Result<(), JournalError> {
        self.add(log, log.entries().len())?;
        let written = self.file.write_all(end(log).as_bytes());
        written.map_err(|source| self.error(source))
    }

    /// Adds the commands up to a place in a log.
    fn add(&mut self, log: &Log, until: usize) -> Result<(), JournalError> {
        self.text.clear();
        if self.entries.is_none() {
            self.text.push_str(&head(log.header()));
        }
        let first = self.entries.unwrap_or(0);
        for entry in log.entries().get(first..until).unwrap_or_default() {
            push_entry(&mut self.text, entry);
        }
        self.entries = Some(first.max(until));
        let written = self.file.write_all(self.text.as_bytes());
        written.map_err(|source| self.error(source))
    }

    fn error(&self, source: io::Error) -> JournalError {
        JournalError::Write {
            path: self.path.clone(),
            source,
        }
    }
}
