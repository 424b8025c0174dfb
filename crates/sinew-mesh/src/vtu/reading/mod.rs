//! Reads `.vtu` files: XML with an unstructured grid, its numbers as text, as base64, or appended as bytes or base64, plain or
//! compressed by zlib, of either byte order.
//!
//! The tags are read first (`document`), up to the appended numbers, which are not XML; then the numbers of each array
//! (`array`, `encoding`), and the pieces are joined to one mesh.
//!
//! | case | what the reader does |
//! |---|---|
//! | several pieces | one after another; nodes that two pieces have stay two |
//! | data that only some pieces have | leaves them out, warns |
//! | arrays of texts or bits among the data | leaves them out, warns |
//! | whole numbers beyond 2^53 among the data | rounds them, warns |
//! | infinite values among the data | takes them as no value, warns |
//! | pixels and voxels | quadrilaterals and hexahedra |
//! | polygons, polyhedra and other cells without a type of ours | refuses |
//! | `gmsh:physical`, `group NAME` and the other arrays of `write_vtu` | tags and groups instead of data |
//! | numbers compressed by lz4 or lzma | refuses, with advice |

#![deny(
    clippy::indexing_slicing,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic
)]

mod array;
mod base64;
mod document;
mod encoding;
mod xml;

use crate::mesh::Mesh;
use crate::reading::MeshError;
use crate::reading::fault::{Fault, Lines};
use crate::reading::remarks::Remarks;
use crate::unstructured::{Cells, Field, GridBuilder};
use array::{Array, File};
use document::{Document, Piece};

/// Reads the bytes of a .vtu file.
///
/// Integer arrays keep their values as data of points and cells; [`Mesh::groups_from_data`] makes groups of labels.
/// Files of [`write_vtu`](super::write_vtu) give back their groups and tags.
///
/// # Errors
///
/// If the bytes are not such a file, or are inconsistent; the error names the place and the expected content.
///
/// ```
/// use sinew_mesh::structured::{Split, cube};
/// use sinew_mesh::vtu::{VtuEncoding, read_vtu, write_vtu};
///
/// let mesh = cube(2, 0.1, Split::Kuhn)?;
/// let mut file = Vec::new();
/// write_vtu(&mesh.to_mesh(), VtuEncoding::RawAppended, &mut file)?;
/// assert_eq!(read_vtu(&file)?.to_tet_mesh()?, mesh);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_vtu(bytes: &[u8]) -> Result<Mesh, MeshError> {
    let mut remarks = Remarks::default();
    match mesh_of(bytes, &mut remarks) {
        Ok(mesh) => Ok(Mesh {
            warnings: remarks.into_warnings(bytes),
            ..mesh
        }),
        Err(fault) => Err(fault.into_error(bytes, Lines::Count)),
    }
}

fn mesh_of(bytes: &[u8], remarks: &mut Remarks) -> Result<Mesh, Fault> {
    let document = Document::read(bytes)?;
    let file = document.file(bytes);
    let several = document.pieces.len() > 1;
    let mut grid = GridBuilder::default();
    for (number, piece) in (1..).zip(&document.pieces) {
        add(piece, &file, &mut grid, remarks).map_err(|fault| match several {
            true => fault.inside(format!("piece {number}")),
            false => fault,
        })?;
    }
    Ok(grid.finish(remarks))
}

fn add(
    piece: &Piece,
    file: &File<'_>,
    grid: &mut GridBuilder,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    let points = points(piece, file).map_err(|fault| fault.inside("Points"))?;
    let cells = cells(piece, file).map_err(|fault| fault.inside("Cells"))?;
    let mut fields = |arrays: &[Array], section, holders| {
        fields(arrays, holders, file, remarks).map_err(|fault: Fault| fault.inside(section))
    };
    let point_fields = fields(&piece.point_data, "PointData", points.len())?;
    let cell_fields = fields(&piece.cell_data, "CellData", cells.types.len())?;
    let added = grid.add(points, &cells, point_fields, cell_fields);
    added.map_err(|fault| fault.inside("Cells"))
}

fn points(piece: &Piece, file: &File<'_>) -> Result<Vec<[f64; 3]>, Fault> {
    let Some(array) = piece.points.first() else {
        return match piece.point_count {
            0 => Ok(Vec::new()),
            count => {
                let problem = format!("there is no array of coordinates for {count} points");
                Err(Fault::new(
                    piece.offset,
                    problem,
                    "a <DataArray> in <Points>",
                ))
            }
        };
    };
    let values = array.doubles(file)?;
    check_length(array, values.len(), piece.point_count, 3)?;
    if let Some(wrong) = values.iter().position(|x| !x.is_finite()) {
        let problem = "a coordinate is infinite or not a number";
        let fault = array.fault(problem, "finite coordinates");
        return Err(fault.in_record("point", wrong as u64 / 3 + 1, 0));
    }
    Ok(values.as_chunks().0.to_vec())
}

fn cells(piece: &Piece, file: &File<'_>) -> Result<Cells, Fault> {
    let numbers = |name: &str| match piece.cells.iter().find(|array| array.name == name) {
        Some(array) => Ok((array.offset, array.integers(file)?)),
        None if piece.cell_count == 0 => Ok((piece.offset, Vec::new())),
        None => {
            let problem = format!("there is no array \"{name}\"");
            let expected = "arrays \"connectivity\", \"offsets\" and \"types\"";
            Err(Fault::new(piece.offset, problem, expected))
        }
    };
    let (_, types) = numbers("types")?;
    let (offset, ends) = numbers("offsets")?;
    let (_, connectivity) = numbers("connectivity")?;
    if ends.len() != piece.cell_count {
        let problem = format!("there are {} offsets", ends.len());
        let expected = format!("{}, the NumberOfCells", piece.cell_count);
        return Err(Fault::new(offset, problem, expected));
    }
    Ok(Cells {
        connectivity,
        ends,
        // Numbers beyond 255 are no types either.
        types: types
            .into_iter()
            .map(|kind| u8::try_from(kind).unwrap_or(u8::MAX))
            .collect(),
        offset,
    })
}

fn fields(
    arrays: &[Array],
    holders: usize,
    file: &File<'_>,
    remarks: &mut Remarks,
) -> Result<Vec<Field>, Fault> {
    let mut fields = Vec::new();
    for array in arrays {
        let Some(scalar) = array.scalar() else {
            let message = format!(
                "data \"{}\": left out, since they are {} and no numbers",
                array.name,
                array.type_in_words()
            );
            remarks.at(array.offset, message);
            continue;
        };
        let values = array.doubles(file)?;
        check_length(array, values.len(), holders, array.components)?;
        fields.push(Field {
            name: array.name.clone(),
            components: array.components,
            is_integer: scalar.is_integer(),
            values,
        });
    }
    Ok(fields)
}

fn check_length(
    array: &Array,
    found: usize,
    holders: usize,
    components: usize,
) -> Result<(), Fault> {
    if holders.checked_mul(components) == Some(found) {
        return Ok(());
    }
    let problem = format!("it has {found} numbers");
    let expected = format!("{components} for each of {holders}");
    Err(array.fault(problem, expected))
}
