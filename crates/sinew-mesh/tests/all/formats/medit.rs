//! Medit's format.

use super::{cell_data, fixture, point_data, read, refusal, rows, without_byte};
use sinew_mesh::MeshFormat::Medit;

#[test]
fn references_become_groups_and_data() {
    let mesh = fixture("meshio.mesh");
    let cells = [
        ("tetra", vec![vec![0, 1, 2, 3], vec![1, 2, 3, 4]]),
        ("triangle", vec![vec![0, 2, 1]]),
    ];
    assert_eq!(rows(&mesh), cells);
    assert_eq!(
        cell_data(&mesh),
        [("medit:ref", vec![vec![1.0, 2.0], vec![7.0]])]
    );
    assert_eq!(
        point_data(&mesh),
        [("medit:ref", vec![1.0, 1.0, 2.0, 2.0, 3.0])]
    );
    let tissue = mesh.to_tet_mesh().unwrap();
    let groups: Vec<_> = tissue
        .groups
        .iter()
        .map(|group| (group.dim, group.name.as_str(), group.members.len()))
        .collect();
    assert_eq!(groups, [(3, "1", 1), (3, "2", 1), (2, "7", 1)]);
}

#[test]
fn keywords_without_cells_are_passed_over_and_named() {
    let mesh = read(
        "MeshVersionFormatted 2 # of mmg\nDimension\n3\nVertices 4\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\nCorners 1\n4\n\
         Tetrahedra\n1\n1 2 3 4 -5\nNormals 1\n1e0 0 0\nEnd\nleft",
        Medit,
    );
    assert_eq!(mesh.skipped_sections, ["Corners", "Normals"]);
    assert_eq!(mesh.physical_names.values().collect::<Vec<_>>(), ["-5"]);
    assert_eq!(mesh.warnings, []);
}

#[test]
fn damage_is_refused_with_its_place() {
    let file = "MeshVersionFormatted 1\nDimension 3\nVertices\n1\n0 0 0 0\nTetrahedra\n1\n1 1 1 1 0\nEnd\n";
    for (from, to, message) in [
        (
            "1 1 1 1 0",
            "1 1 1 2 0",
            "line 8: Tetrahedra, row 1: the vertex is 2; expected a vertex from 1 to 1",
        ),
        (
            "1 1 1 1 0",
            "1 1 1 0 0",
            "line 8: Tetrahedra, row 1: the vertex is 0; expected a vertex from 1 to 1",
        ),
        (
            "0 0 0 0",
            "0 nan 0 0",
            "line 5: Vertices, vertex 1: the y coordinate is \"nan\"; expected a finite number",
        ),
        (
            "Vertices\n1",
            "Vertices\n900000000000",
            "line 6: Vertices, vertex 2: the x coordinate is \"Tetrahedra\"; expected a number",
        ),
        (
            "Dimension 3",
            "Dimension 2",
            "line 2: Dimension: the mesh has 2 dimensions; a body is a mesh of tetrahedra in three dimensions",
        ),
        (
            "Tetrahedra",
            "TetrahedraP2",
            "line 6: TetrahedraP2: these cells are of second or higher order; write the mesh with cells of first order, whose nodes are corners",
        ),
        (
            "MeshVersionFormatted",
            "solid",
            "line 1: the file starts with \"solid\"; expected a .mesh file of Medit as text, starting with MeshVersionFormatted",
        ),
    ] {
        let said = refusal(&file.replacen(from, to, 1), Medit);
        assert_eq!(without_byte(&said), message);
    }
}
