//! The scenes of the project, and other spellings of the same scenes.

use sinew_core::{OptionValue, Options, Ramp};
use sinew_fem::{Fixed, Law, LoadKind, LoadSpec, Problem, Rayleigh, Region, SpringRule};
use sinew_scene::{
    Body, Formula, Initial, MeshChanges, MeshSource, Oscillator, ProbeAt, ProbePoint, Quantity,
    RunSettings, Scene, SceneSource, Subject, TimeStep,
};

use crate::common::scenes;

fn scene(name: &str) -> Scene {
    let path = scenes()
        .into_iter()
        .find(|path| path.ends_with(name))
        .unwrap();
    Scene::load(path).unwrap()
}

fn parse(text: &str) -> Scene {
    Scene::parse(SceneSource::new("scene.toml", text)).unwrap()
}

#[test]
fn a_scene_means_the_same_in_any_layout() {
    for path in scenes() {
        let scene = Scene::load(&path).unwrap();
        let table: toml::Table = scene.source().text().parse().unwrap();
        for text in [toml::to_string(&table), toml::to_string_pretty(&table)] {
            let again = parse(&text.unwrap());
            assert_eq!(again.title(), scene.title());
            assert_eq!(again.subject(), scene.subject(), "{}", path.display());
            assert_eq!(again.settings(), scene.settings());
        }
    }
}

#[test]
fn a_scene_can_be_built_on_a_mesh_at_hand() {
    let text = "[mesh]\ncube = { cells = 2, edge = 0.1 }\n[[region]]\ndensity = 1000.0\n\
                model = \"springs\"\nyoungs_modulus = 1e4\nsprings = { rule = \"lloyd\" }\n\
                [[fixed]]\ngroup = \"sides\"\n\
                [run]\nduration = 1.0\nintegrator = \"newmark\"\ndt = 0.1\n";
    let mesh = sinew_mesh::structured::cube(4, 0.2, sinew_mesh::structured::Split::Kuhn).unwrap();
    let simulation = parse(text).build_on(mesh).unwrap();
    assert_eq!(simulation.system().dofs(), 3 * 3 * 3 * 5);
    assert_eq!(simulation.system().extent(), Some(0.2));
    // A mesh without the scene's groups is refused at the line that names one of them.
    let corners = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let bare = sinew_mesh::TetMesh::new(corners, vec![[0, 1, 2, 3]]).unwrap();
    let refusal = parse(text).build_on(bare).unwrap_err().to_string();
    let place = "scene.toml:9: [[fixed]] 1: no group is named \"sides\"";
    assert!(refusal.starts_with(place), "{refusal}");
}

#[test]
fn the_papers_oscillator() {
    let scene = scene("paper-oscillator.toml");
    let expected = Oscillator {
        mass: 0.1,
        stiffness: 100.0,
        damping: 1.0,
        displacement: 0.0,
        velocity: -5.0,
        force: 0.0,
    };
    assert_eq!(scene.subject(), &Subject::Oscillator(expected));
    assert_eq!(
        scene.settings(),
        &RunSettings {
            duration: 1.0,
            samples: 50,
            integrator: "cnn".into(),
            dt: TimeStep::Given(0.02),
            memory: None,
            free_flight: false,
            options: Options::new().with_number("saturation", 4.0),
        }
    );
}

#[test]
fn the_papers_cube() {
    let expected = Body {
        mesh: MeshSource::File("../meshes/paper-cube.msh".into()),
        mesh_changes: MeshChanges::default(),
        motions: Vec::new(),
        cutting: None,
        tools: Vec::new(),
        problem: Problem {
            regions: vec![
                Region::new(
                    Law::Springs {
                        youngs_modulus: 3500.0,
                        rule: SpringRule::Lloyd,
                        calibrate: false,
                        damping_ratio: 0.0,
                    },
                    1060.0,
                )
                .on("tissue"),
            ],
            damping: Rayleigh::new(80.0, 0.0),
            fixed: vec![Fixed::at("sides")],
            moves: Vec::new(),
            loads: vec![LoadSpec::new("top", LoadKind::Traction([0.0, 0.0, -500.0]))],
            gravity: None,
        },
        load_files: vec![None],
        load_names: vec![None],
        initial: Vec::new(),
        probes: vec![ProbePoint {
            name: "top-centre".into(),
            at: ProbeAt::Point([0.1, 0.1, 0.2]),
            quantity: Quantity::Displacement,
        }],
        selected: Vec::new(),
    };
    let scene = scene("paper-cube.toml");
    assert_eq!(scene.title(), "The paper's cube, reproduction scene");
    assert_eq!(scene.subject(), &Subject::Body(Box::new(expected)));
    assert_eq!(scene.settings().dt, TimeStep::Given(0.02));
}

