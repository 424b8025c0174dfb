//! `cnn-energy` on hyperelastic tissue.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::energy_method::{energy_method, never_rises};
use common::tissue::{body, held};
use common::{build, plain};
use sinew_core::{Integrator, Ramp, State, System};
use sinew_fem::hyperelastic::{Hyperelastic, Parameters};
use sinew_fem::{Element, Law, LoadKind, LoadSpec, Model, Problem, Rayleigh};
use sinew_mesh::structured::{self, Split};

/// A cube of tissue that is held at the bottom.
fn tissue(id: &'static str, element: Element) -> Model {
    let mesh = structured::cube(2, 0.1, Split::Kuhn).unwrap();
    let parameters = Parameters {
        c1_over_c2: (id == "mooney-rivlin").then_some(4.0),
        ..Parameters::new(3500.0, 0.45)
    };
    let mut problem = body(Law::Hyperelastic { id, parameters });
    problem.regions[0].element = element;
    problem.fixed = vec![held("bottom", [true; 3])];
    Model::build(&mesh, &problem).unwrap()
}

#[test]
fn energy_never_rises_in_any_tissue() {
    let edges = Element::FbarEdge {
        edge_share: 0.9,
        patch: None,
    };
    for id in Hyperelastic::IDS {
        for element in [Element::P1, Element::Fbar { patch: None }, edges] {
            let model = tissue(id, element);
            // Thrown sideways and upwards at about the speed of its shear waves.
            let v: Vec<f64> = (0..model.dofs())
                .map(|dof| [1.0, -0.6, 0.8][dof % 3])
                .collect();
            for (kind, sweeps) in [("trap", 1), ("ie", 2), ("trap", 8)] {
                for dt in [0.02, 0.5] {
                    let start = State::new(vec![0.0; model.dofs()], v.clone());
                    let kept = never_rises(&model, (kind, sweeps), start, dt, 8);
                    assert!(
                        kept.is_ok(),
                        "{id}, {element}, {kind} {sweeps}, {dt} s: {kept:?}"
                    );
                }
            }
        }
    }
}

/// Displacements at 50 instants of half a second.
fn track(model: &Model, integrator: &mut dyn Integrator, dt: f64) -> Vec<Vec<f64>> {
    let mut state = State::at_rest(model.dofs());
    let every = (0.01 / dt).round() as usize;
    let instants = 0..50;
    let track = instants.map(|_| {
        common::advance(integrator, model, &mut state, every, dt);
        state.u.clone()
    });
    track.collect()
}

/// A cube of 0.1 m that 12 N press down by 28 % within .2 s, in steps three times the stable one of explicit methods: the trapezoidal rule
/// follows the motion, with sixteen sweeps four times nearer than with four, and implicit Euler lags behind. The errors are those of an independent
/// implementation.
#[test]
fn a_push_by_long_steps_is_near_that_by_short_ones() {
    let mesh = structured::cube(6, 0.1, Split::Mirrored).unwrap();
    let parameters = Parameters::new(3500.0, 0.45);
    let problem = Problem {
        damping: Rayleigh {
            mass: 10.0,
            stiffness: 0.0,
        },
        fixed: vec![held("bottom", [true; 3])],
        loads: vec![LoadSpec {
            on: "top".into(),
            kind: LoadKind::Traction([0.0, 0.0, -1200.0]),
            ramp: Ramp::Sin2 { rise: 0.2 },
        }],
        ..body(Law::Hyperelastic {
            id: "neo-hookean",
            parameters,
        })
    };
    let model = Model::build(&mesh, &problem).unwrap();
    let exact = track(&model, &mut *build("central-difference", &plain()), 0.5e-3);
    let square = |of: &dyn Fn(usize, usize) -> f64| -> f64 {
        let dofs = (0..model.dofs()).flat_map(|dof| (0..50).map(move |at| (at, dof)));
        dofs.map(|(at, dof)| of(at, dof).powi(2)).sum()
    };
    let size = square(&|at, dof| exact[at][dof]);
    let error = |kind, sweeps| {
        let found = track(&model, &mut *energy_method(kind, sweeps), 0.01);
        (square(&|at, dof| found[at][dof] - exact[at][dof]) / size).sqrt()
    };
    for (kind, sweeps, expected) in [("trap", 4, 0.0178), ("trap", 16, 0.0044), ("ie", 4, 0.0436)] {
        let error = error(kind, sweeps);
        assert!(
            (error / expected - 1.0).abs() < 0.05,
            "{kind} {sweeps}: {error}"
        );
    }
}
