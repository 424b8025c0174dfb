//! Laws on the duties that all methods share.

use super::boxed::Boxed;
use super::problems::{
    Dampers, FORCE, MASS, Problem, advance, chain, gentle_step, moving, problems,
};
use crate::{SetupError, State, StepError};

/// A body at rest without loads stays at rest.
pub fn rest_stays_at_rest(make: &dyn Fn() -> Boxed) {
    for Problem { system, start, .. } in problems(Dampers::MASS, 0.0) {
        let dofs = start.u.len();
        let mut state = State::at_rest(dofs);
        advance(&mut *make(), &system, &mut state, 100, 0.01);
        assert_eq!(state.u, vec![0.0; dofs]);
        assert_eq!(state.v, vec![0.0; dofs]);
        match state.clock.last_step() {
            Some(0.01) => assert_eq!(state.t(), 1.0),
            // The substeps are rounded.
            _ => assert!((state.t() - 1.0).abs() <= 4.0 * f64::EPSILON),
        }
    }
}

/// A clone of a state, continued with a fresh integrator, gives the same bits.
pub fn checkpoint_continues_bit_identically(make: &dyn Fn() -> Boxed) {
    for Problem { system, start, .. } in problems(Dampers::MASS, FORCE) {
        let (mut integrator, mut state) = (make(), start);
        let dt = gentle_step(&*integrator, &system);
        advance(&mut *integrator, &system, &mut state, 11, dt);
        let mut checkpoint = state.clone();
        advance(&mut *integrator, &system, &mut state, 13, dt);
        advance(&mut *make(), &system, &mut checkpoint, 13, dt);
        assert_eq!(state, checkpoint);
    }
}

/// Zero, negative or NaN masses and steps and states of the wrong size give an error that names
/// the integrator; nothing panics.
pub fn bad_systems_and_steps_are_refused(make: &dyn Fn() -> Boxed) {
    let sound = chain(1.0, FORCE, [MASS; 2]);
    for dt in [0.0, -0.01, f64::NAN, f64::INFINITY] {
        let refusal = make().step(&sound, &mut moving(), dt);
        assert!(
            matches!(refusal, Err(StepError::Setup(SetupError::Step { .. }))),
            "dt = {dt}: {refusal:?}"
        );
    }
    for mass in [0.0, -1.0, f64::NAN] {
        let system = chain(1.0, FORCE, [MASS, mass]);
        let refusal = make().prepare(&system, 0.01);
        assert!(
            matches!(refusal, Err(SetupError::Mass { .. })),
            "mass {mass}: {refusal:?}"
        );
        let message = refusal.map_or_else(|error| error.to_string(), |_| String::new());
        assert!(message.contains(make().id()), "{message}");
        assert!(message.contains("degree of freedom 1"), "{message}");
    }
    let refusal = make().step(&sound, &mut State::at_rest(3), 0.01);
    assert!(
        matches!(refusal, Err(StepError::Setup(SetupError::StateSize { .. }))),
        "{refusal:?}"
    );
    let mut state = moving();
    state.internal = vec![0.0];
    let refusal = make().step(&sound, &mut state, 0.01);
    assert!(
        matches!(refusal, Err(StepError::Setup(SetupError::Internal { .. }))),
        "{refusal:?}"
    );
}

/// An integrator that is used on another system of the same size discards all that it kept of the first.
pub fn another_system_is_noticed(make: &dyn Fn() -> Boxed) {
    let (first, second) = (
        chain(1.0, FORCE, [MASS; 2]),
        chain(1.0, FORCE, [3.0 * MASS, MASS]),
    );
    let mut used = make();
    advance(&mut *used, &first, &mut moving(), 3, 1e-3);
    let (mut state, mut fresh_state) = (moving(), moving());
    advance(&mut *used, &second, &mut state, 5, 1e-3);
    advance(&mut *make(), &second, &mut fresh_state, 5, 1e-3);
    assert_eq!(state, fresh_state);
}
