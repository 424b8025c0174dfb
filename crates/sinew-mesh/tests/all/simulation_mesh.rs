//! Conversion of a file's mesh to that of a simulation: merging, dropping, groups.

use crate::common::{TWICE_22, TWO_REGIONS_41, read, with};
use sinew_mesh::{CellBlock, CellType, GroupMembers, Mesh, TetMesh};

fn tet_mesh(text: &str) -> TetMesh {
    read(text)
        .to_tet_mesh()
        .unwrap_or_else(|error| panic!("{error}"))
}

fn refusal(mesh: &Mesh) -> String {
    mesh.to_tet_mesh()
        .expect_err("it cannot be simulated")
        .to_string()
}

/// Name, dimension and tag of each group.
fn groups(mesh: &TetMesh) -> Vec<(&str, u8, i32)> {
    mesh.groups
        .iter()
        .map(|group| (group.name.as_str(), group.dim, group.tag))
        .collect()
}

#[test]
fn orphan_nodes_go_and_the_rest_closes_up() {
    let mesh = tet_mesh(TWO_REGIONS_41);
    assert_eq!(mesh.node_tags, [40, 10, 30, 20, 50]);
    assert_eq!(mesh.points.len(), 5);
    assert_eq!(mesh.tets, [[1, 3, 2, 0], [3, 2, 0, 4]]);
    assert_eq!(mesh.tet_tags, [100, 12]);
    assert_eq!(mesh.notes.len(), 1);
    insta::assert_snapshot!(mesh.notes[0], @"nodes in no tetrahedron, dropped because they would have no mass: 1 (first: tag 7)");
}

#[test]
fn an_orphan_before_used_nodes_shifts_their_indices() {
    let text = TWICE_22.replace("$Nodes\n4\n", "$Nodes\n5\n9 3 3 3\n");
    let mesh = tet_mesh(&text);
    assert_eq!(mesh.tets, [[0, 1, 2, 3]]);
    assert_eq!(mesh.node_tags, [1, 2, 3, 4]);
    assert_eq!(
        mesh.group("base").map(|g| &g.members),
        Ok(&GroupMembers::Triangles(vec![[0, 2, 1]]))
    );
}

#[test]
fn a_cell_in_two_groups_is_in_both_and_signs_do_not_matter() {
    let mesh = tet_mesh(TWO_REGIONS_41);
    assert_eq!(
        groups(&mesh),
        [("fat", 3, 7), ("muscle", 3, 9), ("skin", 2, 7)]
    );
    assert_eq!(
        mesh.group("fat").map(|g| &g.members),
        Ok(&GroupMembers::Tets(vec![0, 1]))
    );
    assert_eq!(
        mesh.group("muscle").map(|g| &g.members),
        Ok(&GroupMembers::Tets(vec![1]))
    );
    let skin = mesh.group("skin").expect("it is there");
    assert_eq!(skin.members, GroupMembers::Triangles(vec![[1, 2, 3]]));
}

#[test]
fn copies_of_a_tet_become_one_in_all_their_groups() {
    let mesh = tet_mesh(TWICE_22);
    assert_eq!(mesh.tets, [[0, 1, 2, 3]]);
    assert_eq!(mesh.tet_tags, [2]);
    assert_eq!(mesh.signed_volumes(), [1.0 / 6.0]);
    for name in ["tissue", "stiff part"] {
        let members = mesh.group(name).map(|group| &group.members);
        assert_eq!(members, Ok(&GroupMembers::Tets(vec![0])), "{name}");
    }
    insta::assert_snapshot!(mesh.notes.join("\n"), @"tetrahedra that repeat the nodes of another and were merged with it, keeping the groups of both: 1 (first: tag 3 repeats tag 2); gmsh writes such copies into version 2.2 files for elements in several groups");
}

#[test]
fn tets_after_a_merged_copy_keep_their_groups() {
    let text = TWICE_22
        .replace("$Nodes\n4\n", "$Nodes\n5\n5 1 1 1\n")
        .replace("$Elements\n3\n", "$Elements\n4\n")
        .replace("$EndElements", "4 4 2 2 6 5 2 3 4\n$EndElements");
    let mesh = tet_mesh(&text);
    assert_eq!(mesh.tet_tags, [2, 4]);
    assert_eq!(
        mesh.group("stiff part").map(|g| &g.members),
        Ok(&GroupMembers::Tets(vec![0, 1]))
    );
    assert_eq!(
        mesh.group("tissue").map(|g| &g.members),
        Ok(&GroupMembers::Tets(vec![0]))
    );
}

