//! The findings of the mesh check, the changes of the repairs, and the summary of a mesh.

use crate::common::{TWICE_22, TWO_REGIONS_41, read};
use sinew_mesh::info::MeshInfo;
use sinew_mesh::structured::{Split, block, cube};
use sinew_mesh::{CellBlock, CellNodeData, CellType, Mesh, PhysicalTags, PointData};

fn cube_mesh() -> Mesh {
    cube(2, 0.1, Split::Mirrored).expect("valid").to_mesh()
}

fn tets(mesh: &mut Mesh) -> &mut CellBlock {
    mesh.cells.last_mut().expect("the tetrahedra come last")
}

#[test]
fn a_good_mesh_is_clean() {
    for split in [Split::Kuhn, Split::Mirrored] {
        let mesh = block([3, 2, 4], [0.3, 0.2, 0.4], split)
            .expect("valid")
            .to_mesh();
        let check = mesh.check();
        assert!(check.is_clean(), "{check}");
        assert_eq!(
            (check.tets, check.part_count, check.parts[0].cells),
            (144, 1, 144)
        );
        let edges = check.edges.expect("it has edges");
        assert!((edges.longest / edges.shortest - 3.0f64.sqrt()).abs() < 1e-12);
        let angle = check.least_dihedral.expect("it has tetrahedra").value;
        assert!((angle - 45.0).abs() < 1e-9, "{angle}");
    }
}

#[test]
fn bad_tetrahedra_are_named_by_their_tags() {
    let mut mesh = cube_mesh();
    let tags = tets(&mut mesh).element_tags.clone();
    let rows = &mut tets(&mut mesh).connectivity;
    for cell in 0..12 {
        rows.swap(4 * cell, 4 * cell + 1);
    }
    rows[4 * 20] = rows[4 * 20 + 1];
    // Four corners of one face of the cube lie in a plane.
    rows[4 * 21..4 * 22].copy_from_slice(&[0, 2, 6, 8]);
    let check = mesh.check();
    assert_eq!(check.inverted.total, 12);
    assert_eq!(check.inverted.first_tags, tags[..10]);
    assert_eq!(check.repeated_nodes.first_tags, [tags[20]]);
    assert_eq!(check.flat.first_tags, [tags[20], tags[21]]);
    assert!(!check.is_clean());
    let shown = check.to_string();
    assert!(
        shown.contains("! inverted tetrahedra: 12 (tags 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, ...)"),
        "{shown}"
    );
}

#[test]
fn slivers_have_their_angle_and_tag() {
    let h = 1e-4;
    let mut mesh = Mesh::default();
    mesh.points = vec![
        [0.1, 0.0, h],
        [0.0, 0.1, -h],
        [-0.1, 0.0, h],
        [0.0, -0.1, -h],
    ];
    mesh.cells = vec![CellBlock::new(CellType::Tetra, vec![0, 1, 2, 3])];
    mesh.cells[0].element_tags = vec![77];
    mesh.orient();
    let check = mesh.check();
    assert_eq!(check.slivers.first_tags, [77]);
    let least = check.least_dihedral.expect("there is one");
    assert!(least.value < 0.5 && least.element_tag == 77, "{least:?}");
}

#[test]
fn copies_orphans_parts_and_groups_are_found() {
    let mesh = read(TWICE_22);
    assert_eq!(mesh.check().duplicates.first_tags, [3]);

    let mut mesh = read(TWO_REGIONS_41);
    let check = mesh.check();
    assert_eq!(check.orphans.first_tags, [7]);
    assert_eq!((check.part_count, &check.unit), (1, &None));
    mesh.points.iter_mut().flatten().for_each(|x| *x *= 100.0);
    let unit = mesh.check().unit.expect("100 metres are no tissue");
    assert_eq!(
        unit,
        "the mesh is 100.0000 wide, more than tissue is in metres: probably millimetres, which `scale = 0.001` in the \
         scene's [mesh] turns into metres (`scale = 0.01` if they are centimetres)"
    );

    let mut mesh = cube_mesh();
    let shift = mesh.points.len() as u32;
    let copy: Vec<[f64; 3]> = mesh
        .points
        .iter()
        .map(|p| [p[0] + 1.0, p[1], p[2]])
        .collect();
    mesh.points.extend(copy);
    mesh.points.push([0.05; 3]);
    mesh.node_tags.clear();
    mesh.node_entities.clear();
    let rows = tets(&mut mesh).connectivity.clone();
    let second = CellBlock::new(
        CellType::Tetra,
        rows.iter().map(|node| node + shift).collect(),
    );
    mesh.cells.push(second);
    let outside = mesh.points.len() as u32 - 1;
    mesh.cells
        .push(CellBlock::new(CellType::Triangle, vec![0, 1, outside]));
    mesh.physical_names.insert((3, 50), "nothing".to_owned());
    let check = mesh.check();
    assert_eq!((check.part_count, check.parts.len()), (2, 2));
    let loose = "loose parts: 2, which share no node and need a support each";
    assert!(check.problems().iter().any(|problem| problem == loose));
    assert_eq!(check.outside_volume.first_tags, [u64::from(outside) + 1]);
    assert_eq!(check.empty_groups, [(3, 50, "nothing".to_owned())]);
}

