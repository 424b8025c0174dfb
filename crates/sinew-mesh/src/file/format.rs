//! Formats of mesh files that this crate reads, identified by the extension of a file's name.

use std::path::Path;

/// A format of mesh files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MeshFormat {
    /// gmsh's `.msh`, versions 1 to 4.1.
    Msh,
    /// VTK's `.vtu`: XML with an unstructured grid.
    Vtu,
    /// VTK's older `.vtk`: an unstructured grid as text or bytes.
    Vtk,
    /// Medit's `.mesh` as text.
    Medit,
    /// Input of Abaqus, `.inp`.
    Abaqus,
}

impl MeshFormat {
    /// The format of a file by the extension of its name, upper or lower case.
    #[must_use]
    pub fn of_path(path: &Path) -> Option<MeshFormat> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        Some(match extension.as_str() {
            "msh" => MeshFormat::Msh,
            "vtu" => MeshFormat::Vtu,
            "vtk" => MeshFormat::Vtk,
            "mesh" => MeshFormat::Medit,
            "inp" => MeshFormat::Abaqus,
            _ => return None,
        })
    }
}
