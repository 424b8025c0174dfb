//! Reading by path. No other part of this crate opens files.

mod error;
mod format;
mod not_a_mesh;
mod other_formats;

pub use error::MeshFileError;
pub use format::MeshFormat;
pub use not_a_mesh::NotAMesh;
pub use other_formats::converted_extensions;

use std::fs;
use std::path::Path;

use crate::abaqus::read_abaqus;
use crate::medit::read_medit;
use crate::mesh::Mesh;
use crate::msh::read_msh;
use crate::reading::MeshError;
use crate::vtk::read_vtk;
use crate::vtu::read_vtu;

/// Reads the bytes of a mesh file of a format.
///
/// [`Mesh::warnings`] lists what was tolerated.
///
/// # Errors
///
/// If the bytes are not such a file, or are inconsistent; the error names the place and the expected content.
pub fn read_mesh(bytes: &[u8], format: MeshFormat) -> Result<Mesh, MeshError> {
    match format {
        MeshFormat::Msh => read_msh(bytes),
        MeshFormat::Vtu => read_vtu(bytes),
        MeshFormat::Vtk => read_vtk(bytes),
        MeshFormat::Medit => read_medit(bytes),
        MeshFormat::Abaqus => read_abaqus(bytes),
    }
}

/// Reads a mesh file in the format of its extension (see [`MeshFormat::of_path`]). Files of other names, and content
/// that begins with a section of gmsh, are read as .msh.
///
/// # Errors
///
/// If the path is not a readable file, or its contents are wrong; every message starts with the path, and continues
/// with the line if known: `file.msh:57 (byte 2310): ...`.
pub fn read_mesh_file(path: impl AsRef<Path>) -> Result<Mesh, MeshFileError> {
    let path = path.as_ref();
    read_mesh_of(path, &bytes_of(path)?)
}

/// Reads the bytes of a mesh file in the same way as [`read_mesh_file`], without opening it: its path determines the
/// format, and is named in messages.
///
/// # Errors
///
/// Same as [`read_mesh_file`], without errors of the file system.
pub fn read_mesh_of(path: impl AsRef<Path>, bytes: &[u8]) -> Result<Mesh, MeshFileError> {
    let path = path.as_ref();
    let is_of_gmsh = bytes.trim_ascii_start().starts_with(b"$");
    let kind = NotAMesh::of(path, bytes).filter(|_| !is_of_gmsh);
    if let Some(kind) = kind {
        return Err(MeshFileError::NotAMesh {
            path: path.to_owned(),
            kind,
        });
    }
    let format = MeshFormat::of_path(path).filter(|_| !is_of_gmsh);
    read_as(path, bytes, format.unwrap_or(MeshFormat::Msh))
}

/// Reads a .msh file of any name; see [`read_msh`].
///
/// # Errors
///
/// Same as [`read_mesh_file`].
pub fn read_msh_file(path: impl AsRef<Path>) -> Result<Mesh, MeshFileError> {
    let path = path.as_ref();
    read_as(path, &bytes_of(path)?, MeshFormat::Msh)
}

fn read_as(path: &Path, bytes: &[u8], format: MeshFormat) -> Result<Mesh, MeshFileError> {
    read_mesh(bytes, format).map_err(|error| MeshFileError::Contents {
        path: path.to_owned(),
        error: Box::new(error),
    })
}

fn bytes_of(path: &Path) -> Result<Vec<u8>, MeshFileError> {
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
    fs::read(path).map_err(io_error)
}