#[test]
fn faces_of_three_tetrahedra_are_found() {
    let mut mesh = Mesh::default();
    mesh.points = vec![
        [0.0, 0.0, 0.0],
        [0.1, 0.0, 0.0],
        [0.0, 0.1, 0.0],
        [0.0, 0.0, 0.1],
        [0.0, 0.0, -0.1],
        [0.05, 0.05, 0.2],
    ];
    let rows = vec![0, 1, 2, 3, 0, 2, 1, 4, 0, 1, 2, 5];
    mesh.cells = vec![CellBlock::new(CellType::Tetra, rows)];
    let check = mesh.check();
    assert_eq!(check.non_manifold_faces, 1);
    assert_eq!(check.first_non_manifold[0].node_tags, [1, 2, 3]);
    assert_eq!(check.first_non_manifold[0].element_tags, [1, 2, 3]);
    // A copy of a tetrahedron is a duplicate, not a third one.
    mesh.cells[0].connectivity.truncate(8);
    mesh.cells[0].connectivity.extend([1, 2, 0, 3]);
    let check = mesh.check();
    assert_eq!((check.non_manifold_faces, check.duplicates.total), (0, 1));
}

#[test]
fn orient_turns_second_order_tetrahedra_with_their_values() {
    // Corner coordinates with mid-edge nodes in VTK's order.
    let corners = [
        [0.0, 0.0, 0.0],
        [0.2, 0.0, 0.0],
        [0.0, 0.2, 0.0],
        [0.0, 0.0, -0.2],
    ];
    let edges = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)];
    let mut mesh = Mesh::default();
    mesh.points = corners.to_vec();
    for (a, b) in edges {
        mesh.points
            .push([0, 1, 2].map(|i| f64::midpoint(corners[a][i], corners[b][i])));
    }
    mesh.cells = vec![CellBlock::new(CellType::Tetra10, (0..10).collect())];
    mesh.cell_node_data = vec![CellNodeData {
        name: "node".to_owned(),
        step: 0,
        time: 0.0,
        components: 2,
        blocks: vec![
            (0..10)
                .flat_map(|i| [f64::from(i), -f64::from(i)])
                .collect(),
        ],
    }];
    assert_eq!(
        (mesh.check().inverted.total, mesh.orient(), mesh.orient()),
        (1, 1, 0)
    );
    assert!(mesh.check().inverted.is_empty());
    let row = mesh.cells[0].connectivity.clone();
    for (i, (a, b)) in edges.into_iter().enumerate() {
        let point = |i: usize| mesh.points[row[i] as usize];
        for axis in 0..3 {
            assert_eq!(
                point(4 + i)[axis],
                f64::midpoint(point(a)[axis], point(b)[axis])
            );
        }
    }
    let values: Vec<f64> = row
        .iter()
        .flat_map(|&i| [f64::from(i), -f64::from(i)])
        .collect();
    assert_eq!(mesh.cell_node_data[0].blocks[0], values);
}

#[test]
fn drop_orphans_keeps_tags_values_and_links_in_step() {
    let mut mesh = read(TWO_REGIONS_41);
    mesh.points.insert(0, [9.0; 3]);
    mesh.node_tags.insert(0, 99);
    mesh.node_entities.insert(0, mesh.node_entities[0]);
    mesh.cells
        .iter_mut()
        .flat_map(|b| &mut b.connectivity)
        .for_each(|node| *node += 1);
    let tags = mesh.node_tags.clone();
    mesh.point_data = vec![PointData {
        name: "tag".to_owned(),
        step: 0,
        time: 0.0,
        components: 1,
        values: tags.iter().map(|&tag| tag as f64).collect(),
    }];
    let before = mesh.to_tet_mesh().expect("tets");
    assert_eq!(mesh.drop_orphans(), 2);
    assert_eq!(mesh.node_tags, [40, 10, 30, 20, 50]);
    assert_eq!(mesh.point_data[0].values, [40.0, 10.0, 30.0, 20.0, 50.0]);
    let mut after = mesh.to_tet_mesh().expect("tets");
    after.notes = before.notes.clone();
    assert_eq!(after, before);
    assert_eq!(mesh.drop_orphans(), 0);
}

