//! Small .msh files written by hand, and shorthands for the tests.

use sinew_mesh::{CellData, CellNodeData, Mesh, MeshError, PeriodicLink, PointData, read_msh};

pub(crate) mod damage;
pub(crate) mod encode;

/// Two tetrahedra in two regions that share the face 20 30 40; a surface group on one face; sparse, unordered tags; node
/// 7 is an orphan.
pub(crate) const TWO_REGIONS_41: &str = "\
$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
3
2 7 \"skin\"
3 7 \"fat\"
3 9 \"muscle\"
$EndPhysicalNames
$Entities
1 0 1 2
1 5 5 5 0
3 0 0 0 1 1 1 1 -7 0
4 0 0 0 1 1 1 1 7 1 3
5 0 0 0 1 1 1 2 7 9 1 -3
$EndEntities
$Nodes
3 6 7 50
3 4 0 4
40
10
30
20
0 0 1
0 0 0
0 1 0
1 0 0
3 5 0 1
50
1 1 1
0 1 0 1
7
5 5 5
$EndNodes
$Elements
3 3 1 100
2 3 2 1
1 10 30 20
3 4 4 1
100 10 20 30 40
3 5 4 1
12 20 30 40 50
$EndElements
";

/// One tetrahedron in version 2.2, written twice because it is in two groups, and a triangle.
pub(crate) const TWICE_22: &str = "\
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
2 1 \"base\"
3 1 \"tissue\"
3 2 \"stiff part\"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
$EndNodes
$Elements
3
1 2 2 1 5 1 3 2
2 4 2 1 6 1 2 3 4
3 4 2 2 6 1 2 3 4
$EndElements
";

/// Reads a file that must be valid.
pub(crate) fn read(text: &str) -> Mesh {
    read_msh(text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

/// A mesh with all features: data with gaps, links, groups, sparse tags.
pub(crate) fn full_mesh() -> Mesh {
    let mut mesh = read(TWO_REGIONS_41);
    let nan = f64::NAN;
    mesh.point_data = vec![
        PointData {
            name: "temperature".to_owned(),
            step: 2,
            time: 0.5,
            components: 1,
            values: vec![1.0, nan, -1e-300, 0.1, 5.0, nan],
        },
        PointData {
            name: "displacement, größer".to_owned(),
            step: 2,
            time: 0.5,
            components: 3,
            values: (0..18).map(f64::from).collect(),
        },
    ];
    mesh.cell_data = vec![CellData {
        name: "energy".to_owned(),
        step: -1,
        time: 1e-9,
        components: 1,
        blocks: vec![vec![nan], vec![2.5], vec![3.5]],
    }];
    mesh.cell_node_data = vec![CellNodeData {
        name: "stress".to_owned(),
        step: 0,
        time: 0.0,
        components: 2,
        blocks: vec![vec![nan; 6], (0..8).map(f64::from).collect(), vec![nan; 8]],
    }];
    mesh.periodic = vec![
        PeriodicLink {
            dim: 2,
            entity: 3,
            master: 4,
            affine: (0..16).map(f64::from).collect(),
            node_tags: vec![[10, 20], [30, 40]],
        },
        PeriodicLink {
            dim: 0,
            entity: 1,
            master: 2,
            affine: Vec::new(),
            node_tags: Vec::new(),
        },
    ];
    mesh
}

/// Reads a file that must be refused.
pub(crate) fn refusal(bytes: &[u8]) -> MeshError {
    match read_msh(bytes) {
        Err(error) => error,
        Ok(mesh) => panic!("accepted: {mesh:?}"),
    }
}

/// The file with one place changed; the place must occur exactly once.
pub(crate) fn with(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{from:?} must occur once");
    text.replace(from, to)
}

pub(crate) fn messages(mesh: &Mesh) -> Vec<String> {
    mesh.warnings.iter().map(ToString::to_string).collect()
}

/// The warning of a mesh that must have exactly one.
pub(crate) fn only_warning(mesh: &Mesh) -> String {
    let all = messages(mesh);
    assert_eq!(all.len(), 1, "{all:?}");
    all[0].clone()
}

/// Line and byte of the first occurrence, in the form of messages.
pub(crate) fn place(text: &str, part: &str) -> String {
    let byte = text.find(part).expect("the part occurs");
    let line = 1 + text[..byte].matches('\n').count();
    format!("line {line} (byte {byte})")
}
