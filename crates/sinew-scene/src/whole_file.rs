//! Files that are there as a whole or not at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// A file under a temporary name beside its own until [`WholeFile::finish`]: readers see the old
/// file or the new one, never a part. Dropped before that, it leaves nothing behind.
#[derive(Debug)]
pub struct WholeFile {
    path: PathBuf,
    temporary: PathBuf,
    file: Option<BufWriter<File>>,
}

impl WholeFile {
    /// Starts a file that will be called `path`.
    ///
    /// # Errors
    /// When no file can be written there.
    pub fn create(path: impl Into<PathBuf>) -> io::Result<Self> {
        let path = path.into();
        let temporary = beside(&path)?;
        let file = BufWriter::new(File::create_new(&temporary)?);
        Ok(Self {
            path,
            temporary,
            file: Some(file),
        })
    }

    /// Writes a whole file at once.
    ///
    /// # Errors
    /// When it cannot be written or renamed; the old file is then as it was.
    pub fn write(path: impl Into<PathBuf>, content: &[u8]) -> io::Result<PathBuf> {
        let mut file = Self::create(path)?;
        file.write_all(content)?;
        file.finish()
    }

    /// Completes the file and gives it its name, replacing one of that name.
    ///
    /// # Errors
    /// When it cannot be completed or renamed; the old file is then as it was.
    pub fn finish(mut self) -> io::Result<PathBuf> {
        if let Some(file) = self.file.take() {
            let written = file.into_inner().map_err(io::IntoInnerError::into_error);
            let named = written
                .and_then(|file| file.sync_all())
                .and_then(|()| fs::rename(&self.temporary, &self.path));
            if named.is_err() {
                // The first error is the one to tell; most often there is nothing left to remove.
                let _ = fs::remove_file(&self.temporary);
            }
            named?;
        }
        Ok(self.path.clone())
    }
}

impl Write for WholeFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.file {
            Some(file) => file.write(bytes),
            None => Ok(bytes.len()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_mut().map_or(Ok(()), BufWriter::flush)
    }
}

impl Drop for WholeFile {
    fn drop(&mut self) {
        if self.file.take().is_some() {
            // Nobody can be told of a failure here.
            let _ = fs::remove_file(&self.temporary);
        }
    }
}

/// A name in the same directory, so that renaming never copies, that no other writer uses.
fn beside(path: &Path) -> io::Result<PathBuf> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let name = path.file_name().ok_or_else(|| {
        let message = format!("{} names no file", path.display());
        io::Error::new(io::ErrorKind::InvalidInput, message)
    })?;
    let name = name.to_string_lossy();
    Ok(path.with_file_name(format!(".{name}.{}-{count}.tmp", std::process::id())))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(directory: &Path) -> Vec<String> {
        let entries = fs::read_dir(directory).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_is_replaced_as_a_whole() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a.txt");
        WholeFile::write(&path, b"old").unwrap();
        let mut file = WholeFile::create(&path).unwrap();
        file.write_all(b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"old");
        file.finish().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(names(directory.path()), ["a.txt"]);
    }

    #[test]
    fn a_file_that_is_not_finished_leaves_nothing() {
        let directory = tempfile::tempdir().unwrap();
        let mut file = WholeFile::create(directory.path().join("a.txt")).unwrap();
        file.write_all(b"half").unwrap();
        assert_eq!(names(directory.path()).len(), 1);
        drop(file);
        assert_eq!(names(directory.path()), [] as [&str; 0]);
    }

    #[test]
    fn a_failure_leaves_what_was_there() {
        let directory = tempfile::tempdir().unwrap();
        // A directory cannot be replaced by a file.
        let path = directory.path().join("taken");
        fs::create_dir(&path).unwrap();
        assert!(WholeFile::write(&path, b"new").is_err());
        assert_eq!(names(directory.path()), ["taken"]);
        assert!(WholeFile::write(directory.path().join("no").join("a"), b"").is_err());
    }
}
