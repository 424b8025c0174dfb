//! Work predicted from a few steps, compared by counts with that of whole runs.

use std::path::Path;

use sinew_core::simulate;
use sinew_measure::Forecast;
use sinew_scene::{Scene, SceneSource, Simulation};

fn cube(integrator: &str) -> Simulation {
    let text = format!(
        "[mesh]\ncube = {{ cells = 4, edge = 0.1 }}\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\n\
         youngs_modulus = 3000.0\npoissons_ratio = 0.3\n[damping]\nmass = 5.0\n[[fixed]]\ngroup = \"bottom\"\n[[load]]\n\
         group = \"top\"\npressure = 20.0\nramp = {{ kind = \"sin2\", rise = 0.1 }}\n[run]\nduration = 0.3\ndt = 0.002\n\
         integrator = \"{integrator}\"\n"
    );
    Scene::parse(SceneSource::new("cube.toml", text))
        .unwrap()
        .build()
        .unwrap()
}

/// Asserts that sweeps and solutions of a run are predicted within a factor, which is 1 if the whole run is observed.
fn assert_foretold(simulation: &Simulation, within: f64) {
    let mut integrator = simulation.integrator().unwrap();
    let said = Forecast::of(simulation, &mut *integrator).unwrap();
    let mut state = simulation.initial_state().clone();
    let (system, run) = (simulation.system(), simulation.run());
    let done = simulate(system, &mut *integrator, &mut state, &run, &mut ()).unwrap();
    let near = |said: f64, done: u64, what: &str| {
        let done = done as f64;
        assert!(
            within * said >= done * (1.0 - 1e-12) && said <= within * done * (1.0 + 1e-12),
            "{}: {said} {what}, {done}",
            integrator.id()
        );
    };
    near(said.sweeps(), done.work.sweeps, "sweeps");
    near(
        said.solves_per_step * said.steps as f64,
        done.work.solves,
        "solutions",
    );
    assert_eq!(said.steps, done.steps);
}

#[test]
fn sweeps_and_solutions_of_a_run_are_foretold() {
    for id in [
        "central-difference",
        "rk4",
        "cnn-stabilised",
        "newmark",
        "generalized-alpha",
        "propagator",
    ] {
        assert_foretold(&cube(id), 1.5);
    }
}

/// Products for checks of the stiffness, and substeps at the contact of the ball with the tissue, are known because a
/// run of a second is observed with all its steps.
#[test]
fn steps_that_follow_the_stiffness_are_foretold_to_the_sweep() {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/ready/press.toml");
    for values in [
        ["mesh.cube.cells=5", "run.duration=1.0"],
        ["mesh.cube.cells=6", "run.duration=0.3"],
        ["mesh.cube.cells=3", "run.duration=0.1"],
    ] {
        let scene = Scene::load_with(&scene, &values).unwrap();
        assert_foretold(&scene.build().unwrap(), 1.0);
    }
}

#[test]
fn a_short_run_is_not_looked_at_closer() {
    let simulation = cube("central-difference");
    let mut integrator = simulation.integrator().unwrap();
    let said = Forecast::of_long_run(&simulation, &mut *integrator, 1e6).unwrap();
    assert_eq!(said, None);
    let said = Forecast::of_long_run(&simulation, &mut *integrator, 0.0).unwrap();
    assert_eq!(said.unwrap().steps, 150);
}
