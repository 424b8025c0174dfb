//! The energy that methods dissipate numerically: the residual of the balance of a step.

use crate::common::cube::{altered, mass_damping, scene, springs};
use sinew_core::{
    Damping, LinearModel, LinearSystem, Load, LoadTime, Options, Ramp, State, System, vectors::dot,
};
use sinew_integrators::build;
use sinew_integrators::{NumericalDissipation, StepEnd};

/// Springs with dashpots, under mass and stiffness damping and a load of this kind.
fn body(ramp: Ramp) -> LinearModel {
    let model = scene(2, 0.2, springs(0.1), mass_damping(5.0));
    let loads = model.operators().loads().iter().map(|load| Load {
        ramp: ramp.clone(),
        ..load.clone()
    });
    let loads = loads.collect();
    let damping = Damping {
        stiffness: 0.003,
        ..model.operators().damping().clone()
    };
    altered(&model, damping, loads)
}

/// The largest difference, over some steps, between the energy missing from the balance and the stated dissipation,
/// over the initial energy; and the sum of the latter over the initial energy.
fn missing(id: &str, options: &Options, ramp: &Ramp) -> [f64; 2] {
    let dt = 0.004;
    let model = body(ramp.clone());
    let operators = model.operators();
    let mut method = build(id, options).unwrap();
    method.prepare(&model, dt).unwrap();
    let form = method.numerical_dissipation().unwrap();
    let wave = |size: f64, rate: f64| {
        let value = |dof| size * f64::sin(1.0 + rate * f64::from(dof));
        (0..model.dofs() as u32).map(value).collect()
    };
    let mut state = State::new(wave(1e-3, 7.1), wave(0.1, 3.7));
    let load = |when: LoadTime<'_>| {
        let mut load = vec![0.0; model.dofs()];
        operators.external_force(when, &mut load);
        load
    };
    let energy = |state: &State| {
        let energy = operators.energy(&state.u, &state.v);
        energy.kinetic + energy.elastic
    };
    let first = energy(&state);
    // The first step finds the acceleration that the others begin with.
    crate::common::advance(&mut *method, &model, &mut state, 1, dt);
    let (mut worst, mut sum) = (0.0_f64, 0.0);
    for _ in 0..20 {
        let before = state.clone();
        crate::common::advance(&mut *method, &model, &mut state, 1, dt);
        let [old, new] = [before.t(), state.t()].map(|t| load(t.into()));
        let du: Vec<f64> = state
            .u
            .iter()
            .zip(&before.u)
            .map(|(new, old)| new - old)
            .collect();
        let mut damped = vec![0.0; du.len()];
        operators.subtract_damping(&du, &mut damped);
        let damped = -dot(&du, &damped) / dt;
        let work = 0.5 * (dot(&old, &du) + dot(&new, &du));
        let taken_by_it = form.loads_at_ends(before.t(), dt).map(load);
        let ends = [&before, &state].into_iter().zip(&taken_by_it);
        let ends = ends.map(|(state, load)| StepEnd {
            u: &state.u,
            v: &state.v,
            a: &state.a,
            load,
        });
        let ends: Vec<StepEnd<'_>> = ends.collect();
        let taken = form.taken(operators, dt, [ends[0], ends[1]]);
        let missing = energy(&before) + work - damped - energy(&state);
        worst = worst.max((missing - taken).abs() / first);
        sum += taken / first;
    }
    [worst, sum]
}

/// Newmark (beta, gamma) and generalised alpha, also with parameters that are no sensible choice.
fn cases() -> Vec<(&'static str, Options)> {
    let of = |pairs: &[(&str, f64)]| {
        pairs.iter().fold(Options::new(), |options, (key, value)| {
            options.with_number(*key, *value)
        })
    };
    vec![
        ("implicit-euler", of(&[])),
        ("newmark", of(&[("beta", 0.3025), ("gamma", 0.6)])),
        ("newmark", of(&[("beta", 0.7), ("gamma", 0.5)])),
        ("newmark", of(&[("beta", 1.0), ("gamma", 1.0)])),
        ("generalized-alpha", of(&[("rho_inf", 0.0)])),
        ("generalized-alpha", of(&[("rho_inf", 0.7)])),
        ("generalized-alpha", of(&[("hht", 0.2)])),
    ]
}

#[test]
fn what_is_missing_from_the_balance_of_a_step_is_the_closed_form() {
    for (id, options) in cases() {
        for ramp in [Ramp::Step, Ramp::Linear] {
            let [worst, sum] = missing(id, &options, &ramp);
            assert!(worst < 1e-13, "{id} {options:?} {ramp:?}: {worst:e}");
            assert!(sum.abs() > 1e-4, "{id} {options:?}: {sum:e}");
        }
    }
}

/// Mean acceleration (Hughes, The Finite Element Method, 9.2) and the midpoint rule, which generalised alpha is for a
/// spectral radius of 1, dissipate nothing.
#[test]
fn mean_acceleration_takes_nothing() {
    for (id, options) in [
        ("newmark", Options::new()),
        (
            "generalized-alpha",
            Options::new().with_number("rho_inf", 1.0),
        ),
    ] {
        let [worst, sum] = missing(id, &options, &Ramp::Linear);
        assert!(
            worst < 1e-13 && sum.abs() < 1e-13,
            "{id}: {worst:e} {sum:e}"
        );
    }
}

#[test]
fn most_methods_have_no_closed_form() {
    for id in ["central-difference", "rk4", "cnn-stabilised"] {
        assert_eq!(
            build(id, &Options::new()).unwrap().numerical_dissipation(),
            None
        );
    }
    let of_newmark = build("newmark", &Options::new()).unwrap();
    assert!(matches!(
        of_newmark.numerical_dissipation(),
        Some(NumericalDissipation::Newmark { beta: 0.25, .. })
    ));
}
