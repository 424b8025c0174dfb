//! Files of a folder that belongs to one result. Nothing outside it is read or written: a link in it is an error, and
//! so is another folder that has replaced it.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Seek, SeekFrom, Write};
use std::path::{Component, Path, PathBuf};
use std::sync::PoisonError;

use super::error::OutputError;
use super::growing_file::GrowingFile;
use super::identity::Identity;
use super::owned_folder::OwnedFolder;
use super::target::{Target, folder_of};
use super::whole_file::{WholeFile, sync_folder};

impl OwnedFolder {
    /// The content of a file; `None` if absent.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn read(&self, name: &str) -> Result<Option<Vec<u8>>, OutputError> {
        let path = self.inside(name)?;
        match fs::read(&path) {
            Ok(content) => Ok(Some(content)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(source) => Err(OutputError::not_opened(&path, source)),
        }
    }

    /// Opens a file for reading; `None` if absent.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn open(&self, name: &str) -> Result<Option<File>, OutputError> {
        let path = self.inside(name)?;
        match File::open(&path) {
            Ok(file) => Ok(Some(file)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(source) => Err(OutputError::not_opened(&path, source)),
        }
    }

    /// Writes a file as a whole and makes sure that it is on the disk.
    ///
    /// # Errors
    /// [`OutputError`]; an existing file is then unchanged.
    pub fn write(&self, name: &str, content: &[u8]) -> Result<(), OutputError> {
        let path = self.target(name)?;
        let write = |path: &Path| {
            let mut file = WholeFile::create(path)?;
            file.write_all(content)?;
            file.finish()
        };
        write(&path).map_err(|source| self.failed(&path, source))
    }

    /// The error for a failure to write; its reason may be that the folder was replaced.
    fn failed(&self, path: &Path, source: io::Error) -> OutputError {
        match self.check_identity() {
            Err(gone) => gone,
            Ok(()) => OutputError::failed(path, source),
        }
    }

    /// Writes a file as a whole, with a durable name after [`OwnedFolder::secure`] and durable content before: for
    /// many files that a checkpoint covers. A thread that writes next to a run does not delay it.
    ///
    /// # Errors
    /// [`OutputError`]; an existing file is then unchanged.
    pub fn write_lightly(
        &self,
        name: &str,
        fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        let path = self.target(name)?;
        let write = |path: &Path| {
            let mut file = WholeFile::create(path)?;
            fill(&mut file)?;
            file.finish_lightly()
        };
        write(&path).map_err(|source| self.failed(&path, source))?;
        let mut unnamed = self.unnamed.lock().unwrap_or_else(PoisonError::into_inner);
        unnamed.insert(folder_of(&path).to_owned());
        Ok(())
    }

    /// Makes sure that the names of all files from [`OwnedFolder::write_lightly`] are on the disk.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn secure(&self) -> Result<(), OutputError> {
        self.check_identity()?;
        let mut unnamed = self.unnamed.lock().unwrap_or_else(PoisonError::into_inner);
        let mut folders = std::mem::take(&mut *unnamed);
        drop(unnamed);
        folders.insert(self.path().to_owned());
        folders.iter().try_for_each(|folder| {
            sync_folder(folder).map_err(|source| OutputError::failed(folder, source))
        })
    }

    /// Opens a file that grows, truncated after its first `length` bytes; a new file if `length` is 0.
    ///
    /// # Errors
    /// [`OutputError`], also for a file that is shorter.
    pub fn append(&self, name: &str, length: u64) -> Result<GrowingFile, OutputError> {
        let path = self.target(name)?;
        let open = |path: &Path| {
            if length == 0 {
                // A new file, also where the old one has another name elsewhere.
                remove_if_there(path)?;
                return File::create_new(path);
            }
            let mut file = File::options().write(true).open(path)?;
            let found = file.metadata()?;
            if found.len() < length {
                let reason = format!("it has {} bytes of at least {length}", found.len());
                return Err(io::Error::new(ErrorKind::UnexpectedEof, reason));
            }
            if has_another_name(&found) {
                let reason = "it has another name elsewhere, a hard link: make it a copy";
                return Err(io::Error::new(ErrorKind::PermissionDenied, reason));
            }
            file.set_len(length)?;
            file.seek(SeekFrom::End(0))?;
            Ok(file)
        };
        match open(&path) {
            Ok(file) => Ok(GrowingFile::new(path, length, file)),
            Err(source) => Err(OutputError::not_opened(&path, source)),
        }
    }

    /// Removes a file, if it exists.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn remove(&self, name: &str) -> Result<(), OutputError> {
        let path = self.inside(name)?;
        remove_if_there(&path).map_err(|source| OutputError::failed(&path, source))
    }

    /// The path of a file that may be written: in a folder that exists, and not an input of the run.
    fn target(&self, name: &str) -> Result<PathBuf, OutputError> {
        let path = self.inside(name)?;
        if let Some((folder, _)) = name.rsplit_once('/') {
            let folder = self.path().join(folder);
            fs::create_dir_all(&folder).map_err(|source| self.failed(&folder, source))?;
        }
        match Target::find(&path, &self.inputs)? {
            Target::File(path) => Ok(path),
            Target::StandardOutput | Target::Stream => Err(OutputError::Unsuitable {
                path,
                kind: "no file",
            }),
        }
    }

    /// The path of a file in the folder, to which no link leads.
    fn inside(&self, name: &str) -> Result<PathBuf, OutputError> {
        self.check_identity()?;
        let mut path = self.path().to_owned();
        let mut parts = Path::new(name).components().peekable();
        while let Some(part) = parts.next() {
            if !matches!(part, Component::Normal(_)) {
                let path = path.join(name);
                return Err(OutputError::NoName { path });
            }
            path.push(part);
            let found = match path.symlink_metadata() {
                Ok(found) => found,
                Err(error) if error.kind() == ErrorKind::NotFound => continue,
                Err(source) => return Err(OutputError::not_opened(&path, source)),
            };
            let is_expected = match parts.peek() {
                Some(_) => found.is_dir(),
                None => found.is_file(),
            };
            if !is_expected {
                return Err(OutputError::Foreign {
                    path: self.path().to_owned(),
                    names: vec![name.to_owned()],
                });
            }
        }
        Ok(path)
    }

    /// An error if the path names another folder than the one that was opened.
    pub(super) fn check_identity(&self) -> Result<(), OutputError> {
        match Identity::of(self.path()) == self.identity {
            true => Ok(()),
            false => Err(OutputError::Gone {
                path: self.path().to_owned(),
            }),
        }
    }
}

fn remove_if_there(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        removed => removed,
    }
}

#[cfg(unix)]
fn has_another_name(file: &fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    file.nlink() > 1
}

#[cfg(not(unix))]
fn has_another_name(_: &fs::Metadata) -> bool {
    false
}
