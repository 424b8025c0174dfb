//! Mistakes in the file that `[mesh]` names.

use std::fs;

use sinew_scene::Scene;

use crate::message;
use crate::scenes::BODY;

/// The message about a scene whose mesh file has these contents or is missing; its folder is shown as
/// `<folder>`.
fn refusal(contents: Option<&str>) -> String {
    refusal_of(BODY, contents)
}

fn refusal_of(scene: &str, contents: Option<&str>) -> String {
    let folder = tempfile::tempdir().unwrap();
    if let Some(contents) = contents {
        fs::write(folder.path().join("body.msh"), contents).unwrap();
    }
    let cube = "cube = { cells = 2, edge = 0.2 }";
    assert_eq!(scene.matches(cube).count(), 1);
    let path = folder.path().join("scene.toml");
    fs::write(&path, scene.replace(cube, "file = \"body.msh\"")).unwrap();
    let error = Scene::load(path).unwrap().build().unwrap_err();
    message(&error).replace(&folder.path().display().to_string(), "<folder>")
}

const ONE_TRIANGLE: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n$Elements\n1\n1 2 2 1 1 1 2 3\n$EndElements\n";

const INVERTED: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 -1\n$EndNodes\n$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n";

#[test]
fn no_such_file() {
    insta::assert_snapshot!(
        refusal(None),
        @"<folder>/scene.toml:3: [mesh]: <folder>/body.msh: cannot be read: No such file or directory (os error 2)"
    );
}

#[test]
fn not_a_mesh() {
    insta::assert_snapshot!(
        refusal(Some("solid cube\n")),
        @r#"<folder>/scene.toml:3: [mesh]: <folder>/body.msh:1 (byte 0): the file starts with "solid cube\n"; expected a gmsh .msh file, starting with $MeshFormat or, in version 1, $NOD"#
    );
}

#[test]
fn a_node_that_is_no_number() {
    insta::assert_snapshot!(
        refusal(Some(&ONE_TRIANGLE.replace("2 1 0 0", "2 one 0 0"))),
        @r#"<folder>/scene.toml:3: [mesh]: <folder>/body.msh:7 (byte 54): $Nodes, node 2: the x coordinate is "one"; expected a number"#
    );
}

#[test]
fn no_tetrahedra() {
    insta::assert_snapshot!(
        refusal(Some(ONE_TRIANGLE)),
        @"<folder>/scene.toml:3: [mesh]: the mesh has no tetrahedra (it has 1 triangle); a simulation needs 4-node tetrahedra"
    );
}

#[test]
fn an_inverted_tetrahedron() {
    insta::assert_snapshot!(
        refusal(Some(INVERTED)),
        @"<folder>/scene.toml:3: [mesh]: tetrahedron 1 is inverted (volume -1.667e-1 m3); 1 in all; swap two of their nodes or repair the mesh"
    );
}

const TWO_UNNAMED_GROUPS: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n$EndNodes\n$Elements\n2\n1 4 2 1 1 1 2 3 4\n2 4 2 2 2 2 3 4 5\n$EndElements\n";

#[test]
fn tetrahedra_without_a_material() {
    let region = "density = 1060.0";
    let scene = BODY.replace(region, &format!("group = \"3:1\"\n{region}"));
    insta::assert_snapshot!(refusal_of(&scene, Some(TWO_UNNAMED_GROUPS)), @"<folder>/scene.toml:2: [mesh]: 1 tetrahedra are in no region (first: 2); give a region for them, or one without a group for the whole mesh");
}
