//! The largest displacement of references, on bodies many cells deep: ahead of the wave front the motion is as small as
//! representable numbers.

use std::path::{Path, PathBuf};

use sinew_core::vectors::largest;
use sinew_core::{State, System};
use sinew_measure::reference::{Taylor, Track, follow};
use sinew_scene::{Scene, SceneSource, Simulation};

/// Internal steps of the reference over which a body is followed.
const STEPS: usize = 6;

/// A body on a mesh, given as the scene's table has it.
fn body(mesh: &str, more: &str) -> Simulation {
    let text = format!(
        "[mesh]\n{mesh}\n[[region]]\ndensity = 1060.0\nmodel = \"linear\"\n\
         youngs_modulus = 5000.0\npoissons_ratio = 0.4\n{more}\n\
         [run]\nduration = 1.0\nintegrator = \"newmark\"\ndt = 0.1\n"
    );
    let scene = Scene::parse(SceneSource::new("deep.toml", text)).unwrap();
    scene.build().unwrap()
}

/// Follows a body for a few steps of the reference and checks its largest displacement by those at
/// closer instants.
fn check(name: &str, system: &dyn System, start: &State) {
    let operators = system.as_linear().unwrap().operators();
    let step = Taylor::new(operators, 1.0).longest_step();
    let close: Vec<f64> = (0..=4 * STEPS).map(|j| j as f64 * step / 4.0).collect();
    let ends = [0.0, step * STEPS as f64];
    let seen: Track = follow(system, start, &close).unwrap();
    let seen = seen.displacements.iter().map(|u| largest(u));
    let seen = seen.fold(0.0, f64::max);
    let max_u = follow(system, start, &ends).unwrap().max_u;
    assert!(seen > 0.0, "{name}: nothing moves");
    assert!(
        max_u >= seen * (1.0 - 1e-6),
        "{name}: {max_u:e} m, {seen:e} m were seen"
    );
    assert!(
        max_u <= seen * 1.01,
        "{name}: {max_u:e} m, {seen:e} m were seen"
    );
}

#[test]
fn a_loaded_cube_of_14_and_of_21_cells_has_a_largest_displacement() {
    for cells in [14, 21] {
        let mesh = format!("cube = {{ cells = {cells}, edge = 0.1, split = \"kuhn\" }}");
        let held = "[[fixed]]\ngroup = \"bottom\"\n[[load]]\ngroup = \"top\"\n\
                    traction = [0.0, 0.0, -5000.0]\n";
        let model = body(&mesh, held);
        let start = State::at_rest(model.system().dofs());
        check(&format!("{cells} cells"), model.system(), &start);
    }
}

fn meshes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../meshes");
    let paths = std::fs::read_dir(folder).unwrap();
    let paths = paths.map(|entry| entry.unwrap().path());
    let mut paths: Vec<PathBuf> = paths
        .filter(|path| path.extension().is_some_and(|extension| extension == "msh"))
        .collect();
    paths.sort();
    paths
}

#[test]
fn a_blow_on_one_node_of_every_mesh_has_a_largest_displacement() {
    let paths = meshes();
    assert!(paths.len() > 10);
    for path in paths {
        let model = body(&format!("file = {path:?}"), "");
        let mut start = State::at_rest(model.system().dofs());
        start.v[..3].copy_from_slice(&[0.3, -0.2, 1.0]);
        check(&path.display().to_string(), model.system(), &start);
    }
}
