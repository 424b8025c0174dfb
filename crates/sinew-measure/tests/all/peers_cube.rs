//! The peers' cube: the scene that other programs were measured on, and what errors cost there. The errors themselves are rows of the
//! verification.

use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use sinew_core::{LinearSystem, OptionValue, Options};
use sinew_measure::{Case, Effort, MethodChoice, measure};
use sinew_scene::Simulation;

fn case() -> &'static Mutex<Case> {
    static CASE: OnceLock<Mutex<Case>> = OnceLock::new();
    CASE.get_or_init(|| {
        let scenes = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
        Mutex::new(Case::load(&scenes.join("peers-cube.toml")).unwrap())
    })
}

/// The case; a test that failed while it held the case has not changed it.
fn locked() -> MutexGuard<'static, Case> {
    case().lock().unwrap_or_else(PoisonError::into_inner)
}

fn with_simulation<T>(look: impl FnOnce(&Simulation, &dyn LinearSystem) -> T) -> T {
    let case = locked();
    let simulation = case.simulation();
    look(simulation, simulation.system().as_linear().unwrap())
}

/// `value` rounds to the figure as it was printed.
fn prints_as(value: f64, figure: &str) {
    let decimals = figure.split_once('.').map_or(0, |(_, after)| after.len());
    assert_eq!(format!("{value:.decimals$}"), figure, "{value}");
}

#[test]
fn the_body_is_that_of_the_figures() {
    with_simulation(|simulation, linear| {
        let body = simulation.model().body().unwrap();
        assert_eq!((body.mesh.points.len(), body.mesh.tets.len()), (1331, 6000));
        assert_eq!(linear.dofs(), 3 * 891);
        let damping = linear.operators().damping();
        assert!(damping.mass == 0.0 && damping.stiffness == 0.0 && damping.extra.is_none());
    });
}

#[test]
fn the_force_is_shared_equally_by_the_81_nodes_of_the_top_that_move() {
    with_simulation(|simulation, linear| {
        let body = simulation.model().body().unwrap();
        let height = |dof: usize| body.mesh.points[body.model.nodes()[dof / 3] as usize][2];
        let mut force = vec![0.0; linear.dofs()];
        linear
            .operators()
            .external_force(sinew_core::LoadTime::at(0.0), &mut force);
        let loaded: Vec<usize> = (0..force.len()).filter(|i| force[*i] != 0.0).collect();
        assert_eq!(loaded.len(), 81);
        assert!(loaded.iter().all(|&i| (height(i) - 0.1).abs() < 1e-12));
        let share = -0.042135 / 81.0;
        assert!(
            loaded
                .iter()
                .all(|&i| i % 3 == 2 && (force[i] / share - 1.0).abs() < 1e-12)
        );
    });
}

#[test]
fn errors_are_taken_at_every_10_ms_and_rest_at_0_adds_nothing() {
    let case = locked();
    let track = case.samples();
    assert_eq!(track.times.len(), 101);
    for (j, time) in track.times.iter().enumerate() {
        assert!((time - 0.01 * j as f64).abs() < 1e-12);
    }
    assert!(track.displacements[0].iter().all(|u| *u == 0.0));
    assert!(track.error < 1e-12);
}

#[test]
fn the_peak_is_a_tenth_of_a_millimetre() {
    let case = locked();
    prints_as(1e3 * case.samples().max_u, "0.10");
}

#[test]
fn the_critical_step_of_central_difference() {
    let case = locked();
    prints_as(1e3 * case.critical_step().unwrap(), "2.0208");
}

/// The marks in work: a sweep of ours is to cost a fifth of a product of scipy's, whose
/// central difference takes 1000 of them. An error of .1 % at a third of its cost, 1e-6 at its cost.
#[test]
fn errors_for_the_sweeps_that_the_marks_allow() {
    let text = |text: &str| OptionValue::Text(text.into());
    let mut case = locked();
    for (tolerance, error, share_of_scipy) in [(1e-3, 1e-3, 1.0 / 3.0), (1e-8, 1e-6, 1.0)] {
        let mut method = MethodChoice::new("propagator");
        method.options = Options::new()
            .with("kind", text("two-step"))
            .with_number("tolerance", tolerance);
        let row = measure(&mut case, &method, 0.01, Effort::QUICK).unwrap();
        let found = (row.error.unwrap(), row.sweeps_per_s * 0.2 / 1000.0);
        println!(
            "{tolerance:e}: error {:.2e} at {:.2} of scipy",
            found.0, found.1
        );
        assert!(found.0 <= error && found.1 <= share_of_scipy, "{found:?}");
    }
}

/// The mark in sweeps: .6 % for 720 a second. The estimate, which is over eight periods of the load's mean frequency,
/// is near the error of the whole second.
#[test]
fn a_fit_to_the_load_takes_720_sweeps_for_an_error_of_six_per_mille() {
    let text = |text: &str| OptionValue::Text(text.into());
    let fitted = Options::new()
        .with("kind", text("two-step"))
        .with("fit", text("load"));
    let mut case = locked();
    for (options, error, sweeps) in [
        (fitted.clone(), 6e-3, 720.0),
        (fitted.clone().with_number("tolerance", 6e-3), 6e-3, 720.0),
        (fitted.clone().with_number("tolerance", 1e-3), 1e-3, 820.0),
        (fitted.with_number("tolerance", 2e-6), 4e-6, 1020.0),
    ] {
        let mut method = MethodChoice::new("propagator");
        method.options = options;
        let row = measure(&mut case, &method, 0.01, Effort::QUICK).unwrap();
        let (found, estimate) = (row.error.unwrap(), row.facts["estimated_error"]);
        println!(
            "{}: {found:.2e}, {} sweeps/s",
            method.label(),
            row.sweeps_per_s
        );
        assert!(found <= error && row.sweeps_per_s <= sweeps, "{row:?}");
        assert!(
            found <= 2.0 * estimate && estimate <= 2.0 * found,
            "{found} {estimate}"
        );
    }
}
