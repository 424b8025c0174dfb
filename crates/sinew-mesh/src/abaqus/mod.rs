//! Input of Abaqus, `.inp`: the mesh of one part, with its sets and surfaces as groups.
//!
//! Lines are read first (`lines`), then keywords (`keywords`) into a part with the file's labels (`part`); then
//! labels become indices, and sets groups (`assemble`, `sets`).
//!
//! | case | what the reader does |
//! |---|---|
//! | a set of elements | a group of its name, in each dimension of its elements |
//! | a set of nodes, a surface of nodes | a group of nodes |
//! | a surface of faces S1 .. S4 of tetrahedra | a group of triangles, which are added |
//! | a surface of other elements or without faces | leaves it out, warns |
//! | sets with `INTERNAL`, which Abaqus/CAE makes for surfaces | serve the surfaces, and become no groups |
//! | names | of any case, as where they first occur |
//! | `*PART` and one `*INSTANCE` of it | the part, moved by the instance's translation |
//! | several instances, a turned instance, several parts without instance | refuses, with advice |
//! | nodes of the assembly, such as reference points, and sets of these | leaves them out, warns |
//! | `*INCLUDE`, `INPUT=`, `*NGEN`, `*ELGEN`, `*SYSTEM` and their like | refuses, with advice |
//! | tetrahedra of second order | reads them with all nodes, as from .msh files |
//! | elements without extent (masses, springs, connectors) | leaves them out, warns |
//! | elements of other types that are not known | refuses |
//! | other keywords (materials, steps ..) | passes over them; [`Mesh::skipped_sections`] names them |
//! | Fortran exponents (`1D-3`) | reads them |

#![deny(
    clippy::indexing_slicing,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic
)]

mod assemble;
mod elements;
mod instance;
mod keywords;
mod lines;
mod part;
mod sets;

use crate::mesh::Mesh;
use crate::reading::MeshError;
use crate::reading::fault::Lines;
use crate::reading::remarks::Remarks;

/// Reads the mesh of an input file of Abaqus.
///
/// # Errors
///
/// If the bytes are not such a file, are inconsistent, or describe more than the mesh of one part; the error names the
/// place and the expected content.
///
/// ```
/// let file = "*NODE
/// 1, 0, 0, 0
/// 2, 1, 0, 0
/// 3, 0, 1, 0
/// 4, 0, 0, 1
/// *ELEMENT, TYPE=C3D4, ELSET=liver
/// 1, 1, 2, 3, 4
/// *NSET, NSET=held
/// 1, 2
/// ";
/// let mesh = sinew_mesh::read_abaqus(file.as_bytes())?.to_tet_mesh()?;
/// assert_eq!(mesh.group("liver")?.members.len(), 1);
/// assert_eq!(mesh.group_nodes(mesh.group("held")?), [0, 1]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_abaqus(bytes: &[u8]) -> Result<Mesh, MeshError> {
    let mut remarks = Remarks::default();
    let outcome =
        keywords::read(bytes, &mut remarks).and_then(|model| assemble::mesh(&model, &mut remarks));
    match outcome {
        Ok(mesh) => {
            remarks.open_end(bytes);
            Ok(Mesh {
                warnings: remarks.into_warnings(bytes),
                ..mesh
            })
        }
        Err(fault) => Err(fault.into_error(bytes, Lines::Count)),
    }
}
