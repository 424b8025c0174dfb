//! Runs of bodies with moved parts, compared with textbook motions and exact ones.

use std::f64::consts::PI;

use crate::common::tissue::{DENSITY, body, held, linear};
use crate::common::{advance, build, largest, plain, relative_error};
use sinew_core::{LinearSystem, Ramp, State, System};
use sinew_fem::{
    Course, Law, LoadKind, LoadSpec, Model, Moving, On, Problem, Rayleigh, SpringRule,
};
use sinew_integrators::static_solution;
use sinew_mesh::structured::{self, Split};

const YOUNGS_MODULUS: f64 = 3500.0;
const SIZE: [f64; 3] = [0.03, 0.04, 0.1];

/// A motion over a rise of this length (s).
fn moved(on: impl Into<On>, axes: [bool; 3], displacement: [f64; 3], rise: f64) -> Moving {
    let ramp = Ramp::Sin2 { rise };
    Moving::new(on, [Course::new(displacement, ramp)]).along(axes)
}

/// A bar fixed at its bottom, 3 x 4 x 5 hexahedra.
fn bar(problem: &Problem) -> Model {
    let mesh = structured::block([3, 4, 5], SIZE, Split::Kuhn).unwrap();
    Model::build(&mesh, problem).unwrap()
}

/// A bar that is fixed laterally along its whole length and pulled at one end vibrates about its new length at c/(2 L):
/// Rayleigh, The Theory of Sound, section 150, both ends being given.
#[test]
fn a_pulled_bar_swings_at_its_first_axial_frequency() {
    let length = 0.1;
    let mesh = structured::block([1, 1, 20], [0.005, 0.005, length], Split::Mirrored).unwrap();
    let along = [false, false, true];
    let problem = Problem {
        fixed: vec![held("bottom", along), held("tissue", [true, true, false])],
        moves: vec![moved("top", along, [0.0, 0.0, 1e-3], 0.02)],
        ..body(linear(YOUNGS_MODULUS, 0.0))
    };
    let model = Model::build(&mesh, &problem).unwrap();
    let expected = (YOUNGS_MODULUS / DENSITY).sqrt() / (2.0 * length);
    let heights = model
        .nodes()
        .iter()
        .map(|node| mesh.points[*node as usize][2]);
    let shape = heights.flat_map(|z| [0.0, 0.0, (PI * z / length).sin()]);
    let weights: Vec<f64> = shape.zip(model.mass()).map(|(s, m)| s * m).collect();
    let part = |u: &[f64]| -> f64 { weights.iter().zip(u).map(|(weight, u)| weight * u).sum() };
    let mut pull = vec![0.0; model.dofs()];
    model.operators().external_force(1.0, &mut pull);
    let rest = part(&static_solution(&model, &pull).unwrap());
    let mut integrator = build("propagator", &plain());
    let mut state = State::at_rest(model.dofs());
    let dt = 1e-3;
    let mut crossings = Vec::new();
    let mut before = None;
    while crossings.len() < 41 {
        integrator.step(&model, &mut state, dt).unwrap();
        if state.t() < 0.0205 {
            continue;
        }
        let q = part(&state.u) - rest;
        if let Some(last) = before.replace(q)
            && last * q < 0.0
        {
            crossings.push(state.t() - dt * q / (q - last));
        }
    }
    let frequency = 20.0 / (crossings[40] - crossings[0]);
    assert!(
        (frequency / expected - 1.0).abs() <= 5e-3,
        "{frequency} Hz of {expected} Hz"
    );
}

