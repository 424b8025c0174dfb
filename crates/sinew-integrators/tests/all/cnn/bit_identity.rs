//! Tests that a network without saturation equals the plain method, to the last bit.

use crate::common::{build, plain, saturation};
use proptest::prelude::*;
use sinew_core::{LinearModel, LinearOperators, OptionValue, Options, State, System};
use sinew_fem::{Law, SpringRule};
use sinew_testkit::body::{Body, bodies_up_to, fastest_time};

/// The network and the method that it equals.
const PAIRS: [(&str, &str); 2] = [
    ("cnn", "forward-euler"),
    ("cnn-symplectic", "symplectic-euler"),
];

fn bits(state: &State) -> Vec<u64> {
    let all = [&[state.t()], &state.u[..], &state.v[..]].concat();
    all.iter().map(|value| value.to_bits()).collect()
}

/// Takes the same steps with both; `saturation` is never reached.
fn assert_same(system: &dyn System, start: &State, dt: f64, saturation: &Options) {
    for (network, method) in PAIRS {
        let (mut one, mut other) = (start.clone(), start.clone());
        let (mut network, mut method) = (build(network, saturation), build(method, &plain()));
        for step in 0..30 {
            let work = network.step(system, &mut one, dt).unwrap();
            assert_eq!(work.saturated, 0);
            assert_eq!(work, method.step(system, &mut other, dt).unwrap());
            assert!(
                bits(&one) == bits(&other),
                "step {step} of `{}`",
                network.id()
            );
        }
    }
}

fn assert_network_is_method(system: &dyn System, start: &State, dt: f64) {
    let off = plain().with("saturation", OptionValue::Text("off".into()));
    for saturation in [off, saturation(1e300)] {
        assert_same(system, start, dt, &saturation);
    }
}

fn assert_body_is_method(body: &Body, share: f64) {
    let model = body.model();
    let dt = share * fastest_time(&model);
    assert_network_is_method(&model, &body.state(&model, 1e-3, 1e-3 / dt), dt);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Steps within the stable step and far beyond it.
    #[test]
    fn of_any_body(body in bodies_up_to(3), share in 0.01..4.0) {
        assert_body_is_method(&body, share);
    }

    #[test]
    fn of_bodies_with_every_kind_of_damping(
        body in bodies_up_to(3),
        share in 0.01..4.0,
        damping_ratio in 0.01..1.0,
    ) {
        let mut body = body;
        (body.problem.damping.mass, body.problem.damping.stiffness) = (3.0, 1e-3);
        body.problem.regions[0].law = Law::Springs {
            youngs_modulus: 3500.0,
            rule: SpringRule::Lloyd,
            calibrate: false,
            damping_ratio,
        };
        prop_assert!(body.model().report().damping_matrix);
        assert_body_is_method(&body, share);
    }

    #[test]
    fn of_the_oscillator(dt in 1e-4..0.03, velocity in -5.0..5.0) {
        let model = LinearModel::new(LinearOperators::oscillator(0.1, 100.0, 1.0).unwrap());
        assert_network_is_method(&model, &State::new(vec![0.0], vec![velocity]), dt);
    }
}

/// The comparison detects a clamp: if one is reached, network and method differ.
#[test]
fn a_clamp_that_is_reached_is_seen() {
    let model = LinearModel::new(LinearOperators::oscillator(0.1, 100.0, 1.0).unwrap());
    for (network, method) in PAIRS {
        let start = State::new(vec![0.0], vec![-5.0]);
        let (mut one, mut other) = (start.clone(), start);
        let work = build(network, &saturation(4.0))
            .step(&model, &mut one, 1e-3)
            .unwrap();
        build(method, &plain())
            .step(&model, &mut other, 1e-3)
            .unwrap();
        assert_eq!(work.saturated, 1);
        assert_eq!(one.v, other.v);
        assert_ne!(one.u, other.u);
    }
}
