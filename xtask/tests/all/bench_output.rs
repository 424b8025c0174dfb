//! Output of `cargo xtask bench`: the summary in few lines, and everything on demand.

use std::path::Path;

use assert_cmd::Command;

const OSCILLATOR: &str = "title = \"a mass on a spring\"
[oscillator]
mass = 0.1
stiffness = 100.0
damping = 1.0
velocity = -5.0
[run]
duration = 0.5
integrator = \"newmark\"
dt = 0.01
";

/// Standard output of a quick bench of all methods; nothing else is printed.
fn said(folder: &Path, more: &[&str]) -> String {
    let scene = folder.join("scene.toml");
    std::fs::write(&scene, OSCILLATOR).unwrap();
    let mut command = Command::cargo_bin("xtask").unwrap();
    command.args(["bench", "--quick", "--scene"]).arg(&scene);
    command.arg("--out").arg(folder.join("out")).args(more);
    let output = command.output().unwrap();
    let beside = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), beside.as_str()), (Some(0), ""));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn a_bench_prints_at_most_40_lines_and_everything_with_all() {
    let folder = tempfile::tempdir().unwrap();
    let brief = said(folder.path(), &[]);
    assert!(brief.lines().count() <= 40, "{brief}");
    for told in ["error at most", "--all", "report.html"] {
        assert!(brief.contains(told), "{told} is not in\n{brief}");
    }
    // Lines are steady: a pipe gets no signs that move a cursor.
    assert!(!brief.contains(['\r', '\u{1b}']), "{brief:?}");
    let json = std::fs::read_to_string(folder.path().join("out/results.json")).unwrap();
    let results: serde_json::Value = serde_json::from_str(&json).unwrap();
    let rows = results["rows"].as_array().unwrap().len();
    assert!(rows > 40);
    let all = said(folder.path(), &["--all"]);
    assert!(all.lines().count() > rows, "{all}");
}
