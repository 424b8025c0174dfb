//! Reasons why a mesh file cannot be read.

use std::io;
use std::path::PathBuf;

use super::not_a_mesh::NotAMesh;
use super::other_formats;
use crate::reading::MeshError;

/// A mesh file cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshFileError {
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
        /// The kind of the target.
        what: &'static str,
    },
    /// The file contains something other than a mesh of tetrahedra.
    #[error("{}: is {kind}; expected a mesh of tetrahedra, such as .msh, .vtu, .vtk, .mesh or .inp", path.display())]
    NotAMesh {
        /// The file.
        path: PathBuf,
        /// The kind of file.
        kind: NotAMesh,
    },
    /// The contents are wrong.
    #[error("{}", error.message_for(&path.display().to_string()))]
    Contents {
        /// The file.
        path: PathBuf,
        /// The problem and its place.
        error: Box<MeshError>,
    },
}

impl MeshFileError {
    /// Advice, if any: the conversion of a file of another kind or format to a supported one.
    #[must_use]
    pub fn advice(&self) -> Option<String> {
        match self {
            MeshFileError::NotAMesh { kind, .. } => Some(kind.advice()),
            // A file of another format is refused at its first byte.
            MeshFileError::Contents { path, error } if error.position().byte == 0 => {
                other_formats::advice(path)
            }
            _ => None,
        }
    }
}
