//! gmsh's .msh format: reading versions 1 and 2.0 to 4.1, writing 2.2 and 4.1, as text and as bytes.
//!
//! The reader walks over the bytes once. A cursor knows offsets, [`source`] turns bytes into numbers, `section` finds
//! sections, and one module for each section decodes its rows per format version into raw tables with the file's tags.
//! [`assemble`] then turns tags into indices, after all sections were read, in any order.
//!
//! The reader's choices in cases that the format leaves open:
//!
//! | case | what the reader does |
//! |---|---|
//! | no `$MeshFormat`, but `$NOD` (or `$NOE`) and `$ELM` | version 1; groups have no names |
//! | a section of later versions after `$NOD` or `$ELM` | refuses |
//! | version `2` or `2.0` | as 2.2; names of groups may lack the dimension, and get those of the cells with their tag |
//! | version `4` | 4.0 if the first line of `$Nodes` has two numbers, 4.1 if four; in binary files, what can be read |
//! | totals or tag ranges in a version 4 header disagree with the blocks | believes the blocks, warns |
//! | a node row occurs twice | the same coordinates, or apart by 1e-9 of the mesh's extent: warns, keeps the first; others: refuses |
//! | `$Nodes` or `$Elements` occurs again | rows seen before merge if identical, else refuses; new rows are added |
//! | an element tag occurs twice in one section | keeps both, warns |
//! | the same volume cell is written once per physical group | keeps all, warns with the count |
//! | an element repeats a node, is flat or inverted | accepts; such cells are a matter of geometry, not of format |
//! | a block on an entity that `$Entities` does not list | no physical group, warns |
//! | `$Elements` before `$Nodes` | accepts |
//! | the last `$End...` is missing | accepts with a warning if the last row ends with a line break, else refuses |
//! | a row of version 1 or 2 that ends, or begins, in the middle of a line and crosses a line break | refuses |
//! | `$MeshFormat` occurs again (gmsh appends data so) | accepts it if it is the same, else refuses |
//! | a data row for a tag that the mesh does not have | skips the row, warns |
//! | points or cells without a data row | NaN, warns |
//! | numbers spelled `np.float64(0.5)`, or with another name (meshio with NumPy 2) | reads the number; in data rows, warns |
//! | data for a small part of the mesh whose rest would take many times the file's size | refuses |
//! | data rows counting from 1 for elements counting from 0 (meshio's 4.0) | row 1 is for element 0, warns |
//! | no cell has a group, but there is a data field `gmsh:physical` (meshio's 4.0) | the field gives the groups, warns |
//! | tags of data rows in binary files | 4 bytes, or 8 if only that fits |
//! | links between nodes that `$Nodes` does not have | keeps them, warns |
//! | ghost elements | checks them, keeps none |
//! | wedge18 and pyramid14 | left in gmsh's node order, as meshio 5.3.5 leaves them |
//! | an unknown section | skips it, warns |
//! | Fortran exponents (`1D-3`), `nan`, `inf`, `1e999` | refuses |
//! | a name that is not UTF-8 | replaces the bad bytes, warns |
//! | a name with quotes inside | takes the text between the first and the last quote |
//! | a name with blanks before or behind it | leaves them out, so that groups match |
//! | a name that follows its tag without a blank (`3 1"liver"`) | reads both |
//! | a UTF-8 byte order mark | skips it |
//! | `$MeshFormat` and the version on one line (SOFA's files) | reads it |

#![deny(
    clippy::indexing_slicing,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic
)]

mod assemble;
mod assemble_data;
mod contents;
mod data;
mod elements;
mod entities;
mod framing;
mod header;
mod msh1;
mod nodes;
mod periodic;
mod physical_names;
mod places;
mod rows_of_lines;
mod section;
mod source;
mod tag_list;
mod write;

pub use write::{MshEncoding, MshVersion, WriteMshError, write_msh, write_msh41_ascii};

use crate::mesh::Mesh;
use crate::reading::MeshError;
use crate::reading::cursor::Cursor;
use crate::reading::fault::Fault;
use crate::reading::remarks::Remarks;
use header::Version;

/// Reads the bytes of a .msh file: version 1 as text, 2.0, 2.1, 2.2, 4.0 or 4.1 as text or as bytes of either order.
///
/// Points, cells, names and their order are the same as in meshio 5.3.5, if meshio reads a file correctly. In addition,
/// every cell has its groups in every version, data rows are assigned by their tags, and files that meshio refuses are
/// read.
///
/// [`Mesh::warnings`] lists what was tolerated.
///
/// # Errors
///
/// If the bytes are not such a file, or are inconsistent; the error names the place and the expected content.
///
/// ```
/// let file = b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n7 0 0 zero\n$EndNodes\n";
/// let error = sinew_mesh::read_msh(file).unwrap_err();
/// assert_eq!(
///     error.to_string(),
///     "line 6 (byte 50): $Nodes, node 1: the z coordinate is \"zero\"; expected a number"
/// );
/// ```
pub fn read_msh(bytes: &[u8]) -> Result<Mesh, MeshError> {
    let mut reading = Reading::of(bytes, Version::V40);
    if let Err(fault) = &reading.outcome
        && reading.remarks.version_is_open
    {
        // A bare 4 nearly always is 4.0. If it cannot be, it may be 4.1; what got further tells what is wrong.
        let as_41 = Reading::of(bytes, Version::V41);
        let is_further = |other: &Fault| other.offset() > fault.offset();
        if as_41.outcome.as_ref().err().is_none_or(is_further) {
            reading = as_41;
        }
    }
    reading.finish(bytes)
}

struct Reading {
    outcome: Result<Mesh, Fault>,
    remarks: Remarks,
}

impl Reading {
    fn of(bytes: &[u8], bare_four: Version) -> Reading {
        let mut remarks = Remarks::default();
        let outcome = header::refuse_other_formats(bytes)
            .and_then(|()| section::read_all(&mut Cursor::new(bytes), bare_four, &mut remarks))
            .and_then(|contents| assemble::mesh(contents, bytes, &mut remarks));
        Reading { outcome, remarks }
    }

    fn finish(self, bytes: &[u8]) -> Result<Mesh, MeshError> {
        let lines = self.remarks.lines();
        match self.outcome {
            Ok(mesh) => Ok(Mesh {
                warnings: self.remarks.into_warnings(bytes),
                ..mesh
            }),
            Err(fault) => Err(fault.into_error(bytes, lines)),
        }
    }
}
