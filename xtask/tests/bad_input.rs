//! `cargo xtask bench` with input that cannot be used: one message, exit code 2, nothing written.

#![cfg(test)]

use std::path::Path;

use assert_cmd::Command;

const CUBE: &str = "title = \"a cube\"
[mesh]
cube = { cells = 2, edge = 0.1, split = \"kuhn\" }
[[region]]
density = 1060.0
model = \"linear\"
youngs_modulus = 3500.0
poissons_ratio = 0.3
[[fixed]]
group = \"bottom\"
[[load]]
group = \"top\"
traction = [0.0, 0.0, -10.0]
[run]
duration = 0.1
integrator = \"newmark\"
dt = 0.01
";

const POINT_ONLY: &str = "$MeshFormat
4.1 0 8
$EndMeshFormat
$Nodes
1 1 1 1
0 1 0 1
1
0 0 0
$EndNodes
$Elements
1 1 1 1
0 1 15 1
1 1
$EndElements
";

/// What the command says of a scene, having written nothing.
fn refusal(scene: &str, more: &[&str]) -> String {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("scene.toml");
    std::fs::write(&path, scene).unwrap();
    std::fs::write(directory.path().join("point.msh"), POINT_ONLY).unwrap();
    std::fs::write(directory.path().join("noise.msh"), "no mesh at all").unwrap();
    let out = directory.path().join("out");
    let output = bench(&path, &out).args(more).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert_eq!(output.stdout, b"");
    assert_eq!(said.trim_end().lines().count(), 1, "{said}");
    assert!(!out.exists(), "something was written");
    said
}

fn bench(scene: &Path, out: &Path) -> Command {
    let mut command = Command::cargo_bin("xtask").unwrap();
    command
        .args(["bench", "--quick", "--scene"])
        .arg(scene)
        .arg("--out")
        .arg(out);
    command
}

#[test]
fn each_mistake_is_named_with_its_line() {
    let file = |name: &str| {
        let from = "cube = { cells = 2, edge = 0.1, split = \"kuhn\" }";
        CUBE.replace(from, &format!("file = \"{name}\""))
    };
    let change = |from: &str, to: &str| {
        assert!(CUBE.contains(from));
        CUBE.replace(from, to)
    };
    let cases = [
        (
            change("\"newmark\"", "\"newmrk\""),
            "scene.toml:16: [run]: unknown integrator `newmrk`",
        ),
        (
            change("\"bottom\"", "\"botom\""),
            "scene.toml:10: [[fixed]]",
        ),
        (
            change("\"bottom\"", "\"tissue\""),
            "no degree of freedom is free",
        ),
        (change("1060.0", "0.0"), "scene.toml:5: [[region]]"),
        (change("3500.0", "-1.0"), "scene.toml:7: [[region]]"),
        (change("0.3", "0.5"), "scene.toml:8: [[region]]"),
        (change("-10.0", "nan"), "scene.toml:13: [[load]]"),
        (
            change("duration = 0.1", "duration = 0.0"),
            "scene.toml:15: [run]",
        ),
        (change("dt = 0.01", "dt = inf"), "scene.toml:17: [run]"),
        (file("nowhere.msh"), "nowhere.msh"),
        (file("noise.msh"), "noise.msh"),
        (file("point.msh"), "tetrahedra"),
        ("title = ".into(), "scene.toml:1"),
    ];
    for (scene, expected) in cases {
        let said = refusal(&scene, &[]);
        assert!(said.contains(expected), "{expected} is not in\n{said}");
    }
}

#[test]
fn each_wrong_argument_is_named() {
    let said = refusal(CUBE, &["--integrator", "cn"]);
    assert!(said.contains("unknown integrator `cn`"), "{said}");
    let said = refusal(CUBE, &["--dt", "0"]);
    assert!(said.contains("--dt 0"), "{said}");
}

#[test]
fn a_missing_scene_is_named() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("out");
    let output = bench(Path::new("nowhere.toml"), &out).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(
        String::from_utf8(output.stderr)
            .unwrap()
            .contains("nowhere.toml")
    );
}

#[test]
fn a_method_that_cannot_run_is_listed_with_its_reason_and_the_others_run() {
    let directory = tempfile::tempdir().unwrap();
    let scene = directory.path().join("scene.toml");
    let text = CUBE.replace("\"newmark\"", "\"forward-euler\"\nsubsteps = \"auto\"");
    std::fs::write(&scene, text).unwrap();
    let out = directory.path().join("out");
    let mut command = bench(&scene, &out);
    let output = command
        .args(["--integrator", "forward-euler", "--integrator", "newmark"])
        .output()
        .unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("a stable step above 0"), "{said}");
    assert!(said.contains("newmark"), "{said}");
    assert!(out.join("results.json").exists());
}

#[test]
fn another_program_needs_python_and_takes_no_scene() {
    let beside = |arguments: &[&str]| {
        let nothing = tempfile::tempdir().unwrap();
        let mut command = Command::cargo_bin("xtask").unwrap();
        command.args(["bench", "--beside"]).args(arguments);
        let output = command.env("PATH", nothing.path()).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert_eq!(output.stdout, b"");
        said
    };
    let said = beside(&["scipy"]);
    assert_eq!(said.trim_end().lines().count(), 1, "{said}");
    assert!(said.contains("--beside scipy needs Python 3"), "{said}");
    assert!(beside(&["scipy", "--scene", "a.toml"]).contains("cannot be used with"));
    assert!(beside(&["matlab"]).contains("possible values: scipy"));
    let said = beside(&["scipy", "--integrator", "cn"]);
    assert!(said.contains("unknown integrator `cn`"), "{said}");
}
