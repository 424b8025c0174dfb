//! VTK's older format.

use super::{cell_data, path, point_data, read, refusal, refused, rows, without_byte};
use sinew_mesh::MeshFormat::Vtk;

const HEAD: &str = "# vtk DataFile Version 2.0\nliver\nASCII\nDATASET UNSTRUCTURED_GRID\n";
const GRID: &str =
    "POINTS 4 float\n0 0 0 1 0 0\n0 1 0 0 0 0.1\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n";

#[test]
fn attributes_of_every_keyword_become_data() {
    let text = format!(
        "{HEAD}FIELD of_grid 1\nTIME 1 1 double\n0.5\n{GRID}CELL_DATA 1\nSCALARS labels int 1\nLOOKUP_TABLE default\n3\n\
         SCALARS pair float 2\nLOOKUP_TABLE own\n1 2\nLOOKUP_TABLE own 2\n0 0 0 1 1 1 1 1\nCOLOR_SCALARS bytes 1\n0.0117647\n\
         METADATA\nINFORMATION 0\n\nPOINT_DATA 4\nVECTORS u double\n1 2 3 4 5 6 7 8 9 10 11 12\nGLOBAL_IDS id vtkIdType\n7 8 9 10\n\
         FIELD more 2\na%20b 1 4 int\n1 2 3 4\nMETADATA\nINFORMATION 1\nNAME x LOCATION y\nDATA 1\n\nc 1 4 short\n5 6 7 8\n"
    );
    let mesh = read(&text, Vtk);
    assert_eq!(rows(&mesh), [("tetra", vec![vec![0, 1, 2, 3]])]);
    // Numbers of a type float are those of single precision.
    assert_eq!(mesh.points[3][2], f64::from(0.1f32));
    let expected = [
        ("labels", vec![vec![3.0]]),
        ("pair", vec![vec![1.0, 2.0]]),
        ("bytes", vec![vec![3.0]]),
    ];
    assert_eq!(cell_data(&mesh), expected);
    let expected = [
        ("u", (1..=12).map(f64::from).collect::<Vec<_>>()),
        ("id", vec![7.0, 8.0, 9.0, 10.0]),
        ("a b", vec![1.0, 2.0, 3.0, 4.0]),
        ("c", vec![5.0, 6.0, 7.0, 8.0]),
    ];
    assert_eq!(point_data(&mesh), expected);
}

#[test]
fn damage_is_refused_with_its_place() {
    let grid = format!("{HEAD}{GRID}");
    for (from, to, message) in [
        (
            "CELL_TYPES 1\n10\n",
            "",
            "line 1: the file has no CELL_TYPES; expected POINTS, CELLS and CELL_TYPES",
        ),
        (
            "4 0 1 2 3",
            "4 0 1 2 4",
            "line 8: CELLS, cell 1: it has point 4; expected a point from 0 to 3",
        ),
        (
            "4 0 1 2 3",
            "5 0 1 2 3",
            "line 8: CELLS, cell 1: its number of nodes is 5; expected a count up to 4, the numbers that are left",
        ),
        (
            "float",
            "flaot",
            "line 5: POINTS: the type of the numbers is \"flaot\"; expected a type such as int, vtktypeint64, float or double",
        ),
        (
            "UNSTRUCTURED_GRID",
            "POLYDATA",
            "line 4: DATASET: the grid is \"POLYDATA\"; a body is an UNSTRUCTURED_GRID of tetrahedra: in ParaView the filter Tetrahedralize makes one of a grid, and a mesh generator fills a surface",
        ),
        (
            "POINTS 4",
            "POINTS 99999999999",
            "POINTS, entry 13: a number is \"CELLS\"; expected a number",
        ),
        (
            "ASCII",
            "UTF-8",
            "line 3: the third line is \"UTF-8\"; expected ASCII or BINARY",
        ),
    ] {
        let said = refusal(&grid.replacen(from, to, 1), Vtk);
        assert!(without_byte(&said).ends_with(message), "{said}");
    }
    let bytes = std::fs::read(path("vtk-5.1-bytes.vtk")).unwrap();
    let said = refused(&bytes[..150], Vtk).to_string();
    assert!(
        said.starts_with("byte ") && said.contains("POINTS: the file ends after"),
        "{said}"
    );
}
