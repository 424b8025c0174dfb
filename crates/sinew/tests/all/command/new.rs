//! `sinew new`: first scenes for meshes, and ready scenes.

use std::fs;
use std::path::Path;

use crate::common::sinew;

fn mesh(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../meshes");
    path.join(name).to_str().unwrap().to_owned()
}

#[test]
fn a_first_scene_runs_as_it_is_and_is_never_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let said = sinew(folder.path(), &["new", &mesh("beam.msh")]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.out.contains("sinew plan beam.toml"), "{}", said.out);
    let said = sinew(folder.path(), &["plan", "beam.toml", "--strict"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let said = sinew(folder.path(), &["run", "beam.toml", "--probes", "beam.csv"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let csv = fs::read_to_string(folder.path().join("beam.csv")).unwrap();
    assert_eq!(csv.lines().count(), 102);

    fs::write(folder.path().join("beam.toml"), "mine").unwrap();
    let said = sinew(folder.path(), &["new", &mesh("beam.msh")]);
    assert_eq!(said.code, Some(2));
    assert!(
        said.err
            .contains("beam.toml exists and has other content; it was not changed"),
        "{}",
        said.err
    );
    let kept = fs::read_to_string(folder.path().join("beam.toml")).unwrap();
    assert_eq!(kept, "mine");
    let said = sinew(folder.path(), &["new", &mesh("beam.msh"), "--force"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    // What it would write is there already.
    let said = sinew(folder.path(), &["new", &mesh("beam.msh")]);
    assert_eq!(said.code, Some(0), "{}", said.err);
}

#[test]
fn a_first_scene_names_its_mesh_from_where_it_lies() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("scenes")).unwrap();
    fs::copy(mesh("sliver-20.msh"), folder.path().join("a.msh")).unwrap();
    let said = sinew(folder.path(), &["new", "a.msh", "--out", "scenes/a.toml"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let text = fs::read_to_string(folder.path().join("scenes/a.toml")).unwrap();
    assert!(text.contains("file = \"../a.msh\""), "{text}");
    let said = sinew(folder.path(), &["plan", "scenes/a.toml"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    // To standard output goes the scene and nothing else.
    let said = sinew(folder.path(), &["new", "a.msh", "--out", "-"]);
    assert!(said.out.ends_with("# m\n"), "{}", said.out);
}

/// A cube of 100 mm weighs a kilogram.
#[test]
fn a_mesh_in_millimetres_becomes_a_body_in_metres() {
    use sinew::mesh::structured::{Split, cube};
    let folder = tempfile::tempdir().unwrap();
    let mut file = fs::File::create(folder.path().join("mm.msh")).unwrap();
    let mesh = cube(2, 100.0, Split::Kuhn).unwrap().to_mesh();
    sinew::mesh::write_msh41_ascii(&mesh, &mut file).unwrap();
    let said = sinew(folder.path(), &["new", "mm.msh"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let said = sinew(folder.path(), &["plan", "mm.toml", "--strict"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.out.contains("0.001 m3, 1 kg"), "{}", said.out);
}

#[test]
fn every_ready_scene_is_listed_and_written_with_its_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let said = sinew(folder.path(), &["new", "--list"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let lines: Vec<&str> = said.out.lines().collect();
    let names = lines[..lines.len() - 1].iter();
    let mut names: Vec<&str> = names.map(|line| line.split(' ').next().unwrap()).collect();
    assert_eq!(names[0], "held-cube");
    for name in &names {
        let said = sinew(folder.path(), &["new", "--ready", name]);
        assert_eq!(said.code, Some(0), "{}", said.err);
        let said = sinew(folder.path(), &["plan", &format!("{name}.toml")]);
        assert_eq!(said.code, Some(0), "{}", said.err);
    }
    // Those of the folder scenes/ready, no more and no fewer.
    let ready = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/ready");
    let files = fs::read_dir(ready)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let scenes = files.filter(|path| path.extension().is_some_and(|end| end == "toml"));
    let mut files: Vec<String> = scenes
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    files.sort();
    names.sort_unstable();
    assert_eq!(names, files);
    let said = sinew(folder.path(), &["new", "--ready", "bean"]);
    assert_eq!(said.code, Some(2));
    assert!(
        said.err
            .contains("no ready scene is named \"bean\"; there are held-cube, organ")
    );
}

#[test]
fn a_mesh_that_differs_is_not_replaced_by_that_of_a_ready_scene() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("beam.msh"), "mine").unwrap();
    let said = sinew(folder.path(), &["new", "--ready", "beam"]);
    assert_eq!(said.code, Some(2), "{}", said.out);
    assert!(
        said.err
            .contains("beam.msh exists and has other content; it was not changed"),
        "{}",
        said.err
    );
    assert!(!folder.path().join("beam.toml").exists());
}

#[test]
fn a_scene_in_the_place_of_a_mesh_is_told_from_one() {
    let folder = tempfile::tempdir().unwrap();
    let said = sinew(folder.path(), &["new", "organ.toml"]);
    assert_eq!(said.code, Some(2));
    assert!(said.err.contains("name a .msh file"), "{}", said.err);
    assert!(said.err.contains("sinew run organ.toml"), "{}", said.err);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}
