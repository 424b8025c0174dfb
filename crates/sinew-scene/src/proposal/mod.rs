//! A first scene for a mesh, as a template for the user.

mod data;
mod file;
mod force;
mod parts;
mod quoted;
mod text;
mod unit;

use std::path::Path;

use sinew_mesh::{Mesh, TetMeshError};

use file::MeshFile;
use parts::Parts;
use unit::Unit;

/// Writes a commented scene for a mesh that runs as it is: a region for each volume group, a support and a load
/// proposed from the groups' names or otherwise from positions, a force that moves the body by some 2 % of its length,
/// and a unit guessed from the mesh's extent. Data with the name of a stiffness are proposed as Young's modulus.
///
/// `file` is the path of the mesh in the scene. Material and load are marked as placeholders. Of cells of higher order
/// only the corners are used.
///
/// # Errors
/// [`TetMeshError`] for a mesh that is not a body of tetrahedra.
pub fn propose(mut mesh: Mesh, file: &Path) -> Result<String, TetMeshError> {
    let is_linear = mesh.linearise().cells.is_empty();
    let mut mesh = mesh.to_tet_mesh()?;
    let unit = Unit::guessed(&mesh);
    mesh.scale(unit.metres);
    let parts = Parts::proposed(&mesh);
    let file = MeshFile {
        path: file,
        unit,
        is_linear,
    };
    Ok(text::scene(&mesh, &file, &parts))
}
