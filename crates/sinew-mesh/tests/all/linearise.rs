//! Cells of higher order reduced to their corners, on files of gmsh.

use crate::common::{messages, read};
use sinew_mesh::{CellBlock, CellNodeData, CellType, Mesh};

/// Two tetrahedra of second order and a triangle on one of them, all edges straight, in a group each; node 99 is in no cell.
const SECOND_ORDER: &str = "\
$MeshFormat\n2.2 0 8\n$EndMeshFormat
$Nodes\n15
1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1
12 0.5 0 0\n23 0.5 0.5 0\n13 0 0.5 0\n14 0 0 0.5\n34 0 0.5 0.5\n24 0.5 0 0.5
25 1 0.5 0.5\n35 0.5 1 0.5\n45 0.5 0.5 1\n99 7 7 7
$EndNodes
$Elements\n3
1 9 2 4 1 1 2 3 12 23 13
2 11 2 5 1 1 2 3 4 12 23 13 14 34 24
3 11 2 6 2 2 3 4 5 23 34 24 25 45 35
$EndElements
";

/// The same mesh reduced to its corners.
const FIRST_ORDER: &str = "\
$MeshFormat\n2.2 0 8\n$EndMeshFormat
$Nodes\n6
1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n99 7 7 7
$EndNodes
$Elements\n3
1 2 2 4 1 1 2 3
2 4 2 5 1 1 2 3 4
3 4 2 6 2 2 3 4 5
$EndElements
";

#[test]
fn corners_groups_and_tags_stay_and_nodes_between_go() {
    let mut mesh = read(SECOND_ORDER);
    let done = mesh.linearise();
    let cells: Vec<(CellType, usize)> = done.cells.into_iter().collect();
    assert_eq!(cells, [(CellType::Triangle6, 1), (CellType::Tetra10, 2)]);
    assert_eq!(done.dropped_nodes, 9);
    assert_eq!(done.farthest_from_straight, 0.0);
    assert_eq!(mesh, read(FIRST_ORDER));
    let tissue = mesh.to_tet_mesh().expect("it is linear now");
    assert_eq!(tissue.groups.len(), 3);
}

#[test]
fn a_mesh_of_linear_cells_stays_as_it_is() {
    let mut mesh = read(FIRST_ORDER);
    let before = mesh.clone();
    let done = mesh.linearise();
    assert_eq!((done.cells.len(), done.dropped_nodes), (0, 0));
    assert_eq!(mesh, before);
}

#[test]
fn a_node_that_is_a_corner_elsewhere_stays() {
    // A linear tetrahedron that hangs on the middle of an edge.
    let text = SECOND_ORDER
        .replace("$Elements\n3", "$Elements\n4")
        .replace("$EndElements", "4 4 2 6 2 12 3 4 5\n$EndElements");
    let mut mesh = read(&text);
    assert_eq!(mesh.linearise().dropped_nodes, 8);
    assert_eq!(messages(&mesh), [] as [&str; 0]);
    assert_eq!(mesh.node_tags, [1, 2, 3, 4, 5, 12, 99]);
}

#[test]
fn the_way_off_a_straight_edge_is_measured_at_every_edge_of_each_shape() {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    // The edges of VTK's file formats.
    let edges = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)];
    for (kind, edges) in [
        (CellType::Line3, &edges[..1]),
        (CellType::Triangle6, &edges[..3]),
        (CellType::Tetra10, &edges[..]),
    ] {
        for bent in 0..edges.len() {
            let mut mesh = Mesh::default();
            mesh.points = corners[..kind.linear().node_count()].to_vec();
            for (number, &(a, b)) in edges.iter().enumerate() {
                let mut middle = [0, 1, 2].map(|i| f64::midpoint(corners[a][i], corners[b][i]));
                middle[2] += if number == bent { 0.25 } else { 0.0 };
                mesh.points.push(middle);
            }
            mesh.cells = vec![CellBlock::new(
                kind,
                (0..kind.node_count() as u32).collect(),
            )];
            let done = mesh.linearise();
            assert_eq!(done.farthest_from_straight, 0.25, "{kind}, edge {bent}");
            assert_eq!(done.dropped_nodes, edges.len());
        }
    }
}

#[test]
fn values_at_the_nodes_of_cells_stay_at_the_corners() {
    let mut mesh: Mesh = read(SECOND_ORDER);
    let values = |nodes: usize, cells: usize| -> Vec<f64> {
        let entry = |i: u32| f64::from(i);
        (0..).map(entry).take(2 * nodes * cells).collect()
    };
    mesh.cell_node_data = vec![CellNodeData {
        name: "stress".to_owned(),
        step: 0,
        time: 0.0,
        components: 2,
        blocks: vec![values(6, 1), values(10, 2)],
    }];
    mesh.linearise();
    let first: Vec<f64> = (0..8).map(f64::from).collect();
    let second: Vec<f64> = (20..28).map(f64::from).collect();
    assert_eq!(
        mesh.cell_node_data[0].blocks,
        [first[..6].to_vec(), [first, second].concat()]
    );
}
