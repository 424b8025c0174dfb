//! Scenes on meshes of other formats, whose parts are chosen by data.

use std::fs;
use std::path::Path;

use sinew_mesh::structured::{Split, block};
use sinew_mesh::vtu::{VtuEncoding, write_vtu};
use sinew_mesh::{GroupMembers, NodeData, TetData};
use sinew_scene::{Scene, SceneError, Simulation, propose};

/// Writes a bar of two layers as a .vtu file without groups: labels 1 and 2, a stiffness, and the height at nodes.
fn write_bar(folder: &Path) {
    let mut bar = block([1, 1, 2], [0.1, 0.1, 0.2], Split::Kuhn).unwrap();
    bar.groups.clear();
    let half = bar.tets.len() / 2;
    let layers = |values: [f64; 2]| (0..2 * half).map(move |tet| values[tet / half]).collect();
    let data = |name: &str, values| TetData {
        name: name.to_owned(),
        step: 0,
        components: 1,
        values,
    };
    bar.data = vec![
        data("labels", layers([1.0, 2.0])),
        data("Young's modulus", layers([2000.0, 8000.5])),
    ];
    bar.node_data = vec![NodeData {
        name: "height".to_owned(),
        step: 0,
        components: 1,
        values: bar.points.iter().map(|point| point[2]).collect(),
    }];
    let mut file = Vec::new();
    write_vtu(&bar.to_mesh(), VtuEncoding::RawAppended, &mut file).unwrap();
    fs::write(folder.join("bar.vtu"), file).unwrap();
}

const SCENE: &str = "[mesh]\nfile = \"bar.vtu\"\n\
    [[region]]\nwhere = { data = { name = \"labels\", equals = 2 } }\n\
    density = 1000.0\nmodel = \"linear\"\nyoungs_modulus = 5000.0\npoissons_ratio = 0.3\n\
    [[region]]\nwhere = \"rest\"\ndensity = 900.0\nmodel = \"linear\"\nyoungs_modulus = 1000.0\npoissons_ratio = 0.3\n\
    [[fixed]]\nwhere = { data = { name = \"height\", between = [0, 0.05] } }\n\
    [[load]]\nwhere = { data = { name = \"labels\", equals = [2, 3] }, face = { normal = [0, 0, 1], angle = 10 } }\npressure = 10.0\n\
    [run]\nduration = 0.1\nintegrator = \"central-difference\"\ndt = \"auto\"\n";

fn load(text: &str) -> Result<Simulation, SceneError> {
    let folder = tempfile::tempdir().unwrap();
    write_bar(folder.path());
    let path = folder.path().join("scene.toml");
    fs::write(&path, text).unwrap();
    Scene::load(path).and_then(Scene::build)
}

#[test]
fn labels_choose_regions_and_data_at_nodes_choose_supports() {
    let simulation = load(SCENE).unwrap();
    let mesh = simulation.model().body().unwrap().model.mesh();
    let group = |name: &str| mesh.group(name).unwrap();
    assert_eq!(group("tetrahedra with labels = 2").members.len(), 6);
    let GroupMembers::Tets(upper) = &group("tetrahedra with labels = 2").members else {
        panic!("it is of tetrahedra");
    };
    assert_eq!(upper[0], 6);
    assert_eq!(group("nodes with 0 <= height <= 0.05").members.len(), 4);
    let top = "triangles facing (0, 0, 1) within 10 degrees and with labels = 2 or 3";
    assert_eq!(group(top).members.len(), 2);
}

#[test]
fn data_that_choose_nothing_are_told_at_their_line() {
    let said = |from: &str, to: &str| {
        let error = load(&SCENE.replacen(from, to, 1)).unwrap_err();
        error.to_string()
    };
    assert!(
        said("equals = 2 ", "equals = 7 ")
            .ends_with("no tetrahedron is with labels = 7; of the values there are 1, 2"),
        "{}",
        said("equals = 2 ", "equals = 7 ")
    );
    let unknown = said("\"height\"", "\"hight\"");
    assert!(
        unknown.contains("no data at nodes or of tetrahedra are named \"hight\"; there are"),
        "{unknown}"
    );
    for (from, to, expected) in [
        (
            "equals = 2 ",
            "equals = \"2\" ",
            "a number such as 2, or a list such as [2, 3]",
        ),
        (
            "[0, 0.05]",
            "[0.05, 0]",
            "two numbers such as [1.5, 3.0], the lower one first",
        ),
        ("equals = 2 ", "equals = 2, between = [1, 2] ", "between"),
        (
            "name = \"labels\", equals = 2 ",
            "name = \"labels\" ",
            "equals",
        ),
    ] {
        let said = said(from, to);
        assert!(said.contains(expected), "{said}");
    }
}

#[test]
fn a_first_scene_lists_data_and_proposes_a_stiffness_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    write_bar(folder.path());
    let mesh = sinew_mesh::read_mesh_file(folder.path().join("bar.vtu")).unwrap();
    let text = propose(mesh, Path::new("bar.vtu")).unwrap();
    for line in [
        "# Its data:",
        "#   labels (tetrahedra): whole numbers from 1 to 2, 2 different",
        "#   Young's modulus (tetrahedra): from 2.000000e3 to 8.000500e3",
        "#   height (nodes): from 0.000000e0 to 2.000000e-1",
        "# where = { data = { name = \"labels\", equals = 1 } } chooses a part by its label.",
        "youngs_modulus = { data = \"Young's modulus\" } # proposed by its name: are these Pa, from 2000 to 8000?",
    ] {
        assert!(text.lines().any(|other| other == line), "{line}\n{text}");
    }
    fs::write(folder.path().join("bar.toml"), &text).unwrap();
    Scene::load(folder.path().join("bar.toml"))
        .and_then(Scene::build)
        .unwrap();
}
