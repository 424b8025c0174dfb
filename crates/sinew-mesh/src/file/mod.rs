//! Reading by path. No other part of this crate opens files.

mod error;
mod other_formats;

pub use error::MeshFileError;

use std::fs;
use std::path::Path;

use crate::mesh::Mesh;
use crate::msh::read_msh;

/// Reads a .msh file, whatever its name; see [`read_msh`].
///
/// # Errors
///
/// If the path is not a readable file, or its contents are wrong; every message starts with the path, and goes on with the
/// line where there is one: `file.msh:57 (byte 2310): ...`.
pub fn read_msh_file(path: impl AsRef<Path>) -> Result<Mesh, MeshFileError> {
    let path = path.as_ref();
    let io_error = |error| MeshFileError::Io {
        path: path.to_owned(),
        error,
    };
    let kind = fs::metadata(path).map_err(io_error)?.file_type();
    if !kind.is_file() {
        // Opening a pipe would wait for its writer.
        return Err(MeshFileError::NotAFile {
            path: path.to_owned(),
            what: if kind.is_dir() {
                "a directory"
            } else {
                "a pipe, device or socket"
            },
        });
    }
    let bytes = fs::read(path).map_err(io_error)?;
    read_msh(&bytes).map_err(|error| MeshFileError::Contents {
        path: path.to_owned(),
        error: Box::new(error),
    })
}
