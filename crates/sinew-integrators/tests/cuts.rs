//! Motion over cuts: every method goes on, energy stays, halves are bars of their own.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use std::sync::Arc;

use common::{advance, build};
use sinew_core::{Inputs, LinearSystem, Options, State, System, VelocityTime};
use sinew_cutting::Sheet;
use sinew_fem::{
    CutModel, Element, Fixed, FromMesh, Law, Model, Problem, Rayleigh, Region, Tissue,
};
use sinew_mesh::structured::{self, Split};

fn problem(poissons_ratio: f64) -> Problem {
    Problem {
        regions: vec![Region {
            group: None,
            density: 1060.0,
            law: Law::Linear {
                youngs_modulus: 3500.0,
                poissons_ratio,
            },
            element: Element::P1,
            tissue: Tissue::default(),
            from_mesh: FromMesh::default(),
        }],
        fixed: vec![Fixed {
            on: "bottom".into(),
            axes: [true; 3],
        }],
        ..Problem::default()
    }
}

fn cube(cells: usize) -> CutModel {
    let mesh = structured::cube(cells, 0.1, Split::Kuhn).unwrap();
    CutModel::new(Arc::new(mesh), problem(0.45), 0.0).unwrap()
}

/// A blade along y comes down in the middle to a height.
fn slit(cut: &mut CutModel, state: &mut State, height: f64) -> usize {
    let blade = |z: f64| [[0.05, -0.05, z], [0.05, 0.15, z]];
    let sheet = Sheet::swept(blade(0.2), blade(height)).unwrap();
    cut.stroke(&sheet, state, Inputs::none()).unwrap().new_nodes
}

/// A bend of the whole body, at rest.
fn bent(model: &Model) -> State {
    let bend = |p: &[f64; 3]| [2.0 * p[2] * p[2], 0.0, -0.5 * p[0] * p[2]];
    let field: Vec<[f64; 3]> = model.mesh().points.iter().map(bend).collect();
    let mut state = State::at_rest(model.dofs());
    model.to_dofs(&field, &mut state.u).unwrap();
    state
}

#[test]
fn an_integrator_goes_on_after_a_cut_as_a_fresh_one_to_the_last_bit() {
    // Modal motion would need all modes of this bend.
    for id in sinew_integrators::ids()
        .into_iter()
        .filter(|id| *id != "modal")
    {
        let mut cut = cube(4);
        let mut state = bent(cut.model());
        let dt = 2e-4;
        let mut kept = build(id, &Options::new());
        advance(&mut *kept, cut.model(), &mut state, 5, dt);
        assert!(slit(&mut cut, &mut state, 0.04) > 0, "`{id}`");
        assert_eq!(state.u.len(), cut.model().dofs());
        let mut fresh_state = state.clone();
        let mut fresh = build(id, &Options::new());
        advance(&mut *kept, cut.model(), &mut state, 5, dt);
        advance(&mut *fresh, cut.model(), &mut fresh_state, 5, dt);
        assert_eq!(state, fresh_state, "`{id}`");
        assert!(state.u.iter().all(|u| u.abs() < 1.0), "`{id}`");
    }
}

/// The energy that leapfrog keeps between its instants: `v' (M - dt^2/4 K) v / 2 + m' K m / 2`, m being the mean of two displacements.
fn staggered_energy(model: &Model, state: &State, dt: f64) -> f64 {
    assert_eq!(state.velocity, VelocityTime::MiddleOfStep);
    let middle: Vec<f64> = state
        .u
        .iter()
        .zip(&state.v)
        .map(|(u, v)| u - dt / 2.0 * v)
        .collect();
    let elastic = |x: &[f64]| model.operators().energy(x, x).elastic;
    let kinetic = model.operators().energy(&state.u, &state.v).kinetic;
    kinetic - dt * dt / 4.0 * elastic(&state.v) + elastic(&middle)
}

#[test]
fn leapfrog_at_its_bound_keeps_its_energy_over_cuts() {
    let mut cut = cube(5);
    let bounds = cut.model().operators().element_bounds().unwrap();
    let dt = 0.95 * 2.0 / bounds.omega_max;
    let mut state = bent(cut.model());
    let mut method = build("central-difference", &Options::new());
    advance(&mut *method, cut.model(), &mut state, 1, dt);
    let first = staggered_energy(cut.model(), &state, dt);
    for height in [0.081, 0.061, 0.041, -0.01] {
        advance(&mut *method, cut.model(), &mut state, 200, dt);
        let before = staggered_energy(cut.model(), &state, dt);
        assert!(slit(&mut cut, &mut state, height) > 0);
        let after = staggered_energy(cut.model(), &state, dt);
        assert!((after / before - 1.0).abs() < 1e-13);
    }
    assert_eq!(cut.body().pieces().count, 2);
    advance(&mut *method, cut.model(), &mut state, 2000, dt);
    let last = staggered_energy(cut.model(), &state, dt);
    assert!((last / first - 1.0).abs() < 1e-10, "{first} {last}");
}

