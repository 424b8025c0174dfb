//! Errors of outputs.

use std::io;
use std::path::{Path, PathBuf};

/// Reasons why an output was refused or failed during writing. Every message names the path.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// A path without the name of a file.
    #[error("cannot write \"{}\": expected the name of a file", path.display())]
    NoName {
        /// The path.
        path: PathBuf,
    },
    /// A link to a name that only a folder can have.
    #[error("cannot write {}: it is a link to {}, which can only be a folder; name another file", path.display(), target.display())]
    LinkToFolder {
        /// The path.
        path: PathBuf,
        /// The path at the end of all links.
        target: PathBuf,
    },
    /// A folder, although a file is expected.
    #[error("cannot write {}: it is a folder; name a file in it", path.display())]
    Folder {
        /// The path.
        path: PathBuf,
    },
    /// A file in a folder that does not exist.
    #[error("cannot write {}: there is no folder {}; make it, or name another file", path.display(), folder.display())]
    NoFolder {
        /// The path.
        path: PathBuf,
        /// The folder that should contain it.
        folder: PathBuf,
    },
    /// A file or a device, although a folder is expected.
    #[error("cannot write into {}: it is not a folder; name a folder (it is created if absent)", path.display())]
    NotAFolder {
        /// The path.
        path: PathBuf,
    },
    /// A folder with other content than an earlier result of the same kind.
    #[error("cannot write into {}: it holds {}; name a new folder", path.display(), others(names))]
    Foreign {
        /// The path.
        path: PathBuf,
        /// Names of the other content.
        names: Vec<String>,
    },
    /// A folder with a file that this run reads.
    #[error("cannot write into {}: this run reads {} in it; name a new folder", path.display(), input.display())]
    InputWithin {
        /// The path.
        path: PathBuf,
        /// The input.
        input: PathBuf,
    },
    /// A folder that another process writes into.
    #[error("cannot write into {}: another run writes into it{}; name another folder", path.display(), process(*by))]
    Busy {
        /// The path.
        path: PathBuf,
        /// The process, if the system reports it.
        by: Option<u32>,
    },
    /// A folder within that of another result.
    #[error("cannot write into {}: it lies within {}, which holds another result; name a folder beside it", path.display(), holder.display())]
    Within {
        /// The path.
        path: PathBuf,
        /// The folder of the other result.
        holder: PathBuf,
    },
    /// A complete result that cannot be kept next to its folder: another file or folder has that name.
    #[error("cannot write into {}: its results would be kept as {} until new ones are complete, and that is there already; rename it, or name a new folder", path.display(), kept.display())]
    NoRoomAside {
        /// The path.
        path: PathBuf,
        /// The name under which the results would be kept.
        kept: PathBuf,
    },
    /// A complete result that the system cannot rename.
    #[error("cannot write into {}: its results cannot be kept as {} until new ones are complete: {source}; name a new folder", path.display(), kept.display())]
    NotSetAside {
        /// The path.
        path: PathBuf,
        /// The name under which the results would be kept.
        kept: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// The current folder, whose results cannot be set aside.
    #[error("cannot write into {}: it holds earlier results and is the current folder, which cannot be renamed; go to the folder above, or name a new folder", path.display())]
    CurrentFolder {
        /// The path.
        path: PathBuf,
    },
    /// A folder that was replaced during the run.
    #[error("writing into {} failed: the folder was removed or replaced by others while the run went on; run again", path.display())]
    Gone {
        /// The path.
        path: PathBuf,
    },
    /// A folder without an earlier result.
    #[error("there is no {kind} in {} to continue; name a folder that a run wrote with `--out`", path.display())]
    NoResult {
        /// The path.
        path: PathBuf,
        /// The kind of result.
        kind: &'static str,
    },
    /// A file that this run reads.
    #[error("cannot write {}: this run reads it{}; name another file", path.display(), as_input(path, input))]
    Input {
        /// The path.
        path: PathBuf,
        /// The input that is the same file.
        input: PathBuf,
    },
    /// A file that is also the destination of another output of the run.
    #[error("cannot write {}: it leads to the same file as {}, which this run writes too; remove the link", path.display(), other.display())]
    Shared {
        /// The path.
        path: PathBuf,
        /// The path of the other output.
        other: PathBuf,
    },
    /// A file without a write bit.
    #[error("cannot write {}: it is read-only; make it writable, or name another file", path.display())]
    ReadOnly {
        /// The path.
        path: PathBuf,
    },
    /// Something that is neither a file nor accepts a stream.
    #[error("cannot write {}: it is {kind}; expected a new name, a file, a pipe, a character device or - for standard output", path.display())]
    Unsuitable {
        /// The path.
        path: PathBuf,
        /// Description of its kind.
        kind: &'static str,
    },
    /// A path whose target was replaced during the run.
    #[error("cannot write {}: it was changed by others while the run went on; name another file and run again", path.display())]
    Changed {
        /// The path.
        path: PathBuf,
    },
    /// A path that the operating system cannot open for writing.
    #[error("cannot write {}: {source}; name another file", path.display())]
    NotOpened {
        /// The path.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A failure after writing had begun, for instance a full disk.
    #[error("writing {} failed: {source}", path.display())]
    Failed {
        /// The path.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
}

impl OutputError {
    /// True if the path was refused, so that another path may be accepted; otherwise writing failed.
    #[must_use]
    pub fn is_refusal(&self) -> bool {
        !matches!(self, Self::Failed { .. } | Self::Gone { .. })
    }

    pub(super) fn not_opened(path: &Path, source: io::Error) -> Self {
        let path = path.to_owned();
        Self::NotOpened { path, source }
    }

    pub(super) fn failed(path: &Path, source: io::Error) -> Self {
        let path = path.to_owned();
        Self::Failed { path, source }
    }
}

/// Description of the process.
fn process(id: Option<u32>) -> String {
    id.map_or_else(String::new, |id| format!(" (process {id})"))
}

/// Some of the names of other content.
fn others(names: &[String]) -> String {
    const SHOWN: usize = 3;
    let shown = names
        .iter()
        .take(SHOWN)
        .cloned()
        .collect::<Vec<_>>()
        .join(", ");
    match names.len().saturating_sub(SHOWN) {
        0 => format!("{shown}, which no run of this kind has written"),
        more => format!("{shown} and {more} more, which no run of this kind has written"),
    }
}

/// The path with which the run reads the file, if it differs from the refused one.
fn as_input(path: &PathBuf, input: &PathBuf) -> String {
    if path == input {
        String::new()
    } else {
        format!(" as {}", input.display())
    }
}
