//! Factors of loads and motions over time: sines, jumps, and files.

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

use sinew_core::{LoadTime, State};
use sinew_scene::{Scene, Simulation};

use crate::common::{build, numbers, run};

/// A block without supports, under a traction with this ramp.
fn free(law: &str, ramp: &str, method: &str, dt: f64) -> String {
    format!(
        "[mesh]\nblock = {{ cells = [1, 1, 2], size = [0.02, 0.02, 0.04] }}\n[[region]]\ndensity = 1000.0\nmodel = \"{law}\"\n\
         youngs_modulus = 3000.0\npoissons_ratio = 0.3\n[[load]]\ngroup = \"top\"\ntraction = [0.0, 0.0, 25.0]\nramp = {ramp}\n\
         [[probe]]\nname = \"top\"\nwhere = {{ above = {{ z = 0.04 }} }}\n\
         [run]\nduration = 0.02\nintegrator = \"{method}\"\ndt = {dt}\n"
    )
}

/// The momentum (N s) along z.
fn momentum(simulation: &Simulation, state: &State) -> f64 {
    let system = simulation.system();
    let mut v = vec![0.0; system.dofs()];
    state
        .velocity_at_t(system, sinew_core::Inputs::none(), &mut v)
        .unwrap();
    let along = system.mass().iter().zip(&v).skip(2).step_by(3);
    along.map(|(mass, v)| mass * v).sum()
}

/// Newton's second law: the momentum is the impulse, for any end of the load within a step.
#[test]
fn a_load_that_ends_abruptly_leaves_its_impulse() {
    let folder = tempfile::tempdir().unwrap();
    let force = 25.0 * 4e-4;
    let mut methods = vec!["central-difference", "symplectic-euler", "rk4"];
    if cfg!(feature = "implicit") {
        methods.extend(["newmark", "implicit-euler", "generalized-alpha"]);
    }
    for end in [0.01, 0.01032] {
        let ramp =
            format!("{{ kind = \"table\", times = [0.0, {end}, {end}], values = [1, 1, 0] }}");
        for law in ["linear", "neo-hookean"] {
            for method in &methods {
                let simulation = build(&free(law, &ramp, method, 0.0005));
                let (state, _) = run(&simulation, folder.path());
                let found = momentum(&simulation, &state);
                let off = (found / (force * end) - 1.0).abs();
                assert!(off < 1e-6, "{method}, {law}, until {end} s: {off:e}");
            }
        }
    }
}

/// The scene in a file, next to the files that it names.
fn load(folder: &Path, text: &str) -> Scene {
    let path = folder.join("scene.toml");
    fs::write(&path, text).unwrap();
    Scene::load(path).unwrap()
}

#[test]
fn factors_in_a_file_do_what_the_same_table_does() {
    let folder = tempfile::tempdir().unwrap();
    let rows = "t_s,factor\n0,0\n0.004,1\n0.01,1\n0.01,-0.5\n";
    fs::write(folder.path().join("load.csv"), rows).unwrap();
    let inline = "{ kind = \"table\", times = [0, 0.004, 0.01, 0.01], values = [0, 1, 1, -0.5] }";
    let held = "[[move]]\nwhere = { below = { z = 0.0 } }\naxes = \"z\"\ndisplacement = [0.0, 0.0, 0.001]\n";
    let motion = |ramp: &str| format!("{held}ramp = {ramp}\n[run]");
    let text = |ramp: &str| {
        let text = free("linear", ramp, "central-difference", 0.0005);
        text.replace("[run]", &motion(ramp))
    };
    let from_file = load(folder.path(), &text("{ table = \"load.csv\" }"));
    let path = folder.path().join("load.csv");
    assert_eq!(from_file.input_files()[1..], [path.clone(), path.clone()]);
    let found = Scene::input_files_of(&folder.path().join("scene.toml"));
    assert_eq!(found[1..], [path.clone(), path]);
    let from_file = from_file.build().unwrap();
    let given = build(&text(inline));
    let [found, expected] = [&from_file, &given].map(|simulation| run(simulation, folder.path()));
    assert_eq!((&found.0.u, &found.1), (&expected.0.u, &expected.1));
    assert!(found.0.u.iter().any(|u| *u != 0.0));
    // What drives the loads of a session are these factors too.
    let of_system = |simulation: &Simulation| -> Vec<f64> {
        let mut force = vec![0.0; simulation.system().dofs()];
        let system = simulation.system();
        system.external_force(LoadTime::at(0.012), &[], &mut force);
        force
    };
    assert_eq!(of_system(&from_file), of_system(&given));
}

#[test]
fn a_part_swings_as_its_sine_says() {
    let folder = tempfile::tempdir().unwrap();
    for (keys, phase) in [
        ("frequency = 40.0", 0.0),
        ("frequency = 40.0, phase = -0.3", -0.3),
    ] {
        let text = free(
            "neo-hookean",
            "{ kind = \"step\" }",
            "central-difference",
            0.0005,
        );
        let moved = format!(
            "[[move]]\ngroup = \"top\"\ndisplacement = [0.0, 0.002, 0.0]\nramp = {{ sine = {{ {keys} }} }}\n[run]"
        );
        let simulation = build(&text.replace("[run]", &moved));
        let (_, rows) = run(&simulation, folder.path());
        for row in rows.lines().skip(1).map(numbers) {
            let expected = 0.002 * (TAU * 40.0 * row[0] + phase).sin();
            assert!((row[2] - expected).abs() < 1e-14, "{row:?}");
        }
        let jumps = simulation
            .warnings()
            .iter()
            .any(|warning| warning.kind == sinew_scene::WarningKind::MotionJumps);
        assert_eq!(jumps, phase != 0.0);
    }
}

#[test]
fn a_sine_that_four_steps_do_not_follow_is_named_with_a_step_that_does() {
    let sine = |law: &str, dt: f64| {
        let text = free(
            law,
            "{ sine = { frequency = 400.0 } }",
            "central-difference",
            dt,
        );
        let simulation = build(&text);
        simulation.unresolved_load().map(|load| load.to_string())
    };
    for law in ["linear", "neo-hookean"] {
        assert_eq!(
            sine(law, 0.001).unwrap(),
            "[[load]] 1 on `top` swings with a period of 2.500e-3 s, of which dt = 0.001 s is more than a quarter: its \
             impulse arrives, but its course is not followed; dt = 6.250e-4 s would follow it"
        );
        assert_eq!(sine(law, 6.25e-4), None);
    }
    // Nor is a jump of a table two changes.
    let table = "{ kind = \"table\", times = [0.0, 0.01, 0.01], values = [1, 1, 0] }";
    assert_eq!(
        build(&free("linear", table, "central-difference", 0.0005)).unresolved_load(),
        None
    );
}
