//! Changing the integrator in the middle of a motion.

use crate::common::cube::cube;
use crate::common::{advance, build, plain, relative_error};
use sinew_core::{State, System, VelocityTime};
use sinew_fem::Model;

const DURATION: f64 = 0.04; // s

/// Makes displacements as large as velocities.
const RATE: f64 = 30.0; // rad/s

/// The cube, already moving.
fn start(model: &Model) -> State {
    let wave = |size: f64, rate: f64| {
        let value = |dof| size * f64::sin(rate * f64::from(dof));
        (0..model.dofs() as u32).map(value).collect()
    };
    State::new(wave(1e-3, 0.7), wave(0.1, 1.3))
}

/// Displacement and velocity at forty instants, each integrator takes an equal part of them.
fn motion(model: &Model, ids: &[&str], dt: f64) -> Vec<Vec<f64>> {
    let steps = (DURATION / dt).round() as usize / 40;
    let mut state = start(model);
    let mut velocity = vec![0.0; model.dofs()];
    let mut motion = Vec::new();
    for id in ids {
        let mut integrator = build(id, &plain());
        for _ in 0..40 / ids.len() {
            advance(&mut *integrator, model, &mut state, steps, dt);
            state
                .velocity_at_t(model, sinew_core::Inputs::none(), &mut velocity)
                .unwrap();
            let moved = state.u.iter().map(|u| RATE * u);
            motion.push(moved.chain(velocity.iter().copied()).collect());
        }
    }
    motion
}

#[test]
fn any_integrator_takes_over_from_any_other() {
    let model = cube(4);
    let reference = motion(&model, &["rk4"], 1.25e-4);
    let dt = 1e-3;
    let error = |ids: &[&str]| relative_error(&motion(&model, ids, dt), &reference);
    let ids = sinew_integrators::ids();
    let alone: Vec<f64> = ids.iter().map(|id| error(&[id])).collect();
    for (first, alone_first) in ids.iter().zip(&alone) {
        for (second, alone_second) in ids.iter().zip(&alone) {
            let both = error(&[first, second]);
            assert!(
                both <= 1.5 * (alone_first + alone_second),
                "`{first}`, then `{second}`: {both:e}; alone {alone_first:e} and {alone_second:e}"
            );
        }
    }
}

/// A velocity that is half a step behind, or an acceleration from an earlier time, would lower the order.
#[test]
fn methods_of_second_order_hand_over_at_second_order() {
    let model = cube(4);
    let reference = motion(&model, &["rk4"], 1.25e-4);
    let mut sequences = vec![
        vec!["central-difference", "rk4"],
        vec!["rk4", "central-difference"],
        vec!["cnn-stabilised", "rk4"],
        vec!["rk4", "cnn-stabilised", "propagator", "cnn-stabilised"],
        vec!["modified-leapfrog", "propagator"],
        vec!["propagator", "modified-leapfrog"],
    ];
    if cfg!(feature = "implicit") {
        sequences.extend([
            vec!["central-difference", "newmark"],
            vec!["newmark", "central-difference", "rk4", "newmark"],
            vec!["central-difference", "generalized-alpha"],
            vec!["newmark", "generalized-alpha", "rk4", "generalized-alpha"],
        ]);
    }
    for ids in sequences {
        let error = |dt| relative_error(&motion(&model, &ids, dt), &reference);
        let order = (error(1e-3) / error(5e-4)).log2();
        assert!((order - 2.0).abs() < 0.1, "{ids:?}: {order}");
    }
}

/// The same method at another step is also a switch.
#[test]
fn central_difference_changes_its_step_at_second_order() {
    let model = cube(4);
    let end = |dt: f64, change: f64| {
        let mut state = start(&model);
        let mut integrator = build("central-difference", &plain());
        let steps = (DURATION / 2.0 / dt).round() as usize;
        advance(&mut *integrator, &model, &mut state, steps, dt);
        let steps = (steps as f64 / change).round() as usize;
        advance(&mut *integrator, &model, &mut state, steps, dt * change);
        state.u
    };
    let reference = motion(&model, &["rk4"], 1.25e-4).pop().unwrap();
    let truth: Vec<f64> = reference[..model.dofs()].iter().map(|u| u / RATE).collect();
    for change in [0.5, 2.0] {
        let error = |dt| relative_error(&[end(dt, change)], std::slice::from_ref(&truth));
        let order = (error(1e-3) / error(5e-4)).log2();
        assert!((order - 2.0).abs() < 0.1, "by {change}: {order}");
    }
}

#[test]
fn a_synchronised_state_holds_at_one_time() {
    let model = cube(3);
    for id in sinew_integrators::ids() {
        let mut state = start(&model);
        advance(&mut *build(id, &plain()), &model, &mut state, 7, 1e-3);
        let staggered = state.velocity == VelocityTime::MiddleOfStep;
        assert!(staggered || id != "central-difference");
        let (mut at_t, mut work) = (vec![0.0; model.dofs()], vec![0.0; model.dofs()]);
        state
            .velocity_at_t(&model, sinew_core::Inputs::none(), &mut at_t)
            .unwrap();
        let displacement = state.u.clone();
        assert_eq!(
            state.synchronise(&model, sinew_core::Inputs::none(), &mut work),
            Ok(staggered),
            "`{id}`"
        );
        assert_eq!(state.velocity, VelocityTime::Same, "`{id}`");
        assert_eq!((&state.u, &state.v), (&displacement, &at_t), "`{id}`");
        assert_eq!(
            state.synchronise(&model, sinew_core::Inputs::none(), &mut work),
            Ok(false),
            "`{id}`"
        );
    }
}
