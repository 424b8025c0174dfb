//! The kind of a path's target, and permission to write it.

use std::fs::{self, File, FileType, Metadata};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::error::OutputError;
use super::identity::{Identity, Input};

/// Names of standard output.
const STANDARD_OUTPUT: [&str; 4] = ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"];

/// Names of this process's open files. The files behind them belong to the process that opened them, and are
/// written to, never replaced.
const DESCRIPTORS: [&str; 3] = ["/dev/fd", "/proc/self/fd", "/dev/stderr"];

/// Number of links that are followed before a path counts as a ring of links, as in Linux.
const MOST_LINKS: usize = 40;

/// The target of an output.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Target {
    /// Standard output.
    StandardOutput,
    /// A device, a pipe or an open file, written to directly.
    Stream,
    /// A file that exists or can be created, given by the path at the end of all links.
    File(PathBuf),
}

impl Target {
    /// Examines a path. Creates and changes nothing.
    pub(super) fn find(path: &Path, inputs: &[Input]) -> Result<Self, OutputError> {
        if STANDARD_OUTPUT.iter().any(|name| path == Path::new(name)) {
            if let Some(identity) = Identity::of_standard_output() {
                refuse_input(path, &identity, inputs)?;
            }
            return Ok(Self::StandardOutput);
        }
        match fs::metadata(path) {
            Ok(metadata) => Self::existing(path, &metadata, inputs),
            Err(error) if error.kind() == ErrorKind::NotFound => Self::new(path),
            Err(source) => Err(OutputError::NotOpened {
                path: path.to_owned(),
                source,
            }),
        }
    }

    fn existing(path: &Path, metadata: &Metadata, inputs: &[Input]) -> Result<Self, OutputError> {
        let here = || path.to_owned();
        let kind = metadata.file_type();
        if kind.is_dir() {
            return Err(OutputError::Folder { path: here() });
        }
        let identity = Identity::of(path);
        if let Some(identity) = &identity {
            refuse_input(path, identity, inputs)?;
        }
        let is_standard_output = identity.is_some() && identity == Identity::of_standard_output();
        if !kind.is_file() {
            return match unsuitable(&kind) {
                Some(kind) => Err(OutputError::Unsuitable { path: here(), kind }),
                None if is_standard_output => Ok(Self::StandardOutput),
                None => Ok(Self::Stream),
            };
        }
        if is_standard_output {
            return Ok(Self::StandardOutput);
        }
        if metadata.permissions().readonly() {
            return Err(OutputError::ReadOnly { path: here() });
        }
        // The mode says what some user may do; opening the file shows what we may do.
        if let Err(source) = File::options().append(true).open(path) {
            let path = here();
            return Err(OutputError::NotOpened { path, source });
        }
        if DESCRIPTORS.iter().any(|name| path.starts_with(name)) {
            return Ok(Self::Stream);
        }
        let target = resolved(path);
        // The link of an open file whose name was removed is a mere text, which may be the name of
        // another file.
        if Identity::of(&target) != identity {
            return Ok(Self::Stream);
        }
        Ok(Self::File(target))
    }

    fn new(path: &Path) -> Result<Self, OutputError> {
        let target = resolved(path);
        if names_folder(path) {
            let path = path.to_owned();
            return Err(OutputError::NoName { path });
        }
        if names_folder(&target) {
            let path = path.to_owned();
            return Err(OutputError::LinkToFolder { path, target });
        }
        let folder = folder_of(&target);
        if !folder.is_dir() {
            return Err(OutputError::NoFolder {
                path: path.to_owned(),
                folder: folder.to_owned(),
            });
        }
        Ok(Self::File(target))
    }

    /// True if both are the same file, which need not exist.
    pub(super) fn is_same_file(&self, other: &Self) -> bool {
        let (Self::File(one), Self::File(other)) = (self, other) else {
            return false;
        };
        let folder = |path| fs::canonicalize(folder_of(path)).ok();
        one.file_name() == other.file_name() && folder(one) == folder(other)
    }
}

/// True if a path can only name a folder, judged by its end.
fn names_folder(path: &Path) -> bool {
    let text = path.to_string_lossy();
    let before_dot = text.strip_suffix('.').unwrap_or(&text);
    path.file_name().is_none() || before_dot.ends_with(std::path::is_separator)
}

/// The folder of a file's path.
pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

fn refuse_input(path: &Path, identity: &Identity, inputs: &[Input]) -> Result<(), OutputError> {
    match Input::same(inputs, identity) {
        None => Ok(()),
        Some(input) => Err(OutputError::Input {
            path: path.to_owned(),
            input: input.path.clone(),
        }),
    }
}

/// The path at the end of all links, which need not exist.
fn resolved(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&path) {
            Ok(target) => path = folder_of(&path).join(target),
            Err(_) => break,
        }
    }
    path
}

/// Description of the kind of a target that accepts no stream.
#[cfg(unix)]
fn unsuitable(kind: &FileType) -> Option<&'static str> {
    use std::os::unix::fs::FileTypeExt;
    match kind {
        kind if kind.is_block_device() => Some("a block device"),
        kind if kind.is_socket() => Some("a socket"),
        _ => None,
    }
}

#[cfg(not(unix))]
fn unsuitable(_kind: &FileType) -> Option<&'static str> {
    None
}
