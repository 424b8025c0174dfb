//! Writes a grid.

use std::io::Write;

use super::error::WriteVtuError;
use super::grid::Grid;
use super::out::{Numbers, Out, VtuEncoding};
use crate::unstructured::vtk_cell_type;

/// Writes points, cells and data as .vtu. Equal grids give equal bytes.
///
/// # Errors
///
/// If VTK has no cells of a type, lengths disagree, a cell names a point that does not exist, or the destination fails.
pub fn write_vtu_grid(
    grid: &Grid<'_>,
    encoding: VtuEncoding,
    to: &mut impl Write,
) -> Result<(), WriteVtuError> {
    let types = checked_cell_types(grid)?;
    let connectivity: Vec<&[u32]> = grid.cells.iter().map(|&(_, nodes)| nodes).collect();
    let offsets = ends_of_cells(grid);
    let mut out = Out::new(to, encoding);
    let attributes = out.attributes();
    out.text(&format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\"{attributes}>\n<UnstructuredGrid>\n",
    ))?;
    let (points, cells) = (grid.points.len(), types.len());
    out.text(&format!(
        "<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n"
    ))?;
    for (section, arrays) in [
        ("PointData", &grid.point_data),
        ("CellData", &grid.cell_data),
    ] {
        out.text(&format!("<{section}>\n"))?;
        for array in arrays {
            let values = Numbers::from(&array.values);
            out.array(
                array.name,
                array.values.vtk_type(),
                array.components,
                values,
            )?;
        }
        out.text(&format!("</{section}>\n"))?;
    }
    out.text("<Points>\n")?;
    out.array(
        "Points",
        "Float64",
        3,
        Numbers::F64(grid.points.as_flattened()),
    )?;
    out.text("</Points>\n<Cells>\n")?;
    out.array("connectivity", "UInt32", 1, Numbers::U32(&connectivity))?;
    out.array("offsets", "Int64", 1, Numbers::I64(&offsets))?;
    out.array("types", "UInt8", 1, Numbers::U8(&types))?;
    out.text("</Cells>\n</Piece>\n</UnstructuredGrid>\n")?;
    out.finish()?;
    Ok(())
}

/// The number of entries of the list of nodes up to the end of each cell.
fn ends_of_cells(grid: &Grid<'_>) -> Vec<i64> {
    let mut end = 0;
    let blocks = grid.cells.iter().flat_map(|&(kind, nodes)| {
        let count = kind.node_count();
        (0..nodes.len() / count).map(move |_| count as i64)
    });
    let ends = blocks.map(|nodes| {
        end += nodes;
        end
    });
    ends.collect()
}

/// VTK's number for the type of each cell.
fn checked_cell_types(grid: &Grid<'_>) -> Result<Vec<u8>, WriteVtuError> {
    let mut types = Vec::new();
    for &(kind, nodes) in &grid.cells {
        let vtk = vtk_cell_type(kind).ok_or(WriteVtuError::UnsupportedCells { kind })?;
        let count = kind.node_count();
        check_length(
            &format!("the list of nodes of {kind} cells"),
            nodes.len(),
            nodes.len().div_ceil(count) * count,
        )?;
        let points = grid.points.len();
        if let Some(&node) = nodes.iter().find(|&&node| node as usize >= points) {
            let nodes = points;
            return Err(WriteVtuError::NodeOutOfRange { kind, node, nodes });
        }
        types.resize(types.len() + nodes.len() / count, vtk);
    }
    let holders = [
        (&grid.point_data, grid.points.len()),
        (&grid.cell_data, types.len()),
    ];
    for (arrays, holders) in holders {
        for array in arrays {
            let expected = holders * array.components;
            check_length(
                &format!("array {:?}", array.name),
                array.values.len(),
                expected,
            )?;
        }
    }
    Ok(types)
}

fn check_length(what: &str, found: usize, expected: usize) -> Result<(), WriteVtuError> {
    if found == expected {
        return Ok(());
    }
    Err(WriteVtuError::BadLength {
        what: what.to_owned(),
        found,
        expected,
    })
}

#[cfg(test)]
mod tests {
    use super::super::grid::Array;
    use super::*;
    use crate::cell_type::CellType;

    #[test]
    fn whole_numbers_are_written_as_such() {
        let mesh = crate::TetMesh::new(vec![[0.0; 3]; 5], vec![[0, 1, 2, 3], [1, 2, 3, 4]]);
        let mesh = mesh.expect("indices are in range");
        let grid = Grid {
            cell_data: vec![Array::of_integers("region", vec![1, -2])],
            ..Grid::of(&mesh)
        };
        let mut file = Vec::new();
        write_vtu_grid(&grid, VtuEncoding::Base64, &mut file).expect("memory takes all");
        let text = String::from_utf8_lossy(&file);
        assert!(
            text.contains("<Piece NumberOfPoints=\"5\" NumberOfCells=\"2\">"),
            "{text}"
        );
        // Python: base64.b64encode(struct.pack("<Qqq", 16, 1, -2))
        let expected = "<DataArray type=\"Int64\" Name=\"region\" NumberOfComponents=\"1\" format=\"binary\">\n\
                        EAAAAAAAAAABAAAAAAAAAP7/////////\n</DataArray>";
        assert!(text.contains(expected), "{text}");
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let points = [[0.0; 3]; 3];
        let with = |cells: Vec<(CellType, &[u32])>, values: &[f64]| {
            let grid = Grid {
                points: &points,
                cells,
                point_data: vec![Array::of_scalars("x", values)],
                cell_data: Vec::new(),
            };
            let error = write_vtu_grid(&grid, VtuEncoding::Base64, &mut Vec::new());
            error.expect_err("it does not fit").to_string()
        };
        fn triangle(nodes: &[u32]) -> Vec<(CellType, &[u32])> {
            vec![(CellType::Triangle, nodes)]
        }
        assert_eq!(
            with(triangle(&[0, 1, 3]), &[0.0; 3]),
            "a triangle has node index 3, but there are 3 nodes"
        );
        assert_eq!(
            with(triangle(&[0, 1]), &[0.0; 3]),
            "the list of nodes of triangle cells has 2 entries, but 3 are needed"
        );
        assert_eq!(
            with(triangle(&[0, 1, 2]), &[0.0; 4]),
            r#"array "x" has 4 entries, but 3 are needed"#
        );
        assert_eq!(
            with(vec![(CellType::Wedge18, &[])], &[0.0; 3]),
            "the mesh has wedge18 cells, which cannot be written as .vtu"
        );
    }
}
