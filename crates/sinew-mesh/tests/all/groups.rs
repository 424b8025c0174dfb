//! Groups that are added to a mesh.

use sinew_mesh::structured::{Split, cube};
use sinew_mesh::{AddGroupError, GroupMembers, TetMesh, read_msh, write_msh41_ascii};

fn mesh() -> TetMesh {
    cube(2, 0.1, Split::Kuhn).expect("valid")
}

#[test]
fn an_added_group_is_found_and_survives_a_file() {
    let mut mesh = mesh();
    let boundary = mesh.boundary(None);
    mesh.add_group("skin", GroupMembers::Triangles(boundary))
        .expect("new");
    mesh.add_group("core", GroupMembers::Tets(vec![3, 1, 3]))
        .expect("new");
    mesh.add_group("axis", GroupMembers::Lines(vec![[0, 1], [1, 2], [1, 0]]))
        .expect("new");
    mesh.add_group("tip", GroupMembers::Nodes(vec![5, 2, 5]))
        .expect("new");
    // Tags 2, 3 and 4 of dimension 2, and 1 of dimension 3, are those of the cube's groups.
    let groups: Vec<(&str, u8, i32)> = mesh
        .groups
        .iter()
        .map(|g| (g.name.as_str(), g.dim, g.tag))
        .collect();
    assert_eq!(
        groups,
        [
            ("tissue", 3, 1),
            ("core", 3, 2),
            ("skin", 2, 1),
            ("sides", 2, 2),
            ("top", 2, 3),
            ("bottom", 2, 4),
            ("axis", 1, 1),
            ("tip", 0, 1)
        ]
    );
    let members = |name: &str| mesh.group(name).map(|group| group.members.clone());
    assert_eq!(members("core"), Ok(GroupMembers::Tets(vec![1, 3])));
    assert_eq!(
        members("axis"),
        Ok(GroupMembers::Lines(vec![[0, 1], [1, 2]]))
    );
    assert_eq!(members("tip"), Ok(GroupMembers::Nodes(vec![5, 2])));

    let mut file = Vec::new();
    write_msh41_ascii(&mesh.to_mesh(), &mut file).expect("it can be written");
    let read = read_msh(&file)
        .expect("valid")
        .to_tet_mesh()
        .expect("tetrahedra");
    let names = |mesh: &TetMesh| -> Vec<(String, u8, i32, usize)> {
        let groups = mesh.groups.iter();
        groups
            .map(|g| (g.name.clone(), g.dim, g.tag, g.members.len()))
            .collect()
    };
    assert_eq!(names(&read), names(&mesh));
}

#[test]
fn what_is_no_group_is_refused_and_changes_nothing() {
    let mut mesh = mesh();
    let before = mesh.clone();
    let name = || "new".to_owned();
    let (nodes, tets) = (27, 48);
    for (asked, members, error) in [
        (
            "",
            GroupMembers::Nodes(vec![0]),
            AddGroupError::BadName {
                name: String::new(),
            },
        ),
        (
            "a\nb",
            GroupMembers::Nodes(vec![0]),
            AddGroupError::BadName {
                name: "a\nb".to_owned(),
            },
        ),
        (
            "top",
            GroupMembers::Nodes(vec![0]),
            AddGroupError::Exists {
                name: "top".to_owned(),
                dim: 2,
            },
        ),
        (
            "new",
            GroupMembers::Lines(Vec::new()),
            AddGroupError::Empty { name: name() },
        ),
        (
            "new",
            GroupMembers::Tets(vec![47, 48]),
            AddGroupError::TetOutOfRange {
                name: name(),
                tet: 48,
                tets,
            },
        ),
        (
            "new",
            GroupMembers::Nodes(vec![26, 27]),
            AddGroupError::NodeOutOfRange {
                name: name(),
                node: 27,
                nodes,
            },
        ),
        (
            "new",
            GroupMembers::Triangles(vec![[0, 1, 2], [0, 1, 99]]),
            AddGroupError::NodeOutOfRange {
                name: name(),
                node: 99,
                nodes,
            },
        ),
        (
            "new",
            GroupMembers::Triangles(vec![[4, 1, 4]]),
            AddGroupError::RepeatedNode {
                name: name(),
                nodes: vec![4, 1, 4],
            },
        ),
        (
            "new",
            GroupMembers::Lines(vec![[3, 3]]),
            AddGroupError::RepeatedNode {
                name: name(),
                nodes: vec![3, 3],
            },
        ),
    ] {
        let refused = mesh.add_group(asked, members).expect_err("it is no group");
        assert_eq!(refused, error);
        assert_eq!(mesh, before);
    }
}

#[test]
fn a_refusal_says_what_is_there() {
    let mut mesh = mesh();
    let mut said = |name: &str, members| {
        let error = mesh.add_group(name, members);
        error.expect_err("it is no group").to_string()
    };
    assert_eq!(
        said("top", GroupMembers::Nodes(vec![0])),
        "a group of dimension 2 is named \"top\" already"
    );
    assert_eq!(
        said("grip", GroupMembers::Nodes(vec![27])),
        "group \"grip\" has node 27, but there are 27 nodes, counted from 0"
    );
}