#[test]
fn groups_without_a_name_are_called_by_dimension_and_tag() {
    let text = with(TWO_REGIONS_41, "3\n2 7 \"skin\"\n", "2\n");
    assert_eq!(groups(&tet_mesh(&text))[2], ("2:7", 2, 7));
    let text = with(TWO_REGIONS_41, "\"skin\"", "\"\"");
    assert_eq!(groups(&tet_mesh(&text))[2], ("2:7", 2, 7));
}

#[test]
fn groups_of_one_dimension_with_one_name_are_joined() {
    let mesh = tet_mesh(&with(TWO_REGIONS_41, "\"muscle\"", "\"fat\""));
    assert_eq!(groups(&mesh), [("fat", 3, 7), ("skin", 2, 7)]);
    assert_eq!(
        mesh.group("fat").map(|g| &g.members),
        Ok(&GroupMembers::Tets(vec![0, 1]))
    );
    assert_eq!(
        mesh.notes[1],
        "groups 7 and 9 of dimension 3 are both named \"fat\" and were joined"
    );
}

#[test]
fn one_name_in_two_dimensions_stays_two_groups() {
    let mesh = tet_mesh(&with(TWO_REGIONS_41, "\"skin\"", "\"fat\""));
    assert_eq!(
        groups(&mesh),
        [("fat", 3, 7), ("muscle", 3, 9), ("fat", 2, 7)]
    );
    assert!(mesh.group("fat").is_err());
    assert_eq!(mesh.group("fat:3").map(|g| g.dim), Ok(3));
    assert_eq!(mesh.group_of_dim("fat", 2).map(|g| g.dim), Ok(2));
}

