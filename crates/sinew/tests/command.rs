//! The `sinew` command, as a user meets it.

#![cfg(test)]

mod common;

use std::path::{Path, PathBuf};

use common::sinew;

fn scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../scenes")
        .join(name)
}

#[test]
fn plan_says_what_is_removed_and_which_step_is_stable() {
    let directory = tempfile::tempdir().unwrap();
    let cube = scene("paper-cube.toml");
    let said = sinew(directory.path(), &["plan", cube.to_str().unwrap()]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    for part in ["3993 -> 2673", "16.2 N act", "stable up to dt = 0.00125"] {
        assert!(said.out.contains(part), "{part} is not in\n{}", said.out);
    }
}

#[test]
fn run_writes_the_probes_and_calls_a_guarded_run_guarded() {
    let directory = tempfile::tempdir().unwrap();
    let cube = scene("paper-cube.toml");
    let said = sinew(directory.path(), &["run", cube.to_str().unwrap()]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.out.contains("guarded: 76.6"), "{}", said.out);
    let csv = std::fs::read_to_string(directory.path().join("paper-cube.csv")).unwrap();
    assert_eq!(csv.lines().count(), 52);
    assert!(csv.starts_with("t_s,top-centre_u_x_m"));
}

#[test]
fn run_says_into_how_many_parts_the_guard_cut_each_step() {
    let directory = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(scene("paper-cube.toml")).unwrap();
    let mesh = scene("../meshes/paper-cube.msh");
    let text = text
        .replace("../meshes/paper-cube.msh", mesh.to_str().unwrap())
        .replace("\"cnn\"", "\"forward-euler\"")
        .replace("saturation = 4.0", "saturation = \"auto\"");
    std::fs::write(directory.path().join("guarded.toml"), &text).unwrap();
    let said = sinew(directory.path(), &["run", "guarded.toml"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let cut = "the guard took each step in 18 parts: whole, it is longer than the stable step of `forward-euler`";
    assert!(said.out.contains(cut), "{}", said.out);
    assert!(!said.out.contains("guarded:"), "{}", said.out);
    // Whole steps are nothing to speak of.
    let text = text.replace("dt = 0.02", "dt = 0.001");
    std::fs::write(directory.path().join("guarded.toml"), text).unwrap();
    let said = sinew(directory.path(), &["run", "guarded.toml"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    for part in ["the guard", "guarded:"] {
        assert!(!said.out.contains(part), "{}", said.out);
    }
}

#[test]
fn a_diverging_run_says_so_keeps_what_it_has_and_fails() {
    let directory = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(scene("paper-cube.toml")).unwrap();
    let mesh = scene("../meshes/paper-cube.msh");
    let text = text
        .replace("../meshes/paper-cube.msh", mesh.to_str().unwrap())
        .replace("integrator = \"cnn\"", "integrator = \"forward-euler\"")
        .replace("saturation", "# saturation");
    std::fs::write(directory.path().join("euler.toml"), text).unwrap();
    let said = sinew(directory.path(), &["run", "euler.toml"]);
    assert_eq!(said.code, Some(1));
    assert!(said.err.contains("diverged at t = 0.16"), "{}", said.err);
    assert!(directory.path().join("euler.csv").exists());
}

#[test]
fn bad_input_gives_one_error_with_file_and_line_and_writes_nothing() {
    let cases = [
        (
            "dt = 0.02 ",
            "dt = -0.02 ",
            "scene.toml:10: [run]: dt = -0.02",
        ),
        (
            "mass = 0.1",
            "mass = nan",
            "scene.toml:3: [oscillator]: mass",
        ),
        (
            "\"cnn\"",
            "\"cn\"",
            "scene.toml:9: [run]: unknown integrator `cn`",
        ),
        (
            "saturation",
            "saturatoin",
            "scene.toml:11: [run]: `cnn` has no option `saturatoin`",
        ),
        (
            "duration = 1.0",
            "duration = 0",
            "scene.toml:8: [run]: duration = 0",
        ),
        ("[run]", "[runn]", "scene.toml"),
    ];
    let scene = "title = \"a spring\"\n[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = -5.0\n[run]\nduration = 1.0\nintegrator = \"cnn\"\ndt = 0.02 \nsaturation = 4.0\n";
    for (from, to, expected) in cases {
        let directory = tempfile::tempdir().unwrap();
        assert!(scene.contains(from));
        std::fs::write(directory.path().join("scene.toml"), scene.replace(from, to)).unwrap();
        let said = sinew(directory.path(), &["run", "scene.toml"]);
        assert_eq!(said.code, Some(2), "{to}");
        assert!(said.err.contains(expected), "{to}: {}", said.err);
        assert_eq!(said.err.matches("error:").count(), 1);
        assert_eq!(said.out, "");
        let files = std::fs::read_dir(directory.path()).unwrap().count();
        assert_eq!(files, 1, "{to}: only the scene itself");
    }
}

#[test]
fn a_run_that_would_end_at_a_jump_is_refused_before_it_begins() {
    let directory = tempfile::tempdir().unwrap();
    let scene = r#"
title = "a late tap"
[mesh]
cube = { cells = 2, edge = 0.1 }
[[region]]
density = 1060.0
model = "linear"
youngs_modulus = 3500.0
poissons_ratio = 0.3
[[fixed]]
group = "bottom"
[[load]]
name = "tap"
group = "top"
traction = [0.0, 0.0, -100.0]
ramp = { kind = "pulse", from = 0.9, to = 0.913 }
[run]
duration = 1.0
integrator = "propagator"
kind = "two-step"
dt = 0.02
"#;
    std::fs::write(directory.path().join("tap.toml"), scene).unwrap();
    let said = sinew(directory.path(), &["run", "tap.toml"]);
    assert_eq!(said.code, Some(2), "{}", said.out);
    let expected = "`propagator` takes loads that are constant over each step, and [[load]] \"tap\" changes at t = 0.913 s, in steps of 0.02 s; dt = 0.001 s would do";
    assert!(said.err.contains(expected), "{}", said.err);
    assert_eq!(said.err.matches("error:").count(), 1);
    assert!(!directory.path().join("tap.csv").exists());
}

#[test]
fn a_missing_scene_is_named() {
    let directory = tempfile::tempdir().unwrap();
    let said = sinew(directory.path(), &["plan", "nowhere.toml"]);
    assert_eq!(said.code, Some(2));
    assert!(said.err.contains("nowhere.toml"), "{}", said.err);
}

#[test]
fn every_integrator_is_listed() {
    let directory = tempfile::tempdir().unwrap();
    let said = sinew(directory.path(), &["integrators"]);
    for id in sinew::integrators::ids() {
        assert!(said.out.contains(id));
    }
    let guards = said.out.matches("saturation: guard").count();
    assert_eq!(guards, 6, "{}", said.out);
    let orders = said
        .out
        .matches("with stiffness damping or dashpots: order")
        .count();
    assert_eq!(orders, 11, "{}", said.out);
    let refused = "with stiffness damping: exact; with dashpots: refused";
    assert!(said.out.contains(refused), "{}", said.out);
}
