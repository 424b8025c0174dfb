//! References of bodies that follow a force law.

use std::path::Path;

use sinew_measure::{Case, Effort, MethodChoice, Row, RowOutcome, measure};
use sinew_scene::Scene;

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

/// As far as a step of its own, which a longer run would take a minute for.
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