#[test]
fn repeated_and_dangling_members_are_dropped_with_a_note() {
    // The triangle again, turned, and once with the orphan node 7.
    let text = with(
        TWO_REGIONS_41,
        "2 3 2 1\n1 10 30 20\n",
        "2 3 2 3\n1 10 30 20\n2 20 30 10\n3 10 30 7\n",
    );
    let mesh = tet_mesh(&text);
    assert_eq!(mesh.group("skin").map(|g| g.members.len()), Ok(1));
    insta::assert_snapshot!(mesh.notes[1..].join("\n"), @r#"
    cells of group "skin" (dimension 2, tag 7) that use nodes in no tetrahedron, dropped: 1
    cells of group "skin" (dimension 2, tag 7) that repeat another, merged with it: 1
    "#);
}

#[test]
fn empty_groups_are_kept_and_noted() {
    let mesh = tet_mesh(&with(
        TWO_REGIONS_41,
        "3\n2 7 \"skin\"",
        "4\n1 2 \"wire\"\n2 7 \"skin\"",
    ));
    assert_eq!(
        mesh.group("wire").map(|g| &g.members),
        Ok(&GroupMembers::Lines(vec![]))
    );
    assert_eq!(
        mesh.notes[1],
        "group \"wire\" (dimension 1, tag 2) has no cells"
    );
}

#[test]
fn lines_and_vertices_make_groups_too() {
    let text = TWICE_22.replace(
        "$Elements\n3\n",
        "$Elements\n5\n11 15 2 4 1 3\n12 1 2 5 1 2 4\n",
    );
    let mesh = tet_mesh(&text);
    assert_eq!(
        mesh.group("0:4").map(|g| &g.members),
        Ok(&GroupMembers::Nodes(vec![2]))
    );
    assert_eq!(
        mesh.group("1:5").map(|g| &g.members),
        Ok(&GroupMembers::Lines(vec![[1, 3]]))
    );
}

#[test]
fn coincident_nodes_stay_apart() {
    let text = with(
        TWO_REGIONS_41,
        "1 1 1\n0 1 0 1\n7\n5 5 5\n",
        "0 0 1\n0 1 0 1\n7\n0 0 1\n",
    );
    let mesh = tet_mesh(&text);
    assert_eq!(mesh.points.len(), 5);
    assert_eq!(mesh.points[0], mesh.points[4]);
}

#[test]
fn inverted_tets_pass() {
    let mesh = tet_mesh(&with(TWO_REGIONS_41, "100 10 20 30 40", "100 20 10 30 40"));
    assert!(mesh.volume(0) < 0.0);
}

#[test]
fn meshes_that_cannot_be_simulated_say_why() {
    let without_tets = with(TWO_REGIONS_41, "3 3 1 100", "1 1 1 1");
    let without_tets = with(
        &without_tets,
        "3 4 4 1\n100 10 20 30 40\n3 5 4 1\n12 20 30 40 50\n",
        "",
    );
    insta::assert_snapshot!(refusal(&read(&without_tets)), @"the mesh has no tetrahedra (it has 1 triangle); a simulation needs 4-node tetrahedra");
    let pyramid = with(
        TWO_REGIONS_41,
        "3 5 4 1\n12 20 30 40 50\n",
        "3 5 7 1\n12 20 30 40 50 10\n",
    );
    insta::assert_snapshot!(refusal(&read(&pyramid)), @"the mesh has 1 pyramid cells (the first has tag 12); only 4-node tetrahedra, with 3-node triangles, 2-node lines and vertices as groups, can be simulated so far");
    let quad = with(
        TWO_REGIONS_41,
        "2 3 2 1\n1 10 30 20",
        "2 3 3 1\n1 10 30 20 40",
    );
    insta::assert_snapshot!(refusal(&read(&quad)), @"the mesh has 1 quad cells (the first has tag 1); only 4-node tetrahedra, with 3-node triangles, 2-node lines and vertices as groups, can be simulated so far");
    let ungrouped_quad = with(&quad, "1 -7 0", "0 0");
    assert_eq!(
        tet_mesh(&ungrouped_quad).tets.len(),
        2,
        "a quad in no group does no harm"
    );
    insta::assert_snapshot!(refusal(&Mesh::default()), @"the mesh has no tetrahedra (it has no cells); a simulation needs 4-node tetrahedra");
}

#[test]
fn a_hand_made_mesh_is_checked() {
    let mut mesh = Mesh::default();
    mesh.points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    mesh.cells = vec![CellBlock::new(CellType::Tetra, vec![0, 1, 2, 3])];
    let tets = mesh.to_tet_mesh().expect("tags may be left out");
    assert_eq!((tets.tet_tags, tets.node_tags), (vec![1], vec![1, 2, 3, 4]));
    mesh.cells[0].connectivity[3] = 4;
    insta::assert_snapshot!(refusal(&mesh), @"tetra with tag 1 has node index 4, but there are 4 nodes (0..=3)");
}

/// Two tetrahedra (1 and 2) and a triangle (3), with sections of data after them.
fn with_data(sections: &str) -> TetMesh {
    tet_mesh(&format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n$EndNodes\n\
         $Elements\n3\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 2 3 4 5\n3 2 2 2 2 1 2 3\n$EndElements\n{sections}"
    ))
}

/// A section of data at step 0.
fn section(name: &str, step: i32, components: usize, rows: &[&str]) -> String {
    format!(
        "$ElementData\n1\n\"{name}\"\n1\n0\n3\n{step}\n{components}\n{}\n{}\n$EndElementData\n",
        rows.len(),
        rows.join("\n")
    )
}

#[test]
fn data_of_tetrahedra_stay_by_name() {
    let surface = section("surface", 0, 1, &["3 7"]);
    let moduli = section("E", 0, 1, &["3 7", "2 20", "1 10"]);
    let along = section("along", 0, 3, &["1 1 0 0", "2 0 0 -2"]);
    let mesh = with_data(&(surface + &moduli + &along));
    let names: Vec<&str> = mesh.data.iter().map(|data| data.name.as_str()).collect();
    assert_eq!(names, ["E", "along"]);
    let values = |name: &str| mesh.data(name).expect("it is there").values.clone();
    assert_eq!(values("E"), [10.0, 20.0]);
    assert_eq!(values("along"), [1.0, 0.0, 0.0, 0.0, 0.0, -2.0]);
    let error = mesh.data("surface").expect_err("no tetrahedron has it");
    insta::assert_snapshot!(error, @r#"no data of tetrahedra are named "surface"; there are "E" (a number), "along" (3 numbers)"#);
}

/// Views written by gmsh begin with such schemes.
#[test]
fn schemes_of_interpolation_before_data_are_nothing_to_warn_of() {
    let text = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n\
         $Elements\n1\n1 4 0 1 2 3 4\n$EndElements\n$InterpolationScheme\n\"INTERPOLATION_SCHEME\"\n1\n5\n2\n1 1\n1\n1 3\n0 0 0\n\
         $EndInterpolationScheme\n{}",
        section("E", 0, 1, &["1 10"])
    );
    let mesh = read(&text);
    assert!(mesh.warnings.is_empty(), "{:?}", mesh.warnings);
    assert_eq!(mesh.cell_data.len(), 1);
}

