//! Files that are updated during a session.

use std::fs::{File, OpenOptions};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use sinew_core::Revision;

use super::Log;
use super::text::{end, head, push_entries};

/// A file that is updated with the log of a session, so that the log of a killed session is not lost: [`Log::read`]
/// reads it up to its last command.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
    /// Number of commands in the file; `None` while it is empty.
    entries: Option<usize>,
    /// Number of returns to earlier moments in the file.
    returns: usize,
    /// The revision of the log that begins with these commands.
    beginning: Option<Revision>,
    /// Number of bytes of the file that are whole lines.
    length: u64,
    /// True if something could not be written.
    has_failed: bool,
    /// True if there may be more in the file than the whole lines.
    has_rest: bool,
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

impl JournalError {
    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        match self {
            Self::Exists { path } | Self::Write { path, .. } => path,
        }
    }
}

impl Journal {
    /// Creates the file. An existing one must be empty, as left by a session that was killed before its first command.
    ///
    /// # Errors
    /// [`JournalError`] if there is one that is not empty, or it cannot be created.
    pub fn create(path: PathBuf) -> Result<Self, JournalError> {
        match open(&path) {
            Ok(Some(file)) => Ok(Self {
                path,
                file,
                entries: None,
                returns: 0,
                beginning: None,
                length: 0,
                has_failed: false,
                has_rest: false,
                text: String::new(),
            }),
            Ok(None) => Err(JournalError::Exists { path }),
            Err(source) => Err(JournalError::Write { path, source }),
        }
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Empties the file, for the log of another session.
    ///
    /// # Errors
    /// [`JournalError`].
    pub fn begin_anew(&mut self) -> Result<(), JournalError> {
        (self.entries, self.returns, self.beginning) = (None, 0, None);
        (self.length, self.has_failed, self.has_rest) = (0, false, true);
        self.cut().map_err(|source| self.error(source))
    }

    /// Adds the commands that are new in a log, except those after the last step: poses among them may be replaced by
    /// later ones. If the log became shorter, as after a restore of the world, the file is rewritten. Commands that
    /// could not be written are tried again, and the failure is reported once.
    ///
    /// # Errors
    /// [`JournalError`].
    pub fn keep_up(&mut self, log: &Log) -> Result<(), JournalError> {
        let settled = log
            .entries()
            .partition_point(|entry| entry.step < log.steps());
        self.go_back_with(log);
        let is_known = self.has_failed;
        let kept = match settled {
            // Without a command a file is taken over.
            0 if log.went_back().is_empty() => self.cut().map_err(|source| self.error(source)),
            _ => self.add(log, settled),
        };
        self.has_failed = kept.is_err();
        kept.or_else(|error| match is_known {
            true => Ok(()),
            false => Err(error),
        })
    }

    /// Adds all that is new in the log of a session that has ended, and its end.
    ///
    /// # Errors
    /// [`JournalError`] if the file does not contain the whole log.
    pub fn finish(mut self, log: &Log) -> Result<(), JournalError> {
        self.go_back_with(log);
        self.add(log, log.entries().len())?;
        let written = self.file.write_all(end(log).as_bytes());
        written.map_err(|source| self.error(source))
    }

    /// Discards everything that was written if it is not the beginning of the log.
    fn go_back_with(&mut self, log: &Log) {
        if self.beginning.replace(log.beginning) == Some(log.beginning) {
            return;
        }
        self.has_rest |= self.length > 0;
        (self.entries, self.returns, self.length) = (None, 0, 0);
    }

    /// Adds the commands up to an index in a log.
    fn add(&mut self, log: &Log, until: usize) -> Result<(), JournalError> {
        self.text.clear();
        if self.entries.is_none() {
            self.text.push_str(&head(log.header()));
        }
        let first = self.entries.unwrap_or(0);
        let mut returns = self.returns;
        push_entries(&mut self.text, log, first..first.max(until), &mut returns);
        let written = self.append();
        self.has_rest = written.is_err();
        written.map_err(|source| self.error(source))?;
        (self.entries, self.returns) = (Some(first.max(until)), returns);
        self.length += self.text.len() as u64;
        Ok(())
    }

    /// Writes the text after the last whole line of the file. A partial line that a full disk left is overwritten.
    fn append(&mut self) -> io::Result<()> {
        self.cut()?;
        self.file.write_all(self.text.as_bytes())
    }

    /// Truncates the file after the last whole line.
    fn cut(&mut self) -> io::Result<()> {
        if self.has_rest {
            self.file.set_len(self.length)?;
            self.file.seek(SeekFrom::Start(self.length))?;
            self.has_rest = false;
        }
        Ok(())
    }

    fn error(&self, source: io::Error) -> JournalError {
        JournalError::Write {
            path: self.path.clone(),
            source,
        }
    }
}

/// A file that is created, or an empty one; `None` if it has content.
fn open(path: &Path) -> io::Result<Option<File>> {
    let mut options = OpenOptions::new();
    options.write(true);
    match options.clone().create_new(true).open(path) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
        other => return other.map(Some),
    }
    let facts = path.symlink_metadata()?;
    if !facts.is_file() || facts.len() > 0 {
        return Ok(None);
    }
    options.open(path).map(Some)
}

#[cfg(test)]
mod tests {
    use sinew_scene::{Scene, SceneSource};

    use super::*;
    use crate::command::Command;
    use crate::world::World;

    const SPRING: &str = "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = -5.0\n\
        [run]\nduration = 1.0\nintegrator = \"central-difference\"\ndt = 0.01\n";

    #[test]
    fn a_journal_that_could_not_be_kept_up_catches_up_as_soon_as_it_can() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.log");
        let scene = Scene::parse(SceneSource::new("spring.toml", SPRING)).unwrap();
        let mut session = World::new(scene).unwrap();
        let mut journal = Journal::create(path.clone()).unwrap();
        let mut drive = |journal: &mut Journal, dt: f64| {
            session.command(Command::Dt(dt)).unwrap();
            session.step().unwrap();
            let kept = journal.keep_up(session.log());
            (kept.is_ok(), session.log().clone())
        };
        assert!(drive(&mut journal, 0.005).0);
        // For a time nothing can be written.
        let writable = std::mem::replace(&mut journal.file, File::open(&path).unwrap());
        assert!(!drive(&mut journal, 0.004).0, "it is told");
        assert!(drive(&mut journal, 0.003).0, "it is told once");
        assert_eq!(Log::read(&path).unwrap().entries().len(), 1);
        // A part of a line got through.
        journal.file = writable;
        journal.file.write_all(b"dt 0.0").unwrap();
        let (is_kept, log) = drive(&mut journal, 0.002);
        assert!(is_kept);
        let kept = Log::read(&path).unwrap();
        assert_eq!(kept.entries(), &log.entries()[..kept.entries().len()]);
        assert_eq!(kept.entries().len(), 4);
        journal.finish(&log).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), log.to_text());
    }

    #[test]
    fn what_is_left_without_a_command_is_taken_over() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.log");
        let scene = Scene::parse(SceneSource::new("spring.toml", SPRING)).unwrap();
        let mut session = World::new(scene).unwrap();
        session.step().unwrap();
        let mut journal = Journal::create(path.clone()).unwrap();
        journal.keep_up(session.log()).unwrap();
        drop(journal);
        assert!(Journal::create(path.clone()).is_ok());
        std::fs::write(&path, "x").unwrap();
        let refused = Journal::create(path.clone()).unwrap_err();
        assert_eq!(refused.path(), path);
        assert!(matches!(refused, JournalError::Exists { .. }));
    }
}
