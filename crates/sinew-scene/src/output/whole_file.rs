//! Files that are complete or absent.

use std::fs::{self, File, Metadata};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use super::target::folder_of;

/// A file under a temporary name in the same folder until [`WholeFile::finish`]: readers see the old
/// file or the new one, never a part. Dropped before that, it leaves nothing behind.
#[derive(Debug)]
pub(super) struct WholeFile {
    path: PathBuf,
    temporary: PathBuf,
    file: Option<BufWriter<File>>,
}

impl WholeFile {
    /// Starts a file that will be called `path`, with the mode of the file that it replaces.
    pub(super) fn create(path: &Path) -> io::Result<Self> {
        let (temporary, file) = temporary_in(folder_of(path))?;
        let started = Self {
            path: path.to_owned(),
            temporary,
            file: Some(BufWriter::new(file)),
        };
        if let (Ok(old), Some(file)) = (fs::metadata(path), &started.file) {
            keep_access(&old, file.get_ref());
        }
        Ok(started)
    }

    /// Completes the file and gives it its name, replacing one of that name. Afterwards the file is on the disk under
    /// that name.
    pub(super) fn finish(self) -> io::Result<()> {
        let folder = folder_of(&self.path).to_owned();
        self.complete()?;
        sync_folder(&folder)
    }

    /// Same as [`WholeFile::finish`], without waiting until the name is on the disk.
    pub(super) fn finish_lightly(self) -> io::Result<()> {
        self.complete()
    }

    fn complete(mut self) -> io::Result<()> {
        if let Some(file) = self.file.take() {
            let written = file.into_inner().map_err(io::IntoInnerError::into_error);
            let named = written
                .and_then(|file| file.sync_all())
                .and_then(|()| fs::rename(&self.temporary, &self.path));
            if named.is_err() {
                // The first error is reported; usually there is nothing left to remove.
                let _ = fs::remove_file(&self.temporary);
            }
            named?;
        }
        Ok(())
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
            // A failure cannot be reported here.
            let _ = fs::remove_file(&self.temporary);
        }
    }
}

/// Makes sure that the names in a folder are on the disk: otherwise a renamed file may have its former name after a
/// loss of power.
#[cfg(unix)]
pub(super) fn sync_folder(folder: &Path) -> io::Result<()> {
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        // Some file systems have nothing to do there, and some folders may be written but not listed.
        Err(error)
            if matches!(
                error.kind(),
                ErrorKind::InvalidInput | ErrorKind::PermissionDenied
            ) =>
        {
            Ok(())
        }
        synced => synced,
    }
}

/// Does nothing: on this system folders are not files, and the system keeps their names.
#[cfg(not(unix))]
pub(super) fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}

/// The process of a temporary file with this name in a folder (with `/` after its own folders).
fn process_of(name: &str) -> Option<u32> {
    let name = name.rsplit('/').next().unwrap_or(name);
    let numbers = name.strip_prefix(".sinew-")?.strip_suffix(".tmp")?;
    numbers.split_once('-')?.0.parse().ok()
}

/// True if a name is that of a temporary file: one left behind, or one that another process is about to rename or
/// remove.
pub(super) fn is_temporary(name: &str) -> bool {
    process_of(name).is_some()
}

/// True if a name is that of a temporary file whose process has ended.
pub(super) fn is_left_behind(name: &str) -> bool {
    let process = process_of(name);
    // Where the system lists no processes, none is taken to be gone.
    let lists = Path::new("/proc/self").exists();
    process.is_some_and(|process| {
        lists && process != std::process::id() && !Path::new(&format!("/proc/{process}")).exists()
    })
}

/// Removes temporary files of ended processes from a folder, as far as possible.
pub(super) fn remove_left_behind(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        let is_left = is_left_behind(&entry.file_name().to_string_lossy());
        let is_file = entry.file_type().is_ok_and(|found| found.is_file());
        // A process of another computer, which shares the folder, holds the lock.
        let is_free = || File::open(entry.path()).is_ok_and(|file| file.try_lock().is_ok());
        if is_left && is_file && is_free() {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Creates a file in the same folder, so that renaming never copies, under a name that no other writer
/// uses and that is short even if the final name is long.
fn temporary_in(folder: &Path) -> io::Result<(PathBuf, File)> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    loop {
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = folder.join(format!(".sinew-{}-{count}.tmp", std::process::id()));
        match File::create_new(&path) {
            // Left behind by a killed process with the same id.
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            created => {
                let file = created?;
                // Held as long as it is open, so that others see that it is written; where there are no locks the process's number tells it.
                let _ = file.try_lock();
                return Ok((path, file));
            }
        }
    }
}

/// Gives a file the owner and the mode of the file that it will replace, as far as permitted.
#[cfg(unix)]
fn keep_access(old: &Metadata, file: &File) {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    /// The bits for reading, writing and execution. Set-user-id, set-group-id and sticky bits must not pass to new
    /// content.
    const ACCESS: u32 = 0o777;
    let _ = fchown(file, Some(old.uid()), Some(old.gid()));
    let _ = file.set_permissions(fs::Permissions::from_mode(old.mode() & ACCESS));
}

#[cfg(not(unix))]
fn keep_access(old: &Metadata, file: &File) {
    let _ = file.set_permissions(old.permissions());
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
        fs::write(&path, b"old").unwrap();
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
        let mut file = WholeFile::create(&directory.path().join("a.txt")).unwrap();
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
        let file = WholeFile::create(&path).unwrap();
        assert!(file.finish().is_err());
        assert_eq!(names(directory.path()), ["taken"]);
        assert!(WholeFile::create(&directory.path().join("no").join("a")).is_err());
    }

    #[test]
    fn a_name_as_long_as_names_may_be_is_written() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("n".repeat(255));
        WholeFile::create(&path).unwrap().finish().unwrap();
        assert!(path.exists());
    }

    #[test]
    #[cfg(unix)]
    fn the_mode_of_the_old_file_stays() {
        use std::os::unix::fs::PermissionsExt;
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a.txt");
        fs::write(&path, b"old").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        WholeFile::create(&path).unwrap().finish().unwrap();
        let mode = fs::metadata(&path).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o640);
    }
}
