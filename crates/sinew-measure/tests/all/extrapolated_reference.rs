//! References of bodies that follow a force law.

use std::path::Path;

use sinew_core::Options;
use sinew_measure::{Case, Effort, MethodChoice, Row, RowOutcome, measure};
use sinew_scene::{Scene, SceneSource};

fn case(name: &str, values: &[&str]) -> Case {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/nonlinear");
    let scene = Scene::load_with(scenes.join(name), values).unwrap();
    Case::new("case", scene.build().unwrap()).unwrap()
}

/// The displacement along z of the scene's first probe, at an instant.
fn probed(case: &Case, instant: usize) -> f64 {
    let probe = &case.simulation().probes()[0];
    let dof = probe.nodes[0].dofs[2].unwrap();
    case.samples().displacements[instant][dof]
}

/// Digits of another program, extrapolated from finer steps of central difference.
#[test]
fn a_push_goes_where_another_program_sees_it() {
    let case = case("push.toml", &[]);
    for (instant, expected) in [
        (10, -0.008_181),
        (20, -0.026_137),
        (30, -0.020_415),
        (50, -0.022_173),
    ] {
        let found = probed(&case, instant);
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    }
    assert!(case.samples().error < 1e-6, "{}", case.samples().error);
}

/// The motion is followed over .1 s with a separate step; a longer run would take a minute.
#[test]
fn a_release_swings_as_another_program_sees_it() {
    let case = case("release.toml", &["run.duration=0.1", "run.samples=10"]);
    for (instant, expected) in [(5, 0.007_115), (10, -0.046_017)] {
        let found = probed(&case, instant);
        assert!((found - expected).abs() < 2e-6, "{found} {expected}");
    }
}

fn row(case: &mut Case, id: &str, dt: f64) -> Row {
    measure(case, &MethodChoice::new(id), dt, Effort::UNTIMED).unwrap()
}

#[test]
fn a_refused_step_is_the_end_of_a_row_with_its_reason() {
    let mut case = case("push.toml", &["run.duration=0.1", "run.samples=10"]);
    let sound = row(&mut case, "central-difference", 1e-3);
    assert_eq!(sound.outcome, RowOutcome::Finished);
    assert!(sound.error.unwrap() < 1e-4, "{:?}", sound.error);
    let least = sound.smallest_volume_ratio.unwrap();
    assert!(least > 0.5 && least < 1.0, "{least}");
    // Damping takes energy away, and leapfrog's ripples.
    assert!(sound.energy_rise.unwrap() < 1e-3, "{:?}", sound.energy_rise);

    let refused = row(&mut case, "forward-euler", 1e-2);
    assert_eq!(refused.outcome, RowOutcome::Refused);
    let reason = refused.refusal.as_ref().unwrap();
    assert!(reason.contains("neo-hookean"), "{reason}");
    assert_eq!(refused.error, None);
    assert!(
        refused.steps < 10 && refused.gaps().is_empty(),
        "{refused:?}"
    );
}

/// The relative L2 error of a case's reference against Runge and Kutta's method in steps of `dt` (s), and the error that it states.
fn true_and_stated(text: &str, dt: f64) -> [f64; 2] {
    let scene = Scene::parse(SceneSource::new("cube.toml", text)).unwrap();
    let case = Case::new("case", scene.build().unwrap()).unwrap();
    let simulation = case.simulation();
    let mut rk4 = sinew_integrators::build("rk4", &Options::new()).unwrap();
    let mut state = simulation.initial_state().clone();
    let (mut apart, mut size) = (0.0, 0.0);
    for (time, found) in case
        .samples()
        .times
        .iter()
        .zip(&case.samples().displacements)
    {
        while state.t() < time - 0.5 * dt {
            rk4.step(simulation.system(), &mut state, dt).unwrap();
        }
        for (u, found) in state.u.iter().zip(found) {
            apart += (u - found).powi(2);
            size += u.powi(2);
        }
    }
    [(apart / size).sqrt(), case.samples().error]
}

/// Instants at equal distances are rounded, which must not cause steps of other lengths, and the check has its own
/// errors.
#[test]
fn stiffness_damping_leaves_the_error_of_a_reference_what_it_states() {
    let cube = |cells: usize, more: &str, law: &str, duration: f64| {
        format!(
            "[mesh]\ncube = {{ cells = {cells}, edge = 0.1, split = \"kuhn\" }}\n[[region]]\ndensity = 1000.0\nyoungs_modulus = 5000.0\n\
             poissons_ratio = 0.3\n{law}\n[[fixed]]\ngroup = \"bottom\"\n{more}\n[run]\nduration = {duration}\nintegrator = \"newmark\"\n\
             dt = 0.01\n"
        )
    };
    let sides = "[[load]]\nwhere = { above = { x = 0.0999 } }\npressure = 500.0\n[damping]\nmass = 3.0\nstiffness = 0.0005";
    let drawn = "[[load]]\ngroup = \"top\"\nforce = [0.0, 0.7, 2.0]\nramp = { kind = \"sin2\", rise = 0.07 }\n[damping]\nstiffness = 0.002";
    let edges = "model = \"neo-hookean\"\nelement = \"fbar-edge\"";
    for text in [
        cube(2, sides, edges, 0.5),
        cube(2, drawn, "model = \"stable-neo-hookean\"", 0.3),
    ] {
        let [error, stated] = true_and_stated(&text, 5e-4);
        println!("{error:e} {stated:e}");
        assert!(error < stated && stated < 1e-4, "{error:e} {stated:e}");
    }
}
