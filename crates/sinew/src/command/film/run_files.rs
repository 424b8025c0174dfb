//! The files of a run folder.

use std::io::{self, ErrorKind};
use std::path::{Component, Path};

/// The content of a file in a folder. A name that leads out of it, as by a link, is refused: lists of frames come from
/// others.
pub(super) fn read_within(folder: &Path, name: &str) -> io::Result<Vec<u8>> {
    let mut path = folder.to_owned();
    for part in Path::new(name).components() {
        path.push(part);
        let found = path.symlink_metadata()?;
        if !matches!(part, Component::Normal(_)) || found.is_symlink() {
            return Err(io::Error::new(
                ErrorKind::InvalidInput,
                "it leads out of the folder",
            ));
        }
    }
    std::fs::read(&path)
}
