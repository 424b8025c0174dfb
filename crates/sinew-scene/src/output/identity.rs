//! The identity of files, which does not depend on how their paths are spelt.

use std::fs::{self, File, Metadata};
use std::path::{Path, PathBuf};

/// Device and inode of a file, which are the same for all links to it and all spellings of its path.
#[cfg(unix)]
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Identity(u64, u64);

/// The resolved path of a file, on systems without inodes to compare.
#[cfg(not(unix))]
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Identity(PathBuf);

impl Identity {
    /// Identity of the file at a path; `None` if absent.
    pub(super) fn of(path: &Path) -> Option<Self> {
        let metadata = fs::metadata(path).ok()?;
        Self::from_metadata(&metadata, path)
    }

    /// Identity of an open file or folder with this path.
    pub(super) fn of_open(file: &File, path: &Path) -> Option<Self> {
        Self::from_metadata(&file.metadata().ok()?, path)
    }

    #[cfg(unix)]
    fn from_metadata(metadata: &Metadata, _path: &Path) -> Option<Self> {
        use std::os::unix::fs::MetadataExt;
        Some(Self(metadata.dev(), metadata.ino()))
    }

    #[cfg(not(unix))]
    fn from_metadata(_metadata: &Metadata, path: &Path) -> Option<Self> {
        fs::canonicalize(path).ok().map(Self)
    }

    /// Identity of standard output, if it is a file or a pipe; `None` for a device, since an input
    /// may use the same one.
    #[cfg(unix)]
    pub(super) fn of_standard_output() -> Option<Self> {
        use std::os::unix::fs::FileTypeExt;
        let file = standard_output()?;
        if file.metadata().ok()?.file_type().is_char_device() {
            return None;
        }
        Self::of_open(&file, Path::new("-"))
    }

    #[cfg(not(unix))]
    pub(super) fn of_standard_output() -> Option<Self> {
        None
    }
}

#[cfg(unix)]
fn standard_output() -> Option<File> {
    use std::os::fd::AsFd;
    let descriptor = std::io::stdout().as_fd().try_clone_to_owned();
    descriptor.ok().map(File::from)
}

/// True if the system reports that standard output goes to a file.
#[cfg(unix)]
pub(super) fn standard_output_is_file() -> bool {
    let metadata = standard_output().and_then(|file| file.metadata().ok());
    metadata.is_some_and(|found| found.is_file())
}

#[cfg(not(unix))]
pub(super) fn standard_output_is_file() -> bool {
    false
}

/// A file that a run reads.
#[derive(Debug, Clone)]
pub(super) struct Input {
    pub(super) path: PathBuf,
    identity: Identity,
}

impl Input {
    /// The inputs at the paths that exist.
    pub(super) fn all(paths: &[PathBuf]) -> Vec<Self> {
        let input = |path: &PathBuf| {
            let identity = Identity::of(path)?;
            let path = path.clone();
            Some(Self { path, identity })
        };
        paths.iter().filter_map(input).collect()
    }

    /// The input that is this file, if one is.
    pub(super) fn same<'a>(inputs: &'a [Self], identity: &Identity) -> Option<&'a Self> {
        inputs.iter().find(|input| input.identity == *identity)
    }
}
