//! Reading by path. No other part of this crate opens files.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::error::MshError;
use super::other_formats;
use super::read_msh;
use crate::mesh::Mesh;

/// A .msh file cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MshFileError {
    /// The file does not exist or cannot be read.
    #[error("{}: cannot be read: {error}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's error.
        error: io::Error,
    },
    /// The path is a directory, pipe, device or socket.
    #[error("{}: is {what}; expected a file", path.display())]
    NotAFile {
        /// The path.
        path: PathBuf,
        /// The kind of thing that it is.
        what: &'static str,
    },
    /// The contents are wrong.
    #[error("{}", error.message_for(&path.display().to_string()))]
    Contents {
        /// The file.
        path: PathBuf,
        /// The problem and its place.
        error: Box<MshError>,
    },
}

impl MshFileError {
    /// Advice on what to do, if there is any: the command that converts a file whose name tells another format.
    #[must_use]
    pub fn advice(&self) -> Option<String> {
        match self {
            // What is no .msh file is refused at its first byte.
            MshFileError::Contents { path, error } if error.position().byte == 0 => {
                other_formats::advice(path)
            }
            _ => None,
        }
    }
}

/// Reads a .msh file; see [`read_msh`].
///
/// # Errors
///
/// If the path is not a readable file, or its contents are wrong; every message starts with the path, and goes on with the
/// line where there is one: `file.msh:57 (byte 2310): ...`.
pub fn read_msh_file(path: impl AsRef<Path>) -> Result<Mesh, MshFileError> {
    let path = path.as_ref();
    let io_error = |error| MshFileError::Io {
        path: path.to_owned(),
        error,
    };
    let kind = fs::metadata(path).map_err(io_error)?.file_type();
    if !kind.is_file() {
        // Opening a pipe would wait for its writer.
        return Err(MshFileError::NotAFile {
            path: path.to_owned(),
            what: if kind.is_dir() {
                "a directory"
            } else {
                "a pipe, device or socket"
            },
        });
    }
    let bytes = fs::read(path).map_err(io_error)?;
    read_msh(&bytes).map_err(|error| MshFileError::Contents {
        path: path.to_owned(),
        error: Box::new(error),
    })
}
