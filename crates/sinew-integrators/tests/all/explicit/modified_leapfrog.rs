//! `modified-leapfrog`: its order and its two sweeps.

use crate::common::cube::{altered, cube, scene, springs};
use crate::common::{advance, build, plain, relative_error};
use sinew_core::spectrum::critical_step;
use sinew_core::{Damping, LinearModel, LinearSystem, StableStep, State, System};
use sinew_fem::{Model, Rayleigh};

fn damped(model: &Model, mass: f64, stiffness: f64) -> LinearModel {
    let damping = Damping {
        mass,
        stiffness,
        ..model.operators().damping().clone()
    };
    altered(model, damping, model.operators().loads().to_vec())
}

fn moving(dofs: usize) -> State {
    let wave = |size: f64, rate: f64| {
        let value = |dof| size * f64::sin(1.0 + rate * f64::from(dof));
        (0..dofs as u32).map(value).collect()
    };
    State::new(wave(1e-3, 7.1), wave(0.1, 3.7))
}

/// The order under the cube's load, over an interval of five critical steps, each divided into `parts` steps.
fn order(system: &LinearModel, start: &State, parts: usize) -> f64 {
    let limit = critical_step(system.operators());
    let states = |id: &str, parts: usize| {
        let (mut integrator, mut state) = (build(id, &plain()), start.clone());
        let dt = limit / parts as f64;
        (0..5)
            .map(|_| {
                advance(&mut *integrator, system, &mut state, parts, dt);
                state.u.clone()
            })
            .collect::<Vec<_>>()
    };
    let reference = states("rk4", 256);
    let error = |parts| relative_error(&states("modified-leapfrog", parts), &reference);
    (error(parts) / error(2 * parts)).log2()
}

#[test]
fn order_4_where_mass_damping_is_small_and_2_where_it_is_not() {
    for (mass, parts, expected) in [(0.0, 4, 4.0), (1e-3, 4, 4.0), (20.0, 16, 2.0)] {
        let system = damped(&cube(3), mass, 0.0);
        for start in [State::at_rest(system.dofs()), moving(system.dofs())] {
            let order = order(&system, &start, parts);
            assert!((order - expected).abs() <= 0.1, "{mass}: {order}");
        }
    }
}

#[test]
fn lagging_damping_costs_the_order_and_no_sweep() {
    let with_dashpots = scene(3, 0.2, springs(0.2), Rayleigh::default());
    for (system, lags) in [
        (damped(&cube(3), 0.0, 0.0), false),
        (damped(&cube(3), 80.0, 0.0), false),
        (damped(&cube(3), 80.0, 1e-3), true),
        (damped(&with_dashpots, 80.0, 0.0), true),
        (damped(&with_dashpots, 80.0, 1e-3), true),
    ] {
        let (mut integrator, mut state) = (build("modified-leapfrog", &plain()), moving(48));
        let first = integrator.step(&system, &mut state, 1e-4).unwrap();
        let second = integrator.step(&system, &mut state, 1e-4).unwrap();
        assert_eq!((first.sweeps, second.sweeps), (3, 2));
        // The first step asks for the rate of loads, too.
        assert_eq!((first.force_evaluations, second.force_evaluations), (2, 1));
        if lags {
            let order = order(&system, &moving(48), 128);
            assert!((order - 1.0).abs() <= 0.1, "{order}");
        }
    }
}

#[test]
fn the_stable_step_is_root_12_over_the_fastest_frequency() {
    let system = damped(&cube(3), 0.0, 0.0);
    let limit = critical_step(system.operators()) / 2.0 * 12.0_f64.sqrt();
    let Ok(StableStep::UpTo(declared)) = build("modified-leapfrog", &plain()).stable_step(&system)
    else {
        unreachable!("it has a limit");
    };
    assert!((declared / limit - 1.0).abs() <= 1e-9);
    let size = |share: f64, steps| {
        let mut state = moving(system.dofs());
        let mut integrator = build("modified-leapfrog", &plain());
        advance(&mut *integrator, &system, &mut state, steps, share * limit);
        crate::common::largest(&state.u)
    };
    assert!(size(0.99, 3000) < 1.0);
    assert!(size(1.01, 100) > 1e3);
}
