//! VTK's older format, `.vtk`: reads an unstructured grid of versions 1 to 5.1, as text or bytes.
//!
//! | case | what the reader does |
//! |---|---|
//! | cells as rows with their count (to 4.2), or as offsets and connectivity (from 5.0) | reads both, whatever the version |
//! | `FIELD` before the points | passes over it |
//! | `METADATA` | passes over it, up to an empty line |
//! | arrays of texts | passes over them, warns |
//! | `vtkIdType` and `int` as bytes | 4 bytes, as VTK writes them; `long` has 8 |
//! | names with `%20` | a blank in its place |
//! | `COLOR_SCALARS`, as which VTK writes labels of one byte | whole numbers from 0 to 255 |
//! | other grids (`POLYDATA`, `STRUCTURED_POINTS` ..) | refuses, with advice |
//! | cells, whole numbers and infinite values | as in .vtu files |

#![deny(
    clippy::indexing_slicing,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic
)]

mod attributes;
mod dataset;
mod header;
mod numbers;

use crate::mesh::Mesh;
use crate::reading::MeshError;
use crate::reading::cursor::Cursor;
use crate::reading::fault::Lines;
use crate::reading::remarks::Remarks;

/// Reads the bytes of a .vtk file with an unstructured grid.
///
/// Integer arrays keep their values as data of points and cells; [`Mesh::groups_from_data`] makes groups of labels.
///
/// # Errors
///
/// If the bytes are not such a file, or are inconsistent; the error names the place and the expected content.
pub fn read_vtk(bytes: &[u8]) -> Result<Mesh, MeshError> {
    let mut remarks = Remarks::default();
    let mut cursor = Cursor::new(bytes);
    let outcome = header::read(&mut cursor, &mut remarks)
        .and_then(|numbers| dataset::read(&mut cursor, numbers, &mut remarks))
        .and_then(|grid| grid.into_mesh(&mut remarks));
    match outcome {
        Ok(mesh) => {
            if remarks.lines() == Lines::Count {
                remarks.open_end(bytes);
            }
            Ok(Mesh {
                warnings: remarks.into_warnings(bytes),
                ..mesh
            })
        }
        Err(fault) => Err(fault.into_error(bytes, remarks.lines())),
    }
}
