//! `cargo xtask bench` with input that cannot be used: one message, exit code 2, nothing written.

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

/// The command's message about a scene. Checks that nothing is written.
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
fn a_scene_that_cannot_be_measured_costs_the_others_nothing() {
    let directory = tempfile::tempdir().unwrap();
    let scene = |name: &str, text: &str| {
        let path = directory.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let cases = [
        (CUBE.replace("1060.0", "0.0"), "density = 0.0"),
        (CUBE.replace("3500.0", "3.5e300"), "reference"),
        ("title = ".to_owned(), "not TOML"),
    ];
    let good = scene("good.toml", CUBE);
    for (text, reason) in cases {
        let bad = scene("bad.toml", &text);
        let out = directory.path().join("out");
        let mut command = bench(&bad, &out);
        command
            .arg("--scene")
            .arg(&good)
            .args(["--integrator", "newmark"]);
        let output = command.output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert_eq!(said.trim_end().lines().count(), 1, "{said}");
        assert!(said.contains("1 missing from the results"), "{said}");
        let shown = String::from_utf8(output.stdout).unwrap();
        let page = std::fs::read_to_string(out.join("report.html")).unwrap();
        for told in [&said, &shown, &page] {
            assert!(told.contains("bad.toml") && told.contains(reason), "{told}");
        }
        assert!(shown.contains("newmark"), "{shown}");
        let json = std::fs::read_to_string(out.join("results.json")).unwrap();
        let results: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert_eq!(results["cases"][0]["id"], "good");
        assert!(!results["rows"].as_array().unwrap().is_empty());
        let missing = &results["missing"][0];
        assert!(missing["scene"].as_str().unwrap().ends_with("bad.toml"));
        assert!(
            missing["reason"].as_str().unwrap().contains(reason),
            "{missing}"
        );
    }
}

#[test]
fn where_no_scene_can_be_measured_each_is_named() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("out");
    let mut command = bench(Path::new("nowhere.toml"), &out);
    let output = command.args(["--scene", "neither.toml"]).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(
        said.contains("nowhere.toml") && said.contains("neither.toml"),
        "{said}"
    );
    assert!(!out.exists());
}

#[test]
#[cfg(unix)]
fn an_output_that_would_destroy_something_is_refused_before_anything_is_measured() {
    use std::os::unix::fs::FileTypeExt;
    let directory = tempfile::tempdir().unwrap();
    let path = |name: &str| directory.path().join(name);
    std::fs::write(path("scene.toml"), CUBE).unwrap();
    std::fs::write(path("file"), "old").unwrap();
    std::fs::create_dir_all(path("taken/report.html")).unwrap();
    std::fs::create_dir(path("linked")).unwrap();
    std::fs::hard_link(path("scene.toml"), path("linked/results.json")).unwrap();
    std::fs::create_dir(path("kept")).unwrap();
    std::fs::write(path("kept/stability-scene.svg"), "old").unwrap();
    let mut permissions = std::fs::metadata(path("kept/stability-scene.svg"))
        .unwrap()
        .permissions();
    permissions.set_readonly(true);
    std::fs::set_permissions(path("kept/stability-scene.svg"), permissions).unwrap();
    for (out, expected) in [
        (path("file"), "file: it is not a folder"),
        (path("file/out"), "file: it is not a folder"),
        ("/dev/null".into(), "/dev/null: it is not a folder"),
        (path("taken"), "taken/report.html: it is a folder"),
        (path("linked"), "linked/results.json: this run reads it as "),
        (path("kept"), "kept/stability-scene.svg: it is read-only"),
    ] {
        let output = bench(&path("scene.toml"), &out).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(expected), "{said}");
        assert_eq!(said.trim_end().lines().count(), 1, "{said}");
        assert_eq!(output.stdout, b"");
    }
    assert_eq!(std::fs::read_to_string(path("scene.toml")).unwrap(), CUBE);
    assert_eq!(std::fs::read_to_string(path("file")).unwrap(), "old");
    assert_eq!(std::fs::read_dir(path("taken")).unwrap().count(), 1);
    let null = std::fs::metadata("/dev/null").unwrap();
    assert!(null.file_type().is_char_device());
}

#[test]
#[cfg(unix)]
fn a_full_standard_output_is_an_error_once_the_files_are_written() {
    let Ok(full) = std::fs::File::options().write(true).open("/dev/full") else {
        return;
    };
    let directory = tempfile::tempdir().unwrap();
    let scene = directory.path().join("scene.toml");
    std::fs::write(&scene, CUBE).unwrap();
    let out = directory.path().join("out");
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_xtask"));
    command.args(["bench", "--quick", "--integrator", "newmark", "--scene"]);
    let command = command.arg(&scene).arg("--out").arg(&out).stdout(full);
    let output = command
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let output = output.wait_with_output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains("writing standard output failed: No space left"),
        "{said}"
    );
    assert!(out.join("results.json").exists());
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
fn a_bench_over_sizes_looks_at_its_folder_first_and_takes_no_scene() {
    let directory = tempfile::tempdir().unwrap();
    let path = |name: &str| directory.path().join(name);
    std::fs::write(path("file"), "old").unwrap();
    std::fs::create_dir_all(path("taken/scale.json")).unwrap();
    std::fs::create_dir_all(path("drawn/real-time.svg")).unwrap();
    for (out, expected) in [
        ("file", "file: it is not a folder"),
        ("taken", "taken/scale.json: it is a folder"),
        ("drawn", "drawn/real-time.svg: it is a folder"),
    ] {
        let mut command = Command::cargo_bin("xtask").unwrap();
        let command = command.args(["bench", "--scale", "--quick", "--out"]);
        let output = command.arg(path(out)).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(expected), "{said}");
        assert_eq!(output.stdout, b"");
    }
    for other in [["--scene", "a.toml"], ["--integrator", "rk4"]] {
        let mut command = Command::cargo_bin("xtask").unwrap();
        let output = command.args(["bench", "--scale"]).args(other).output();
        let said = String::from_utf8(output.unwrap().stderr).unwrap();
        assert!(said.contains("cannot be used with"), "{said}");
    }
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

#[test]
fn simulators_are_skipped_each_by_itself_where_there_is_no_python() {
    let nothing = tempfile::tempdir().unwrap();
    let mut command = Command::cargo_bin("xtask").unwrap();
    command.args(["bench", "--quick", "--beside", "mujoco,newton"]);
    let output = command.env("PATH", nothing.path()).output().unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines.len(), 2, "{said}");
    for (line, name) in lines.into_iter().zip(["MuJoCo", "Newton"]) {
        let option = format!("--beside {} needs Python 3", name.to_lowercase());
        assert!(line.starts_with(&format!("skipped: {name}: ")), "{line}");
        assert!(line.contains(&option), "{line}");
    }
}

#[test]
fn a_comparison_needs_python() {
    let nothing = tempfile::tempdir().unwrap();
    let mut command = Command::cargo_bin("xtask").unwrap();
    let output = command.arg("compare").env("PATH", nothing.path()).output();
    let output = output.unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("compare needs Python 3"), "{said}");
    assert_eq!(output.stdout, b"");
}
