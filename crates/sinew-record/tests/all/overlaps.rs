//! Runs report bodies that pass through each other.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};
use sinew_mesh::structured::{Split, block};
use sinew_mesh::{Group, GroupMembers, TetMesh, write_msh41_ascii};
use sinew_record::{Companion, Ended, FrameLooks};
use sinew_scene::{Scene, Simulation};

use crate::common::run;

const G: f64 = 9.81;

/// Two cubes of 0.1 m in one file, 5 mm apart, of which the lower one is fixed.
fn falling(folder: &Path, more: &str) -> Simulation {
    let of = |name: &str, low: f64| {
        let mut mesh = block([4; 3], [0.1; 3], Split::Mirrored).unwrap();
        mesh.points.iter_mut().for_each(|point| point[2] += low);
        mesh.groups = vec![Group {
            name: name.to_owned(),
            dim: 3,
            tag: if low > 0.0 { 2 } else { 1 },
            members: GroupMembers::Tets((0..).take(mesh.tets.len()).collect()),
        }];
        mesh
    };
    let (lower, upper) = (of("lower", 0.0), of("upper", 0.105));
    let (nodes, tets) = (lower.points.len() as u32, lower.tets.len() as u32);
    let points = [lower.points, upper.points].concat();
    let moved = upper.tets.iter().map(|tet| tet.map(|node| node + nodes));
    let mut mesh = TetMesh::new(points, lower.tets.into_iter().chain(moved).collect()).unwrap();
    mesh.groups = [lower.groups, upper.groups].concat();
    mesh.groups[1].members = GroupMembers::Tets((tets..2 * tets).collect());
    let mut file = Vec::new();
    write_msh41_ascii(&mesh.to_mesh(), &mut file).unwrap();
    fs::write(folder.join("cubes.msh"), file).unwrap();
    let text = format!(
        "gravity = [0.0, 0.0, -{G}]\n[mesh]\nfile = \"cubes.msh\"\n[[region]]\ngroup = \"lower\"\ndensity = 1000.0\nmodel = \"neo-hookean\"\n\
         youngs_modulus = 5000.0\npoissons_ratio = 0.3\n[[region]]\ngroup = \"upper\"\ndensity = 1000.0\nmodel = \"neo-hookean\"\n\
         youngs_modulus = 5000.0\npoissons_ratio = 0.3\n[[fixed]]\nwhere = {{ below = {{ z = 0.1 }} }}\n\
         [run]\nfree_flight = true\nintegrator = \"central-difference\"\ndt = 5e-4\n{more}"
    );
    let path = folder.join("scene.toml");
    fs::write(&path, text).unwrap();
    let mut simulation = Scene::load(path).and_then(Scene::build).unwrap();
    simulation.end_at_duration();
    simulation
}

fn summary(folder: &Path) -> Value {
    serde_json::from_slice(&fs::read(folder.join("summary.json")).unwrap()).unwrap()
}

struct InterruptAt(usize, usize);

impl Companion for InterruptAt {
    fn is_interrupted(&self) -> bool {
        self.1 >= self.0
    }

    fn progress(&mut self, steps: usize, _t: f64) {
        self.1 = steps;
    }
}

#[test]
fn a_cube_that_falls_into_another_is_told_with_depth_place_time_and_parts() {
    let place = tempfile::tempdir().unwrap();
    let path = |name: &str| place.path().join(name);
    let simulation = falling(
        place.path(),
        "duration = 0.08\n[output]\nfields = { frames = 8 }\n",
    );
    let end = run(&path("whole"), &simulation, &mut ());
    assert_eq!(end.ended, Ended::Finished);
    assert_eq!(serde_json::to_value(&end).unwrap()["ended"], "Finished");
    let told = summary(&path("whole"));
    // What of the way of a free fall goes beyond the gap.
    let depth = 0.5 * G * 0.08 * 0.08 - 0.005;
    let overlap = &told["overlap"];
    assert!(
        (overlap["depth_m"].as_f64().unwrap() / depth - 1.0).abs() < 1e-9,
        "{overlap} {depth}"
    );
    assert_eq!(
        (&overlap["t_s"], &told["bounded"]),
        (&json!(0.08), &json!(true))
    );
    let z = overlap["at_m"][2].as_f64().unwrap();
    assert!(
        (z - 0.1).abs() < 1e-9 || (z - (0.1 - depth)).abs() < 1e-9,
        "{overlap}"
    );
    let mut parts = overlap["parts"].as_array().unwrap().clone();
    parts.sort_by_key(ToString::to_string);
    assert_eq!(parts, ["lower", "upper"]);
    let warnings = told["warnings"].to_string();
    assert!(
        warnings.contains("m deep at node") && warnings.contains("at t = 0.08 s"),
        "{warnings}"
    );
    assert_eq!(end.warnings.len(), 1, "{:?}", end.warnings);
    // An interrupted run is looked at where it stands, and goes on to the same.
    let stopped = run(&path("parts"), &simulation, &mut InterruptAt(125, 0));
    let t = 125.0 * 5e-4;
    assert_eq!(stopped.ended, Ended::Interrupted { t });
    let met = summary(&path("parts"))["overlap"]["depth_m"]
        .as_f64()
        .unwrap();
    assert!(
        (met / (0.5 * G * t * t - 0.005) - 1.0).abs() < 1e-9,
        "{met}"
    );
    run(&path("parts"), &simulation, &mut ());
    assert_eq!(&summary(&path("parts"))["overlap"], overlap);
}

#[test]
fn a_cube_that_fell_through_is_told_by_the_frames_between_and_one_still_above_is_not() {
    let place = tempfile::tempdir().unwrap();
    let path = |name: &str| place.path().join(name);
    let above = falling(place.path(), "duration = 0.03\n");
    run(&path("above"), &above, &mut ());
    assert!(summary(&path("above"))["overlap"].is_null());
    assert!(
        !summary(&path("above"))["warnings"]
            .to_string()
            .contains("deep")
    );
    let through = falling(
        place.path(),
        "duration = 0.3\n[output]\nfields = { every = 0.0125 }\n",
    );
    run(&path("through"), &through, &mut ());
    let overlap = &summary(&path("through"))["overlap"];
    // First the ends that face each other are within, then those that face away.
    let instants = (0..=24).map(|frame| 0.5 * G * (0.0125 * f64::from(frame)).powi(2) - 0.005);
    let within = |depth: f64| depth.min(0.1 - depth).max((depth - 0.1).min(0.2 - depth));
    let deepest = instants.map(within).fold(0.0, f64::max);
    assert!(
        (overlap["depth_m"].as_f64().unwrap() / deepest - 1.0).abs() < 1e-9,
        "{overlap} {deepest}"
    );
    // A run without a folder looks at the same instants.
    let mut looks = FrameLooks::new(&through);
    let mut state = through.initial_state().clone();
    let mut integrator = through.integrator().unwrap();
    let (system, steps) = (through.system(), through.run());
    sinew_core::simulate(system, &mut *integrator, &mut state, &steps, &mut looks).unwrap();
    let told = looks.into_looked().warnings();
    let warnings = summary(&path("through"))["warnings"].clone();
    let in_folder: Vec<String> = serde_json::from_value(warnings).unwrap();
    assert!(
        told.len() == 1 && in_folder.contains(&told[0]),
        "{told:?} {in_folder:?}"
    );
}
