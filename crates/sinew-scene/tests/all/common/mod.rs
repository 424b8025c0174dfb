//! Shared code of the tests of scenes: scenes are built and run as commands do.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::{Path, PathBuf};

use sinew_core::{State, simulate};
use sinew_scene::output::{Delivery, Destination};
use sinew_scene::{ProbeCsv, ProbeRows, Scene, SceneError, SceneSource, Simulation};

/// Reads and builds the scene of a file called `scene.toml`.
pub(crate) fn try_build(text: &str) -> Result<Simulation, SceneError> {
    Scene::parse(SceneSource::new("scene.toml", text)).and_then(Scene::build)
}

/// Builds a valid scene.
pub(crate) fn build(text: &str) -> Simulation {
    try_build(text).unwrap()
}

/// Runs a simulation to its end: the last state, and the file of its probes.
pub(crate) fn run(simulation: &Simulation, folder: &Path) -> (State, String) {
    let path = folder.join("probes.csv");
    let output = Destination::new(&path, &[]).unwrap().open().unwrap();
    let mut csv = ProbeCsv::new(
        output,
        ProbeRows::new(simulation.body()),
        sinew_scene::Schedule::at_most(usize::MAX, simulation.run().steps),
    )
    .unwrap();
    let mut state = simulation.initial_state().clone();
    let mut integrator = simulation.integrator().unwrap();
    simulate(
        simulation.system(),
        &mut *integrator,
        &mut state,
        &simulation.run(),
        &mut csv,
    )
    .unwrap();
    assert_eq!(csv.finish().unwrap(), Delivery::Whole);
    (state, fs::read_to_string(path).unwrap())
}

/// The numbers in a row of a CSV file.
pub(crate) fn numbers(row: &str) -> Vec<f64> {
    row.split(',').map(|cell| cell.parse().unwrap()).collect()
}

/// The files of all scenes of the repository.
pub(crate) fn scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut scenes = Vec::new();
    collect(&folder, &mut scenes);
    scenes.sort();
    scenes
}

fn collect(folder: &Path, scenes: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, scenes);
        } else if path.extension().is_some_and(|end| end == "toml") {
            scenes.push(path);
        }
    }
}
