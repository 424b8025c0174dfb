//! The files of a run folder.

use std::io::{self, ErrorKind};
use std::path::{Component, Path};

/// The content of a file in a folder. A name that leads out of it, such as a link, is refused: lists of frames may come
/// from other programs.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_lead_out_of_the_folder_are_refused() {
        let place = tempfile::tempdir().expect("a folder");
        let folder = place.path().join("run");
        std::fs::create_dir_all(folder.join("fields")).expect("a folder");
        std::fs::write(place.path().join("secret"), "own").expect("a file");
        std::fs::write(folder.join("fields/a"), "frame").expect("a file");
        let read = |name: &str| read_within(&folder, name).map_err(|error| error.kind());
        assert_eq!(read("fields/a"), Ok(b"frame".to_vec()));
        assert_eq!(read("../secret"), Err(ErrorKind::InvalidInput));
        assert_eq!(read("fields/b"), Err(ErrorKind::NotFound));
        #[cfg(unix)]
        {
            let link = folder.join("link");
            std::os::unix::fs::symlink(place.path().join("secret"), link).expect("a link");
            assert_eq!(read("link"), Err(ErrorKind::InvalidInput));
        }
    }
}