#[test]
fn merge_duplicates_joins_their_groups() {
    let mut mesh = read(TWICE_22);
    let mut before = mesh.to_tet_mesh().expect("tets");
    before.notes.clear();
    assert_eq!(mesh.merge_duplicates(), 1);
    assert_eq!(mesh.cells[1].physical.of(0), [1, 2]);
    assert_eq!(mesh.cells[1].element_tags, [2]);
    let mut after = mesh.to_tet_mesh().expect("tets");
    after.notes.clear();
    assert_eq!(after, before);
    assert_eq!(mesh.merge_duplicates(), 0);

    // A block of nothing but copies goes, and with it its place in the data.
    let mut copy = mesh.cells[1].clone();
    copy.physical = PhysicalTags::uniform(&[-2, 8], 1);
    mesh.cells.push(copy);
    assert_eq!(mesh.merge_duplicates(), 1);
    assert_eq!(mesh.cells.len(), 2);
    assert_eq!(
        mesh.cells[1].physical.of(0),
        [1, 2, 8],
        "-2 is group 2, too"
    );
}

#[test]
fn coincident_nodes_are_no_finding() {
    let mut mesh = cube_mesh();
    let split = mesh.points.len() as u32;
    mesh.points.push(mesh.points[0]);
    mesh.node_tags.push(1000);
    mesh.node_entities.push(mesh.node_entities[0]);
    let first = tets(&mut mesh)
        .connectivity
        .iter()
        .position(|&node| node == 0)
        .expect("it is used");
    tets(&mut mesh).connectivity[first] = split;
    let check = mesh.check();
    assert!(check.is_clean(), "{check}");
}

#[test]
fn a_summary_is_json() {
    let mesh = read(TWO_REGIONS_41);
    let info = MeshInfo::of(&mesh);
    insta::assert_snapshot!(info.to_json(), @r#"{"num_points":6,"bbox":[[0.0,0.0,0.0],[5.0,5.0,5.0]],"cells":{"tetra":2,"triangle":1},"physical":[{"dim":2,"tag":7,"name":"skin","cells":{"triangle":1}},{"dim":3,"tag":7,"name":"fat","cells":{"tetra":2}},{"dim":3,"tag":9,"name":"muscle","cells":{"tetra":1}}],"tet_volume":0.5,"first_cells":[[1,2,3],[1,3,2,0],[3,2,0,4]],"points_not_in_3d_cells":1,"duplicate_3d_cells":0,"tets_inverted":0,"tets_degenerate":0,"data":[],"warnings":[]}"#);
    let info = MeshInfo::of(&read(TWICE_22));
    assert_eq!(info.duplicate_3d_cells, 1);
    assert_eq!(info.warnings.len(), 1);
    assert!(
        info.to_json()
            .contains("\"warnings\":[\"$Elements: tetra cells with")
    );
}

#[test]
fn parts_are_told_by_size_largest_first() {
    // Three tetrahedra in a row, of 1, 2 and 3 lengths, and a fourth that shares a corner with the last.
    let mut mesh = Mesh::default();
    for (x, length) in [(0.0, 1.0), (2.0, 2.0), (5.0, 3.0)] {
        let corner = [x, 0.0, 0.0];
        mesh.points.push(corner);
        for axis in 0..3 {
            let mut point = corner;
            point[axis] += length * f64::from(1 << axis) / 16.0;
            mesh.points.push(point);
        }
    }
    mesh.points
        .extend([[5.0, 0.0, -0.5], [5.0, 0.5, -0.5], [4.5, 0.0, -0.5]]);
    let rows = (0..12).chain([8, 13, 12, 14]).collect();
    mesh.cells = vec![CellBlock::new(CellType::Tetra, rows)];
    let check = mesh.check();
    assert_eq!(check.part_count, 3);
    let found: Vec<(usize, u64)> = check.parts.iter().map(|p| (p.cells, p.first_tag)).collect();
    assert_eq!(found, [(2, 3), (1, 1), (1, 2)]);
    assert_eq!(check.parts[0].size, [0.6875, 0.5, 1.25]);
    assert_eq!(check.parts[1].size, [0.0625, 0.125, 0.25]);
    assert!(check.to_string().contains(
        "  a part of 2 cells, 6.875e-1 x 5.000e-1 x 1.250e0 wide, the first with tag 3\n"
    ));
}

#[test]
fn a_mesh_without_tetrahedra_is_no_clean_one() {
    let mut mesh = cube_mesh();
    mesh.cells.retain(|block| block.kind.dim() == 2);
    let check = mesh.check();
    assert_eq!(check.tets, 0);
    assert!(!check.is_clean());
    assert_eq!(
        check.problems()[0],
        "no tetrahedra: there is nothing to simulate"
    );
}

#[test]
fn five_metres_are_the_limit_of_tissue() {
    let wide = |edge: f64| cube(1, edge, Split::Kuhn).expect("valid").to_mesh();
    assert_eq!(wide(4.99).check().unit, None);
    assert!(wide(5.01).check().unit.is_some());
}