/// Every key that the paper's scenes do not use.
#[test]
fn every_other_key() {
    let scene = parse(
        r#"
gravity = [0, 0, -9.81]
mesh.cube = { cells = 4, edge = 0.1, split = "mirrored" }

[[region]]
group = "a"
density = 1000
model = "linear"
youngs_modulus = 1e4
poissons_ratio = 0.45

[[region]]
group = "b"
density = 1100
model = "springs"
youngs_modulus = 2e4
[region.springs]
rule = "van-gelder"
calibrate = true
damping_ratio = 0.5

[damping]
stiffness = 1e-3

[[fixed]]
group = "bottom"
axes = "zx"

[[load]]
name = "press"
group = "top"
pressure = -20
ramp = { kind = "sin2", rise = 0.2 }
[[load]]
group = "top"
force = [1, 2, 3]
ramp = { kind = "pulse", from = 0.1, to = 0.2 }
[[load]]
name = "table"
group = "top"
force = [1, 2, 3]
ramp = { kind = "table", times = [0, 1], values = [0.0, 2.0] }
[[load]]
group = "top"
force = [0, 0, 0]

[[initial]]
static = ["table", "gravity"]
[[initial]]
group = "top"
displacement = [1, 0, 0]
[[initial]]
velocity = [0, 1, 0]
[[initial]]
stretch = [0.1, 0, 0]
origin = [1, 0, 0]

[run]
duration = 2
samples = 7
integrator = "rk4"
dt = 1e-3
substeps = "auto"
"#,
    );
    let Subject::Body(body) = scene.subject() else {
        panic!("a body");
    };
    assert!(matches!(body.mesh, MeshSource::Cube { cells: 4, .. }));
    let laws: Vec<Law> = body
        .problem
        .regions
        .iter()
        .map(|region| region.law.clone())
        .collect();
    let springs = Law::Springs {
        youngs_modulus: 2e4,
        rule: SpringRule::VanGelder,
        calibrate: true,
        damping_ratio: 0.5,
    };
    let linear = Law::linear(1e4, 0.45);
    assert_eq!(laws, [linear, springs]);
    assert_eq!(body.problem.damping.stiffness, 1e-3);
    assert_eq!(body.problem.fixed[0].axes, [true, false, true]);
    assert_eq!(body.problem.gravity, Some([0.0, 0.0, -9.81]));
    let ramps: Vec<&Ramp> = body.problem.loads.iter().map(|load| &load.ramp).collect();
    let table = Ramp::Table {
        times: vec![0.0, 1.0],
        values: vec![0.0, 2.0],
    };
    let pulse = Ramp::Pulse { from: 0.1, to: 0.2 };
    assert_eq!(
        ramps,
        [&Ramp::Sin2 { rise: 0.2 }, &pulse, &table, &Ramp::Step]
    );
    assert_eq!(body.problem.loads[0].kind, LoadKind::Pressure(-20.0));
    assert_eq!(body.problem.loads[1].kind, LoadKind::Force([1.0, 2.0, 3.0]));
    let names: Vec<Option<&str>> = body.load_names.iter().map(|name| name.as_deref()).collect();
    assert_eq!(names, [Some("press"), None, Some("table"), None]);
    assert_eq!(
        body.initial,
        [
            Initial::Static {
                loads: vec!["table".into(), "gravity".into()],
            },
            Initial::Displacement {
                group: Some("top".into()),
                value: [1.0, 0.0, 0.0].map(Formula::from),
            },
            Initial::Velocity {
                group: None,
                value: [0.0, 1.0, 0.0].map(Formula::from),
            },
            Initial::Stretch {
                group: None,
                strain: [0.1, 0.0, 0.0],
                origin: [1.0, 0.0, 0.0],
            },
        ]
    );
    let options = Options::new().with("substeps", OptionValue::Text("auto".into()));
    assert_eq!(scene.settings().options, options);
    assert_eq!(scene.settings().samples, 7);
}

