//! Input of Abaqus.

use super::{fixture, path, read, refusal, rows};
use sinew_mesh::MeshFormat::Abaqus;
use sinew_mesh::{GroupMembers, TetMesh};

/// Dimension, name and nodes of each group.
fn groups(mesh: &TetMesh) -> Vec<(u8, &str, Vec<u64>)> {
    let tags = |nodes: Vec<u32>| {
        nodes
            .iter()
            .map(|node| mesh.node_tags[*node as usize])
            .collect()
    };
    mesh.groups
        .iter()
        .map(|group| {
            (
                group.dim,
                group.name.as_str(),
                tags(mesh.group_nodes(group)),
            )
        })
        .collect()
}

#[test]
fn sets_and_surfaces_of_an_instance_become_groups() {
    let mesh = fixture("cae.inp");
    assert_eq!(
        crate::common::only_warning(&mesh),
        "line 34 (byte 744): nodes of the assembly, such as reference points, and sets of these are left out"
    );
    assert_eq!(
        mesh.skipped_sections,
        [
            "HEADING",
            "PREPRINT",
            "SOLID SECTION",
            "MATERIAL",
            "ELASTIC",
            "STEP",
            "BOUNDARY",
            "END STEP"
        ]
    );
    let cells = [
        ("tetra", vec![vec![0, 1, 2, 3], vec![1, 2, 3, 4]]),
        ("triangle", vec![vec![0, 2, 1]]),
        ("vertex", vec![vec![0], vec![1], vec![2], vec![3], vec![4]]),
    ];
    assert_eq!(rows(&mesh), cells);
    assert_eq!(mesh.cells[0].element_tags, [7, 9]);
    // Moved by the instance.
    assert_eq!(mesh.points[3], [0.0, 0.0, 3.0]);
    let expected: [(u8, &str, Vec<u64>); 4] = [
        (3, "Stiff part", vec![2, 3, 40, 50]),
        (2, "Floor", vec![1, 2, 3]),
        (0, "Set-all", vec![1, 2, 3, 40, 50]),
        (0, "Held", vec![1, 2, 3]),
    ];
    assert_eq!(groups(&mesh.to_tet_mesh().unwrap()), expected);
}

#[test]
fn sets_of_sets_lines_that_go_on_and_faces_are_read() {
    let mesh = fixture("flat.inp");
    assert_eq!(
        crate::common::only_warning(&mesh),
        "line 15 (byte 230): elements of type MASS are left out"
    );
    assert_eq!(mesh.points[1..3], [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let tissue = mesh.to_tet_mesh().unwrap();
    let expected: [(u8, &str, Vec<u64>); 8] = [
        (3, "FAT", vec![1, 2, 3, 4]),
        (3, "MUSCLE", vec![2, 3, 4, 5]),
        (3, "BOTH", vec![1, 2, 3, 4, 5]),
        (2, "SKIN", vec![1, 2, 3]),
        (2, "OUTER", vec![1, 2, 3, 4, 5]),
        (0, "ALL", vec![1, 2, 3, 4, 5]),
        (0, "TIP", vec![5]),
        (0, "SKIN_NODES", vec![1, 2, 3]),
    ];
    assert_eq!(groups(&tissue), expected);
    let outer = tissue.group_of_dim("OUTER", 2).unwrap();
    let GroupMembers::Triangles(triangles) = &outer.members else {
        panic!("it is of triangles");
    };
    // S2 of the first, S3 and S4 of the second tetrahedron, seen from outside.
    assert_eq!(*triangles, [[0, 1, 3], [2, 3, 4], [3, 1, 4]]);
    let outward = tissue.outward_triangles(triangles).unwrap();
    assert_eq!(
        outward, *triangles,
        "the tetrahedra are positively oriented"
    );
}

#[test]
fn several_bodies_and_what_makes_nodes_by_rules_are_refused() {
    let cae = std::fs::read_to_string(path("cae.inp")).unwrap();
    let again = "*End Instance\n*Instance, name=Liver-2, part=Liver\n*End Instance\n";
    let turned = "2.\n 0., 0., 0., 0., 0., 1., 90.\n*End Instance";
    for (from, to, end) in [
        (
            "*End Instance\n",
            again,
            "the assembly has 2 instances; a body is one part with one instance: in Abaqus/CAE, Merge/Cut Instances makes one of several",
        ),
        (
            "2.\n*End Instance",
            turned,
            "the instance is turned; give the part the orientation of the instance; a scene turns a mesh by rotate = { .. } in [mesh]",
        ),
        (
            "part=Liver\n",
            "part=Lung\n",
            "instance \"Liver-1\" is of part \"Lung\", which the file does not have; expected the name of a part",
        ),
        (
            "*Solid Section",
            "*Include, input=a.inp\n*Solid Section",
            "*INCLUDE makes a part of the mesh that the file does not list; write all nodes and elements into one file, as Abaqus/CAE and mesh generators do",
        ),
        (
            " 7, 1, 2, 3, 40",
            " 7, 1, 2, 3, 41",
            "*ELEMENT, element 7: it has node 41, which *NODE does not list; expected the label of a node",
        ),
        (
            " 7, 1, 2, 3, 40",
            " 7, 1, 2, 3",
            "*ELEMENT, element 7: it has 3 nodes; expected 4, since it is a tetra",
        ),
        (
            " 7, 1, 2, 3, 40",
            " 7, 1, 2, 3, 40, 50",
            "*ELEMENT, element 7: node 50 is one too many; expected 4 nodes, since it is a tetra",
        ),
        (
            " 9, 2",
            " 7, 2",
            "element 7 occurs again; expected each element once",
        ),
        (
            "C3D4",
            "C3D99",
            "the type of the elements is \"C3D99\"; tetrahedra (C3D4, C3D10), other solids, triangles and quadrilaterals (S3, CPS3, STRI3, S4 ..), trusses and beams (T3D2, B31) are read",
        ),
        (
            "_Floor_S1, S1",
            "_Ceiling_S1, S1",
            "surface \"Floor\": there is no set \"_Ceiling_S1\"; expected a label or the name of a set",
        ),
        (
            "1.,           0.,           0.\n      3",
            "1.,           0.x,           0.\n      3",
            "*NODE, node 2: the y coordinate is \"0.x\"; expected a number",
        ),
    ] {
        assert!(cae.contains(from), "{from}");
        let said = refusal(&cae.replacen(from, to, 1), Abaqus);
        assert!(said.ends_with(end), "{said}");
    }
    let said = refusal("8 1 0 0 0\n1 0 0 0\n", Abaqus);
    assert!(
        said.contains("the file looks like one of AVS UCD"),
        "{said}"
    );
}

#[test]
fn ranges_larger_than_any_mesh_take_no_time() {
    let text = std::fs::read_to_string(path("flat.inp")).unwrap();
    let range =
        "*NSET, NSET=RANGE, GENERATE\n1, 18446744073709551615, 2\n1, 18446744073709551615\n";
    let mesh = read(&format!("{text}{range}"), Abaqus)
        .to_tet_mesh()
        .unwrap();
    assert_eq!(
        mesh.group_nodes(mesh.group("RANGE").unwrap()),
        [0, 1, 2, 3, 4]
    );
}
