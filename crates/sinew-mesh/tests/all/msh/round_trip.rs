//! Writing and reading back.

use crate::common::{TWICE_22, TWO_REGIONS_41, messages, read};
use proptest::prelude::*;
use sinew_mesh::structured::{Split, block, cube};
use sinew_mesh::{
    CellBlock, CellType, Group, GroupMembers, Mesh, PhysicalTags, TetMesh, read_msh,
    write_msh41_ascii,
};

fn written(mesh: &Mesh) -> String {
    let mut bytes = Vec::new();
    write_msh41_ascii(mesh, &mut bytes).unwrap_or_else(|error| panic!("{error}"));
    String::from_utf8(bytes).expect("the file is text")
}

fn refusal(mesh: &Mesh) -> String {
    write_msh41_ascii(mesh, &mut Vec::new())
        .expect_err("it cannot be written")
        .to_string()
}

fn one_tet() -> Mesh {
    let mut mesh = Mesh::default();
    mesh.points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    mesh.cells = vec![CellBlock::new(CellType::Tetra, vec![0, 1, 2, 3])];
    mesh
}

#[test]
fn structured_meshes_come_back_identical() {
    for split in [Split::Kuhn, Split::Mirrored] {
        let made = block([3, 2, 4], [0.1, 1.0 / 3.0, 7e-9], split).expect("valid");
        let mesh = read(&written(&made.to_mesh()));
        assert_eq!(messages(&mesh), [] as [&str; 0]);
        assert_eq!(mesh.to_tet_mesh().as_ref(), Ok(&made));
    }
}

#[test]
fn the_file_of_a_cube_is_this() {
    let mesh = cube(1, 0.1, Split::Kuhn).expect("valid").to_mesh();
    insta::assert_snapshot!(written(&mesh));
}

#[test]
fn meshes_read_from_files_come_back_identical() {
    let mesh = read(TWO_REGIONS_41);
    assert_eq!(read(&written(&mesh)), mesh);
}

#[test]
fn copies_in_different_groups_keep_them_under_new_entities() {
    let mesh = read(TWICE_22);
    let back = read(&written(&mesh));
    assert_eq!(back.to_tet_mesh(), mesh.to_tet_mesh());
    let physical: Vec<_> = back
        .cells
        .iter()
        .map(|b| b.physical.of(0).to_vec())
        .collect();
    assert_eq!(physical, [[1], [1], [2]]);
    let entities: Vec<_> = back.cells.iter().map(|b| b.geometrical[0]).collect();
    assert_eq!(entities, [5, 6, 1], "two groups cannot share entity 6");
}

#[test]
fn overlapping_groups_keep_their_members() {
    let mut mesh = cube(2, 1.0, Split::Kuhn).expect("valid");
    let group = |name: &str, dim, tag, members| Group {
        name: name.to_owned(),
        dim,
        tag,
        members,
    };
    let GroupMembers::Triangles(top) = mesh.groups[2].members.clone() else {
        panic!("the third group is the top")
    };
    let few = top[..3].to_vec();
    mesh.groups = vec![
        group("tissue", 3, 1, GroupMembers::Tets((0..48).collect())),
        group("stiff", 3, 2, GroupMembers::Tets(vec![47])),
        group("top", 2, 3, GroupMembers::Triangles(top.clone())),
        group("patch", 2, 4, GroupMembers::Triangles(few)),
        group("1:9", 1, 9, GroupMembers::Lines(vec![[0, 1], [1, 2]])),
        group("marker", 0, 5, GroupMembers::Nodes(vec![13, 4])),
    ];
    let file = written(&mesh.to_mesh());
    assert!(
        !file.contains("1:9"),
        "the name of an unnamed group is not written"
    );
    let back = read(&file).to_tet_mesh().expect("it has tets");
    assert_eq!(back.tets, mesh.tets);
    assert_eq!(back.tet_tags, mesh.tet_tags);
    for (read, made) in back.groups.iter().zip(&mesh.groups) {
        assert_eq!(
            (&read.name, read.dim, read.tag),
            (&made.name, made.dim, made.tag)
        );
        assert_eq!(read.members.len(), made.members.len(), "{}", made.name);
        assert_eq!(
            back.group_nodes(read),
            mesh.group_nodes(made),
            "{}",
            made.name
        );
    }
    assert_eq!(back.groups.len(), mesh.groups.len());
}