/// A body whose whole surface moves rigidly moves with it, undeformed.
#[test]
fn a_body_moved_at_its_whole_outside_stays_as_it_is() {
    let edge = 0.1;
    let mut mesh = structured::cube(4, edge, Split::Kuhn).unwrap();
    let inside = |point: &[f64; 3]| point.iter().all(|x| 0.0 < *x && *x < edge);
    let (inner, outside): (Vec<u32>, Vec<u32>) =
        (0..mesh.points.len() as u32).partition(|node| inside(&mesh.points[*node as usize]));
    // No regular mesh.
    for node in inner {
        for (axis, x) in mesh.points[node as usize].iter_mut().enumerate() {
            *x += 0.005 * f64::from(3 * node + axis as u32).sin();
        }
    }
    assert!(mesh.signed_volumes().iter().all(|volume| *volume > 0.0));
    let d = [0.3, -0.2, 0.5];
    let springs = Law::Springs {
        youngs_modulus: YOUNGS_MODULUS,
        rule: SpringRule::Lloyd,
        calibrate: true,
        damping_ratio: 0.0,
    };
    for law in [linear(YOUNGS_MODULUS, 0.45), springs] {
        let problem = Problem {
            moves: vec![moved(On::Nodes(outside.clone()), [true; 3], d, 0.2)],
            damping: Rayleigh::new(60.0, 0.02),
            ..body(law)
        };
        let model = Model::build(&mesh, &problem).unwrap();
        let mut state = State::at_rest(model.dofs());
        advance(
            &mut *build("implicit-euler", &plain()),
            &model,
            &mut state,
            400,
            0.01,
        );
        let t = state.t();
        let mut strain = vec![[0.0; 6]; mesh.tets.len()];
        model.strain(t, &state.u, &mut strain).unwrap();
        let strain = largest(strain.as_flattened());
        assert!(strain <= 1e-12, "{strain:e}");
        let mut positions = vec![[0.0; 3]; mesh.points.len()];
        model.positions(t, &state.u, &mut positions).unwrap();
        for (at, point) in positions.iter().zip(&mesh.points) {
            for axis in 0..3 {
                assert!((at[axis] - point[axis] - d[axis]).abs() < 1e-13, "{at:?}");
            }
        }
        assert_eq!(model.inverted_elements(t.into(), &state.u), Some(0));
        let mut forces = vec![[0.0; 3]; mesh.points.len()];
        model.reactions(t, &state.u, &state.v, &mut forces).unwrap();
        let force = largest(forces.as_flattened());
        assert!(force <= 1e-10, "{force:e} N");
    }
}

/// Two methods of which one is exact: the other's error falls as dt^2, kinks of the table on steps.
#[test]
fn newmark_nears_the_propagator_along_a_table() {
    let positions = [
        [0.0; 3],
        [0.0, 1e-3, 4e-3],
        [1e-3, 1e-3, 2e-3],
        [0.0, 0.0, 5e-3],
    ];
    let load = |group: &str, kind| LoadSpec::new(group, kind);
    let model = bar(&Problem {
        fixed: vec![held("bottom", [true; 3])],
        moves: vec![Moving::new(
            "top",
            Course::along(&[0.04, 0.1, 0.12, 0.3], &positions),
        )],
        loads: vec![
            load("sides", LoadKind::Pressure(30.0)),
            load("tissue", LoadKind::Force([0.1, 0.0, -0.2])),
        ],
        gravity: Some([0.0, 1.0, -9.81]),
        damping: Rayleigh::new(2.0, 1e-3),
        ..body(linear(YOUNGS_MODULUS, 0.3))
    });
    let end = |id: &str, dt: f64| {
        let mut state = State::at_rest(model.dofs());
        let steps = (0.4 / dt).round() as usize;
        advance(&mut *build(id, &plain()), &model, &mut state, steps, dt);
        [state.u]
    };
    let exact = end("propagator", 0.02);
    let off = |id: &str, dt: f64| relative_error(&end(id, dt), &exact);
    let steps = off("propagator", 0.01);
    assert!(steps <= 1e-9, "{steps:e}");
    let [coarse, fine] = [1e-3, 2.5e-4].map(|dt| off("newmark", dt));
    assert!(fine <= 1e-3, "{fine:e}");
    let order = (coarse / fine).log2() / 2.0;
    assert!((order - 2.0).abs() < 0.15, "{order}: {coarse} {fine}");
}