#[cfg(feature = "implicit")]
#[test]
fn the_mean_acceleration_method_keeps_its_energy_over_a_cut() {
    let mut cut = cube(4);
    let mut state = bent(cut.model());
    let mut method = build("newmark", &Options::new());
    let energy =
        |cut: &CutModel, state: &State| cut.model().energy(&state.u, &state.v).unwrap().total();
    let first = energy(&cut, &state);
    advance(&mut *method, cut.model(), &mut state, 20, 0.005);
    slit(&mut cut, &mut state, 0.04);
    advance(&mut *method, cut.model(), &mut state, 200, 0.005);
    let last = energy(&cut, &state);
    assert!((last / first - 1.0).abs() < 1e-10, "{first} {last}");
}

#[test]
fn the_stabilised_network_at_twenty_milliseconds_loses_energy_and_never_gains_it() {
    let mut cut = cube(5);
    let mut state = bent(cut.model());
    let mut method = build("cnn-stabilised", &Options::new());
    let dt = 0.02;
    let peak = |state: &State| state.u.iter().fold(0.0_f64, |peak, u| peak.max(u.abs()));
    let first = peak(&state);
    for height in [0.061, 0.021, -0.01] {
        advance(&mut *method, cut.model(), &mut state, 100, dt);
        slit(&mut cut, &mut state, height);
    }
    let mut largest = 0.0_f64;
    for _ in 0..500 {
        advance(&mut *method, cut.model(), &mut state, 1, dt);
        largest = largest.max(peak(&state));
    }
    assert!(largest < 2.0 * first, "{largest} {first}");
}

#[test]
fn each_half_of_a_bar_that_is_cut_through_is_a_bar_of_its_own() {
    let bar = |layers: usize| {
        let mesh = structured::block(
            [1, 1, layers],
            [0.02, 0.02, 0.02 * layers as f64],
            Split::Kuhn,
        );
        let mut problem = problem(0.0);
        problem.damping = Rayleigh {
            mass: 6.0,
            stiffness: 0.0,
        };
        CutModel::new(Arc::new(mesh.unwrap()), problem, 0.0).unwrap()
    };
    let stretched = |model: &Model| {
        let mut state = State::at_rest(model.dofs());
        let field: Vec<[f64; 3]> = model
            .mesh()
            .points
            .iter()
            .map(|p| [0.0, 0.0, 0.1 * p[2]])
            .collect();
        model.to_dofs(&field, &mut state.u).unwrap();
        state
    };
    let (mut whole, half) = (bar(20), bar(10));
    let (mut state, mut alone) = (stretched(whole.model()), stretched(half.model()));
    let blade = |x: f64| [[x, -0.01, 0.2], [x, 0.03, 0.2]];
    // The body is stretched: the plane of nodes at 0.2 m is at 0.22 m now.
    let lifted = |pose: [[f64; 3]; 2]| pose.map(|[x, y, z]| [x, y, 1.1 * z]);
    let across = Sheet::swept(lifted(blade(-0.01)), lifted(blade(0.03))).unwrap();
    let report = whole.stroke(&across, &mut state, Inputs::none()).unwrap();
    assert_eq!((report.faces, report.new_nodes), (2, 4));

    // One step each: both bounds are the same, so are the bits.
    let dt = 1e-3;
    let (mut of_whole, mut of_half) = (
        build("central-difference", &Options::new()),
        build("central-difference", &Options::new()),
    );
    for _ in 0..60 {
        advance(&mut *of_whole, whole.model(), &mut state, 10, dt);
        advance(&mut *of_half, half.model(), &mut alone, 10, dt);
        let lower = &state.u[..4 * 3 * 10];
        let apart = lower.iter().zip(&alone.u).map(|(a, b)| (a - b).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-13);
    }
    advance(&mut *of_whole, whole.model(), &mut state, 12_000, dt);
    // The free one has its natural length wherever it went: its copies, which come last, are its lower end.
    let mut field = vec![[0.0; 3]; whole.model().mesh().points.len()];
    whole.model().to_nodes(&state.u, &mut field).unwrap();
    let end = |nodes: &[[f64; 3]]| nodes.iter().map(|u| u[2]).sum::<f64>() / 4.0;
    assert!((end(&field[80..84]) - end(&field[84..])).abs() < 1e-10);
    assert_eq!(whole.body().pieces().count, 2);
}