#[test]
fn missing_tags_are_counted_from_one() {
    let back = read(&written(&one_tet()));
    assert_eq!(back.node_tags, [1, 2, 3, 4]);
    assert_eq!(back.cells[0].element_tags, [1]);
    assert_eq!(back.cells[0].connectivity, [0, 1, 2, 3]);
}

#[test]
fn the_greatest_tags_leave_room_for_the_rest() {
    let mut mesh = cube(1, 1.0, Split::Kuhn).expect("valid");
    mesh.tet_tags = (0..6).map(|i| u64::MAX - i).collect();
    let back = read(&written(&mesh.to_mesh()));
    assert_eq!(messages(&back), [] as [&str; 0], "no tag occurs twice");
}

#[test]
fn second_order_cells_are_written_in_gmsh_order() {
    for &kind in CellType::ALL {
        let mut mesh = Mesh::default();
        let nodes = kind.node_count() as u32;
        mesh.points = (0..nodes).map(|i| [f64::from(i), 0.0, 0.0]).collect();
        mesh.cells = vec![CellBlock::new(kind, (0..nodes).rev().collect())];
        let back = read(&written(&mesh));
        assert_eq!(
            back.cells[0].connectivity, mesh.cells[0].connectivity,
            "{kind}"
        );
    }
    let mut mesh = Mesh::default();
    mesh.points = vec![[0.0; 3]; 10];
    mesh.cells = vec![CellBlock::new(CellType::Tetra10, (0..10).collect())];
    assert!(written(&mesh).contains("\n1 1 2 3 4 5 6 7 8 10 9\n"));
}

#[test]
fn contradictions_are_not_written() {
    let with = |change: &dyn Fn(&mut Mesh)| {
        let mut mesh = one_tet();
        change(&mut mesh);
        refusal(&mesh)
    };
    insta::assert_snapshot!(with(&|m| m.points[2][1] = f64::NAN), @"the node with tag 3 has coordinates [0.0, NaN, 0.0]; only finite numbers can be written");
    insta::assert_snapshot!(with(&|m| m.node_tags = vec![1, 2]), @"node_tags has 2 entries, but 4 are needed");
    insta::assert_snapshot!(with(&|m| m.cells[0].connectivity.push(0)), @"connectivity of block 0 has 5 entries, but 4 are needed");
    insta::assert_snapshot!(with(&|m| m.cells[0].connectivity[1] = 9), @"cell 0 of block 0 has node index 9, but there are 4 nodes");
    insta::assert_snapshot!(with(&|m| m.cells[0].physical = PhysicalTags::uniform(&[1], 3)), @"physical of block 0 has 3 entries, but 1 are needed");
    let name = "two\nlines".to_owned();
    insta::assert_snapshot!(with(&|m| { m.physical_names.insert((3, 1), name.clone()); }), @"the name of group 1 of dimension 3 has a line break");
}

#[test]
fn a_full_disk_is_an_error() {
    struct Full;
    impl std::io::Write for Full {
        fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
            Err(std::io::ErrorKind::StorageFull.into())
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    assert!(write_msh41_ascii(&one_tet(), &mut Full).is_err());
}

proptest! {
    /// Every finite coordinate reads back bit for bit.
    #[test]
    fn coordinates_are_exact(bits in proptest::collection::vec(any::<u64>(), 12)) {
        let numbers: Vec<f64> = bits.iter().map(|&b| f64::from_bits(b)).collect();
        prop_assume!(numbers.iter().all(|x| x.is_finite()));
        let points: Vec<[f64; 3]> = numbers.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
        let made = TetMesh::new(points, vec![[0, 1, 2, 3]]).expect("indices are in range");
        let back = read_msh(written(&made.to_mesh()).as_bytes()).expect("it was written");
        let back_bits: Vec<u64> = back.points.iter().flatten().map(|x| x.to_bits()).collect();
        prop_assert_eq!(back_bits, bits);
    }
}
