//! Steps divided into substeps.

use crate::common::cube::cube;
use crate::common::{advance, build, largest, plain};
use sinew_core::{
    LinearModel, LinearOperators, OptionValue, Options, SetupError, StableStep, State, StepError,
    System,
};
use sinew_fem::Model;

fn auto() -> Options {
    plain().with("substeps", OptionValue::Text("auto".into()))
}

fn fixed(parts: u32) -> Options {
    plain().with_number("substeps", f64::from(parts))
}

/// Methods that take the option.
fn ids() -> Vec<&'static str> {
    let entries = sinew_integrators::entries().into_iter();
    entries
        .filter(|entry| entry.substeps)
        .map(|entry| entry.id)
        .collect()
}

fn limit(id: &str, model: &Model) -> f64 {
    match build(id, &plain()).stable_step(model) {
        Ok(StableStep::UpTo(limit)) => limit,
        other => panic!("`{id}`: {other:?}"),
    }
}

/// Sweeps of a step after the method's first step.
fn sweeps(id: &str, options: &Options, model: &Model, dt: f64) -> u64 {
    let mut state = State::at_rest(model.dofs());
    let mut integrator = build(id, options);
    advance(&mut *integrator, model, &mut state, 1, dt);
    integrator.step(model, &mut state, dt).unwrap().sweeps
}

#[test]
fn automatic_parts_stay_below_nine_tenths_of_the_stable_step() {
    let model = cube(3);
    for id in ids() {
        let limit = limit(id, &model);
        let of_one = sweeps(id, &plain(), &model, 0.1 * limit);
        for (share, parts) in [
            (0.1, 1),
            (0.899, 1),
            (0.9, 1),
            (0.901, 2),
            (1.0, 2),
            (1.79, 2),
            (1.81, 3),
            (10.0, 12),
        ] {
            let dt = share * limit;
            let found = sweeps(id, &auto(), &model, dt);
            assert_eq!(found, parts * of_one, "`{id}` at {share} of its limit");
            assert!(share == 0.9 || parts == (dt / (0.9 * limit)).ceil() as u64);
        }
    }
}

#[test]
fn parts_are_steps_to_the_last_bit() {
    let model = cube(3);
    for id in ids() {
        let dt = 2.5 * limit(id, &model);
        let start = State::at_rest(model.dofs());
        let (mut whole, mut parts, mut automatic) = (start.clone(), start.clone(), start);
        advance(&mut *build(id, &fixed(3)), &model, &mut whole, 10, dt);
        advance(&mut *build(id, &auto()), &model, &mut automatic, 10, dt);
        advance(&mut *build(id, &plain()), &model, &mut parts, 30, dt / 3.0);
        assert!(whole == parts, "`{id}`");
        assert!(automatic == parts, "`{id}`");
        assert!(largest(&parts.u) > 1e-4);
    }
}

#[test]
fn parts_make_longer_steps_stable() {
    let model = cube(3);
    for id in ids() {
        let limit = limit(id, &model);
        let (three, any) = (build(id, &fixed(3)), build(id, &auto()));
        assert_eq!(three.stable_step(&model), Ok(StableStep::UpTo(3.0 * limit)));
        assert_eq!(any.stable_step(&model), Ok(StableStep::Any));
        for (mut integrator, dt) in [(three, 2.9 * limit), (any, 50.0 * limit)] {
            let mut state = State::at_rest(model.dofs());
            let steps = (20.0 / dt) as usize;
            advance(&mut *integrator, &model, &mut state, steps, dt);
            assert!(largest(&state.u) < 0.02, "`{id}`: {}", largest(&state.u));
        }
    }
}

#[test]
fn the_count_follows_the_step_and_the_system() {
    let (coarse, fine) = (cube(3), cube(6));
    let mut integrator = build("central-difference", &auto());
    let mut parts = |model: &Model, dt| {
        let work = integrator.step(model, &mut State::at_rest(model.dofs()), dt);
        work.unwrap().sweeps
    };
    let dt = 3.0 * limit("central-difference", &coarse);
    assert_eq!(parts(&coarse, dt), 4);
    assert_eq!(parts(&coarse, 2.0 * dt), 7);
    assert!(parts(&fine, dt) > 4);
    assert_eq!(parts(&coarse, dt), 4);
}

/// Forward Euler has no stable step without damping, so there is no basis for the choice of substeps.
#[test]
fn where_no_step_is_stable_automatic_parts_are_refused() {
    let undamped = LinearModel::new(LinearOperators::oscillator(0.1, 100.0, 0.0).unwrap());
    for id in ["forward-euler", "cnn"] {
        let mut state = State::new(vec![0.01], vec![0.0]);
        let refusal = build(id, &auto())
            .step(&undamped, &mut state, 0.01)
            .unwrap_err();
        assert!(matches!(
            refusal,
            StepError::Setup(SetupError::Lacks { .. })
        ));
        assert_eq!(
            refusal.to_string(),
            format!(
                "`{id}` needs a stable step above 0 to choose sub-steps by, which this system does not offer"
            )
        );
        assert_eq!(state.t(), 0.0);
        assert_eq!(
            build(id, &auto()).stable_step(&undamped),
            Ok(StableStep::UpTo(0.0))
        );
        // A number of parts is the user's own choice.
        assert!(
            build(id, &fixed(4))
                .step(&undamped, &mut state, 0.01)
                .is_ok()
        );
    }
}

#[cfg(feature = "implicit")]
#[test]
fn methods_without_a_largest_step_take_no_parts() {
    let refusal = sinew_integrators::build("newmark", &auto()).err();
    assert_eq!(
        refusal.map(|error| error.to_string()).as_deref(),
        Some(
            "`newmark` has no option `substeps`; it takes `beta`, `gamma`, `newton_tolerance`, `newton_iterations`, `factor`"
        )
    );
}