/// Errors name each key instead of its line, in tables of a list, inner tables and lists, from values of any kind of
/// program.
#[test]
fn a_scene_of_values_is_that_of_its_text_and_errors_name_keys() {
    let values = |density: f64, more: serde_json::Value| {
        let mut scene = serde_json::json!({
            "mesh": { "block": { "cells": [2, 2, 2], "size": [0.1, 0.1, 0.1] } },
            "region": [{ "density": density, "model": "linear", "youngs_modulus": 3000, "poissons_ratio": 0.3 }],
            "fixed": [{ "where": { "below": { "z": 0.0 } } }],
            "run": { "duration": 0.1, "integrator": "central-difference", "dt": 0.001 },
        });
        if let (Some(scene), Some(more)) = (scene.as_object_mut(), more.as_object()) {
            scene.extend(more.clone());
        }
        scene
    };
    let sound = Scene::from_value(&values(1000.0, serde_json::json!({})), "folder").unwrap();
    let again = Scene::parse(sound.source().clone()).unwrap();
    assert_eq!(sound.settings(), again.settings());
    assert_eq!(sound.build().unwrap().system().dofs(), 54);
    let said = |density: f64, more: serde_json::Value| {
        let refused = Scene::from_value(&values(density, more), ".").unwrap_err();
        refused.to_string()
    };
    assert!(
        said(-3.0, serde_json::json!({}))
            .starts_with("region[1].density: density = -3.0: expected"),
        "{}",
        said(-3.0, serde_json::json!({}))
    );
    for (more, begins) in [
        (serde_json::json!({ "gravity": [0, 0, "x"] }), "gravity: "),
        (
            serde_json::json!({ "fixed": [{ "where": { "below": { "w": 1 } } }] }),
            "fixed[1].where.below.w: ",
        ),
        (
            serde_json::json!({ "fixed": [{ "group": "bottom", "axis": "x" }] }),
            "fixed[1].axis: unknown key",
        ),
        (serde_json::json!({ "run": { "duration": 0.1 } }), "run: "),
        (
            serde_json::json!({ "title": null }),
            "the scene: these values make no scene: `title` is null",
        ),
        (
            serde_json::json!({ "region": [{ "density": null }] }),
            "the scene: these values make no scene: `region[1].density` is null",
        ),
        (
            serde_json::json!({ "gravity": [0, null, 0] }),
            "the scene: these values make no scene: `gravity[2]` is null",
        ),
        (
            serde_json::json!({ "fixed": [{ "group": "bottom" }, 3] }),
            "fixed[2]: ",
        ),
        (
            serde_json::json!({ "load": [{ "group": "top", "traction": [0, 0, 1], "ramp": { "kind": "abc", "rise": 0.1 } }] }),
            "load[1].ramp.kind: kind = \"abc\": expected \"step\"",
        ),
        (
            serde_json::json!({ "gravity": [0, 0, u64::MAX] }),
            "gravity: gravity = [0, 0, 18446744073709551615]: expected whole numbers of at most 9223372036854775807 in size",
        ),
        (
            serde_json::json!({ "run": { "duration": u64::MAX, "integrator": "newmark", "dt": 0.01 } }),
            "run.duration: duration = 18446744073709551615: expected whole numbers of at most 9223372036854775807 in size",
        ),
    ] {
        let said = said(1000.0, more);
        assert!(said.starts_with(begins), "{said}");
    }
}
