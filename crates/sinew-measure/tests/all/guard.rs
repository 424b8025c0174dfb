//! The guard on the repository's scenes: it does not act on a sound run, and bounds and reports a run whose step is too
//! long.

use std::path::PathBuf;

use sinew_core::{OptionValue, Options, Outcome, simulate};
use sinew_measure::{Case, Effort, MethodChoice, Row, measure};
use sinew_scene::{Scene, Simulation};

const SCENES: [&str; 3] = ["paper-cube", "peers-cube", "paper-oscillator"];

fn scene(name: &str) -> PathBuf {
    let scenes = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    scenes.join(name).with_extension("toml")
}

fn with_word(options: Options, key: &str, word: &str) -> Options {
    options.with(key, OptionValue::Text(word.into()))
}

/// The scene's run by central difference: the number of saturated components, and every displacement and velocity of
/// the motion.
fn run(simulation: &Simulation, options: &Options) -> (u64, Vec<u64>) {
    let mut integrator = sinew_integrators::build("central-difference", options).unwrap();
    let mut state = simulation.initial_state().clone();
    let mut bits = Vec::new();
    let mut recorder = |moment: &sinew_core::Moment<'_>| {
        let state = moment.state;
        let values = state.u.iter().chain(&state.v);
        bits.extend(values.map(|value| value.to_bits()));
        Ok(sinew_core::Verdict::Continue)
    };
    let report = simulate(
        simulation.system(),
        &mut *integrator,
        &mut state,
        &simulation.run(),
        &mut recorder,
    );
    let report = report.unwrap();
    assert_eq!(report.outcome, Outcome::Finished);
    (report.work.saturated, bits)
}

#[test]
fn a_sound_run_is_the_same_to_the_bit() {
    for name in SCENES {
        let simulation = Scene::load(scene(name)).unwrap().build().unwrap();
        let parts = with_word(Options::new(), "substeps", "auto");
        let (saturated, guarded) =
            run(&simulation, &with_word(parts.clone(), "saturation", "auto"));
        assert_eq!(saturated, 0, "{name}");
        let (_, free) = run(&simulation, &parts);
        assert!(guarded == free, "{name}");
    }
}

fn row(case: &mut Case, integrator: &str, saturation: &str, dt: f64) -> Row {
    let method = MethodChoice {
        integrator: integrator.into(),
        options: with_word(Options::new(), "saturation", saturation),
    };
    measure(case, &method, dt, Effort::QUICK).unwrap()
}

/// A step that is divided down to the method's stable one is as good as any stable run.
#[test]
fn on_the_papers_cube_a_step_too_long_is_cut_and_said_so() {
    let mut case = Case::load(&scene("paper-cube")).unwrap();
    let critical = case.critical_step().unwrap();
    for dt in [0.02, 5.0 * critical] {
        for integrator in [
            "forward-euler",
            "symplectic-euler",
            "central-difference",
            "rk4",
            "modified-leapfrog",
            "cnn",
            "cnn-symplectic",
        ] {
            let free = row(&mut case, integrator, "off", dt);
            assert!(!free.bounded, "{integrator} at {dt}");
            let row = row(&mut case, integrator, "auto", dt);
            assert!(row.bounded, "{integrator} at {dt}: {:?}", row.max_u);
            assert!(row.facts["guard_substeps"] > 1.0, "{integrator} at {dt}");
            assert!(!row.guarded, "{integrator} at {dt}");
            let error = row.error.unwrap();
            assert!(error < 0.02, "{integrator} at {dt}: {error}");
        }
    }
}
