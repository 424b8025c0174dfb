//! Reading by path. No other part of this crate opens files.

mod error;
mod format;
mod other_formats;

pub use error::MeshFileError;
pub use format::MeshFormat;

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
/// If the bytes are no such file, or are inconsistent; the error names the place and what was expected there.
pub fn read_mesh(bytes: &[u8], format: MeshFormat) -> Result<Mesh, MeshError> {
    match format {
        MeshFormat::Msh => read_msh(bytes),
        MeshFormat::Vtu => read_vtu(bytes),
        MeshFormat::Vtk => read_vtk(bytes),
        MeshFormat::Medit => read_medit(bytes),
        MeshFormat::Abaqus => read_abaqus(bytes),
    }
}

/// Reads a mesh file of the format that its extension tells (see [`MeshFormat::of_path`]). Files of other names, and what begins with a
/// section of gmsh, are read as .msh.
///
/// # Errors
///
/// If the path is not a readable file, or its contents are wrong; every message starts with the path, and goes on with the
/// line where there is one: `file.msh:57 (byte 2310): ...`.
pub fn read_mesh_file(path: impl AsRef<Path>) -> Result<Mesh, MeshFileError> {
    let path = path.as_ref();
    read_file_as(path, |bytes| match MeshFormat::of_path(path) {
        Some(format) if !bytes.trim_ascii_start().starts_with(b"$") => format,
        _ => MeshFormat::Msh,
    })
}

/// Reads a .msh file, whatever its name; see [`read_msh`].
///
/// # Errors
///
/// As [`read_mesh_file`].
pub fn read_msh_file(path: impl AsRef<Path>) -> Result<Mesh, MeshFileError> {
    read_file_as(path.as_ref(), |_| MeshFormat::Msh)
}

fn read_file_as(path: &Path, format: impl Fn(&[u8]) -> MeshFormat) -> Result<Mesh, MeshFileError> {
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
    read_mesh(&bytes, format(&bytes)).map_err(|error| MeshFileError::Contents {
        path: path.to_owned(),
        error: Box::new(error),
    })
}
