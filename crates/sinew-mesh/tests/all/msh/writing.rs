//! Written meshes read back the same, in every version and encoding.

use crate::common::{TWICE_22, TWO_REGIONS_41, full_mesh, read};
use sinew_mesh::{
    CellBlock, CellNodeData, CellType, Entity, Mesh, MshEncoding, MshVersion, PhysicalTags,
    read_msh, write_msh,
};

const FORMATS: [(MshVersion, MshEncoding); 4] = [
    (MshVersion::V22, MshEncoding::Text),
    (MshVersion::V22, MshEncoding::Binary),
    (MshVersion::V41, MshEncoding::Text),
    (MshVersion::V41, MshEncoding::Binary),
];

fn written(mesh: &Mesh, (version, encoding): (MshVersion, MshEncoding)) -> Vec<u8> {
    let mut file = Vec::new();
    write_msh(mesh, version, encoding, &mut file).unwrap_or_else(|error| panic!("{error}"));
    file
}

fn read_back(mesh: &Mesh, format: (MshVersion, MshEncoding)) -> Mesh {
    read_msh(&written(mesh, format)).unwrap_or_else(|error| panic!("{format:?}: {error}"))
}

/// A mesh as text, since NaN is not equal to itself.
fn shown(mesh: &Mesh) -> String {
    let mut mesh = mesh.clone();
    mesh.warnings.clear();
    format!("{mesh:#?}")
}

#[test]
fn all_of_a_mesh_comes_back_from_4_1() {
    let mesh = full_mesh();
    for format in FORMATS.into_iter().filter(|f| f.0 == MshVersion::V41) {
        assert_eq!(shown(&read_back(&mesh, format)), shown(&mesh), "{format:?}");
    }
}

#[test]
fn all_that_2_2_can_hold_comes_back_from_it() {
    let mut mesh = full_mesh();
    // In 2.2 a cell has one group, nodes have no entities, and equal neighbours are one block.
    mesh.cells[2].physical = PhysicalTags::uniform(&[9], 1);
    mesh.cells[0].physical = PhysicalTags::uniform(&[7], 1);
    let mut expected = mesh.clone();
    expected.node_entities.clear();
    let last = expected.cells.remove(2);
    expected.cells[1].connectivity.extend(last.connectivity);
    expected.cells[1].element_tags.extend(last.element_tags);
    expected.cells[1].geometrical.extend(last.geometrical);
    expected.cells[1].physical.push(&[9]);
    for blocks in [
        &mut expected.cell_data[0].blocks,
        &mut expected.cell_node_data[0].blocks,
    ] {
        let last = blocks.remove(2);
        blocks[1].extend(last);
    }
    for format in FORMATS.into_iter().filter(|f| f.0 == MshVersion::V22) {
        let back = read_back(&mesh, format);
        let mut expected = expected.clone();
        expected.cells[1].physical = back.cells[1].physical.clone();
        assert_eq!(
            (back.cells[1].physical.of(0), back.cells[1].physical.of(1)),
            (&[7][..], &[9][..])
        );
        assert_eq!(shown(&back), shown(&expected), "{format:?}");
    }
}

#[test]
fn cells_in_several_groups_are_copied_in_2_2() {
    let mesh = read(TWO_REGIONS_41);
    for format in FORMATS {
        let back = read_back(&mesh, format);
        let (mut made, mut again) = (
            mesh.to_tet_mesh().expect("tets"),
            back.to_tet_mesh().expect("tets"),
        );
        made.notes.clear();
        again.notes.clear();
        assert_eq!(again, made, "{format:?}");
    }
}

#[test]
fn every_cell_type_comes_back() {
    for &kind in CellType::ALL {
        let mut mesh = Mesh::default();
        let nodes = kind.node_count() as u32;
        mesh.points = (0..=nodes)
            .map(|i| [f64::from(i), 0.0, 1.0 / 3.0])
            .collect();
        mesh.cells = vec![CellBlock::new(
            kind,
            (0..nodes).rev().chain(1..=nodes).collect(),
        )];
        let at_nodes = mesh.cells[0]
            .connectivity
            .iter()
            .map(|&node| f64::from(node))
            .collect();
        mesh.cell_node_data = vec![CellNodeData {
            name: "index".to_owned(),
            step: 0,
            time: 0.0,
            components: 1,
            blocks: vec![at_nodes],
        }];
        for format in FORMATS {
            let back = read_back(&mesh, format);
            assert_eq!(
                back.cells[0].connectivity, mesh.cells[0].connectivity,
                "{kind}"
            );
            assert_eq!(back.cell_node_data, mesh.cell_node_data, "{kind}");
        }
    }
}

#[test]
fn tags_that_do_not_fit_2_2_are_counted_anew() {
    let mut mesh = read(TWICE_22);
    mesh.node_tags = vec![u64::MAX, 2, 3, 4];
    mesh.cells[1].element_tags = vec![1 << 40, 3];
    for format in FORMATS {
        let back = read_back(&mesh, format);
        assert_eq!(back.points, mesh.points);
        let all: Vec<u32> = back
            .cells
            .iter()
            .flat_map(|b| b.connectivity.clone())
            .collect();
        let expected: Vec<u32> = mesh
            .cells
            .iter()
            .flat_map(|b| b.connectivity.clone())
            .collect();
        assert_eq!(all, expected);
        let is_counted = back.node_tags == [1, 2, 3, 4];
        assert_eq!(is_counted, format.0 == MshVersion::V22);
    }
}

#[test]
fn contradictory_data_are_not_written() {
    let refused = |change: &dyn Fn(&mut Mesh)| {
        let mut mesh = full_mesh();
        change(&mut mesh);
        let error = write_msh(&mesh, MshVersion::V41, MshEncoding::Binary, &mut Vec::new());
        error.expect_err("it cannot be written").to_string()
    };
    insta::assert_snapshot!(refused(&|m| { m.point_data[0].values.pop(); }), @r#"field "temperature" has 5 entries, but 6 are needed"#);
    insta::assert_snapshot!(refused(&|m| { m.cell_data[0].blocks.pop(); }), @r#"blocks of field "energy" has 2 entries, but 3 are needed"#);
    insta::assert_snapshot!(refused(&|m| m.point_data[1].name.push('"')), @r#"the name of data field "displacement, größer\"" has a line break or a double quote"#);
    insta::assert_snapshot!(refused(&|m| m.node_tags[1] = 40), @"node tag 40 occurs twice");
    insta::assert_snapshot!(refused(&|m| m.node_tags[1] = 0), @"node tag 0 is not the tag of a node");
    insta::assert_snapshot!(refused(&|m| m.node_tags[1] = 1 << 31), @"tag 2147483648 does not fit into the 31 bits that the format has for it there");
    let on_unused_entity = |m: &mut Mesh| m.node_entities[0] = Entity { dim: 3, tag: 99 };
    let mut mesh = full_mesh();
    on_unused_entity(&mut mesh);
    assert_eq!(read_back(&mesh, FORMATS[3]).node_entities[0].tag, 99);
}
