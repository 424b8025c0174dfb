//! The peers' cube: the scene on which other programs were measured, and the cost of errors there. The errors
//! themselves are rows of the verification.

use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use sinew_core::LinearSystem;
use sinew_measure::Case;
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
