//! Features common to both VTK formats: cell types, pieces, numbers that are not values.

use super::{cell_data, read, refusal, rows};
use sinew_mesh::MeshFormat::Vtu;

/// A .vtu file as text of one piece for each list of types, nodes, ends and data of cells.
fn file(pieces: &[(&str, &str, &str, &str)]) -> String {
    let piece = |(types, nodes, ends, data): &(&str, &str, &str, &str)| {
        let cells = types.split_whitespace().count();
        format!(
            "<Piece NumberOfPoints=\"8\" NumberOfCells=\"{cells}\"><CellData>{data}</CellData>
<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">
0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1</DataArray></Points>
<Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">{nodes}</DataArray>
<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">{ends}</DataArray>
<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">{types}</DataArray></Cells></Piece>"
        )
    };
    let pieces: Vec<String> = pieces.iter().map(piece).collect();
    format!(
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>{}</UnstructuredGrid></VTKFile>",
        pieces.concat()
    )
}

fn labels(values: &str) -> String {
    format!("<DataArray type=\"Int32\" Name=\"labels\" format=\"ascii\">{values}</DataArray>")
}

#[test]
fn a_voxel_becomes_a_hexahedron() {
    let mesh = read(
        &file(&[("11 8", "0 1 2 3 4 5 6 7 0 1 2 3", "8 12", "")]),
        Vtu,
    );
    let cells = [
        ("hexahedron", vec![vec![0, 1, 3, 2, 4, 5, 7, 6]]),
        ("quad", vec![vec![0, 1, 3, 2]]),
    ];
    assert_eq!(rows(&mesh), cells);
}

#[test]
fn pieces_follow_one_another() {
    let (first, second) = (labels("4"), labels("5 6"));
    let young = "<DataArray type=\"Float64\" Name=\"young\" format=\"ascii\">1 2</DataArray>";
    let second = format!("{second}{young}");
    let mesh = read(
        &file(&[
            ("10", "0 1 2 4", "4", &first),
            ("10 10", "0 1 2 4 7 6 5 3", "4 8", &second),
        ]),
        Vtu,
    );
    assert_eq!(mesh.points.len(), 16);
    let cells = [(
        "tetra",
        vec![vec![0, 1, 2, 4], vec![8, 9, 10, 12], vec![15, 14, 13, 11]],
    )];
    assert_eq!(rows(&mesh), cells);
    assert_eq!(cell_data(&mesh), [("labels", vec![vec![4.0, 5.0, 6.0]])]);
    let said = crate::common::only_warning(&mesh);
    assert_eq!(
        said,
        "data \"young\": left out, since not all pieces of the grid have them"
    );
}

#[test]
fn what_is_no_value_is_told() {
    let data = "<DataArray type=\"Float64\" Name=\"a\" format=\"ascii\">inf</DataArray>
<DataArray type=\"UInt64\" Name=\"b\" format=\"ascii\">18446744073709551615</DataArray>
<DataArray type=\"String\" Name=\"c\" format=\"ascii\">1 2 3</DataArray>";
    let mesh = read(&file(&[("10", "0 1 2 4", "4", data)]), Vtu);
    assert!(mesh.cell_data[0].blocks[0][0].is_nan());
    assert_eq!(mesh.cell_data.len(), 2);
    let said = crate::common::messages(&mesh);
    assert_eq!(said.len(), 3, "{said:?}");
    assert!(
        said[0].ends_with("data \"c\": left out, since they are of type String and no numbers"),
        "{said:?}"
    );
    assert_eq!(
        said[1],
        "data \"a\": infinite numbers, taken as no value: 1"
    );
    assert_eq!(
        said[2],
        "data \"b\": whole numbers beyond 2^53, which are rounded"
    );
}

#[test]
fn cells_that_contradict_themselves_are_refused_by_number() {
    let said =
        |types: &str, nodes: &str, ends: &str| refusal(&file(&[(types, nodes, ends, "")]), Vtu);
    for (message, end) in [
        (
            said("10 10", "0 1 2 4 4 5 6 8", "4 8"),
            "Cells, cell 2: it has point 8; expected a point from 0 to 7",
        ),
        (
            said("10", "0 1 2 -4", "4"),
            "Cells, cell 1: it has point -4; expected a point from 0 to 7",
        ),
        (
            said("10", "0 1 2", "3"),
            "Cells, cell 1: it has 3 nodes; expected 4, since it is a tetra",
        ),
        (
            said("10 10", "0 1 2 3", "4 2"),
            "cell 2: its nodes are not in the list of nodes of all cells; expected an end from 4 to 4, the length of that list",
        ),
        (
            said("10", "0 1 2 3 4", "4"),
            "the list of nodes of all cells has 5 entries; expected 4, the end of the last cell",
        ),
        (
            said("7", "0 1 2", "3"),
            "cell 1: its type is 7 (a polygon); convert the grid to tetrahedra, in ParaView by the filter Tetrahedralize",
        ),
        (
            said("10 10", "0 1 2 3", "4"),
            "there are 1 offsets; expected 2, the NumberOfCells",
        ),
    ] {
        assert!(message.ends_with(end), "{message}");
    }
}