#[test]
fn parts_of_data_are_put_together_and_steps_or_copies_are_told_apart() {
    let parts = section("E", 0, 1, &["1 10"]) + &section("E", 0, 1, &["2 20"]);
    let mesh = with_data(&parts);
    assert_eq!(
        mesh.data("E").map(|data| &data.values[..]),
        Ok(&[10.0, 20.0][..])
    );
    for step in [0, 4] {
        let again = parts.clone() + &section("E", step, 1, &["1 11", "2 21"]);
        let mesh = with_data(&again);
        let error = mesh.data("E").expect_err("there are two");
        let steps = format!("(time steps 0, {step})");
        assert!(error.to_string().contains(&steps), "{error}");
    }
}

/// gmsh writes version 2.2 with a copy of an element for each group, with its own tag.
#[test]
fn a_copy_gives_the_data_that_the_first_lacks() {
    let text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n\
                $Elements\n2\n1 4 2 1 1 1 2 3 4\n2 4 2 2 1 1 2 3 4\n$EndElements\n";
    let mesh = tet_mesh(&(text.to_owned() + &section("E", 0, 1, &["2 20"])));
    assert_eq!(mesh.data("E").map(|data| &data.values[..]), Ok(&[20.0][..]));
    let both = section("E", 0, 1, &["1 10", "2 20"]);
    let mesh = tet_mesh(&(text.to_owned() + &both));
    assert_eq!(mesh.data("E").map(|data| &data.values[..]), Ok(&[10.0][..]));
}

#[test]
fn data_follow_refinement_files_and_turns() {
    let moduli = section("E", 0, 1, &["2 20", "1 10"]);
    let along = section("along", 0, 3, &["1 1 0 0", "2 0 0 -2"]);
    let mesh = with_data(&(moduli + &along));
    let fine = mesh.refined().expect("it is small");
    let values = |mesh: &TetMesh, name: &str| mesh.data(name).expect("it is there").values.clone();
    let eight = |value: f64| [value; 8];
    assert_eq!(values(&fine, "E"), [eight(10.0), eight(20.0)].concat());
    assert_eq!(
        values(&fine, "along")[21..27],
        [1.0, 0.0, 0.0, 0.0, 0.0, -2.0]
    );
    let mut file = Vec::new();
    sinew_mesh::write_msh41_ascii(&fine.to_mesh(), &mut file).expect("memory takes it");
    let again = sinew_mesh::read_msh(&file).expect("it was written just now");
    assert_eq!(again.to_tet_mesh().expect("so it was").data, fine.data);
    let mut turned = mesh;
    turned.rotate([0.0, 1.0, 0.0], 90.0);
    assert_eq!(values(&turned, "along"), [0.0, 0.0, -1.0, -2.0, 0.0, 0.0]);
    assert_eq!(values(&turned, "E"), [10.0, 20.0]);
}

#[test]
fn data_follow_cells_that_a_file_stores_by_groups() {
    let mut mesh = sinew_mesh::structured::cube(1, 1.0, sinew_mesh::structured::Split::Kuhn)
        .expect("it is small");
    mesh.groups.clear();
    for tag in [1, 2] {
        let tets = (0..6).filter(|tet| tet % 2 == tag % 2).collect();
        mesh.groups.push(sinew_mesh::Group {
            name: format!("part {tag}"),
            dim: 3,
            tag: tag as i32,
            members: GroupMembers::Tets(tets),
        });
    }
    mesh.data.push(sinew_mesh::TetData {
        name: "tag".to_owned(),
        step: 0,
        components: 1,
        values: mesh.tet_tags.iter().map(|tag| *tag as f64).collect(),
    });
    let moved = mesh.to_mesh().to_tet_mesh().expect("it came from one");
    assert_ne!(moved.tet_tags, mesh.tet_tags);
    let tags = moved.tet_tags.iter().map(|tag| *tag as f64);
    assert_eq!(moved.data[0].values, tags.collect::<Vec<_>>());
}
