//! What single precision is refused for.

#![cfg(test)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::cube::cube;
use common::{build, plain};
use sinew_core::{OptionError, SetupError, State};

#[test]
fn an_error_below_its_rounding_is_refused() {
    let system = cube(3);
    let of = |tolerance: f64| {
        let options = plain()
            .with_text("precision", "f32")
            .with_number("tolerance", tolerance);
        build("propagator", &options).prepare(&system, 1e-3)
    };
    let refused = of(1e-8).unwrap_err();
    assert!(
        matches!(refused, SetupError::Rounding { asked: 1e-8, .. }),
        "{refused}"
    );
    assert_eq!(
        refused.to_string(),
        "`propagator`: f32 may be off by 5e-5, more than the tolerance of 1e-8; take precision = \"f64\", or a \
         tolerance from 5e-5 on"
    );
    assert!(of(1e-3).is_ok());
}

#[test]
fn steps_that_are_no_program_are_refused() {
    let options = plain()
        .with_text("precision", "f32")
        .with_text("kind", "krylov")
        .with_number("tolerance", 1e-3);
    let refused = build("propagator", &options).prepare(&cube(3), 1e-3);
    assert!(
        matches!(refused, Err(SetupError::SinglePrecision { .. })),
        "{refused:?}"
    );
}

#[test]
fn other_words_than_those_listed_are_refused() {
    for (key, word) in [
        ("precision", "f16"),
        ("machine", "gpu"),
        ("threads", "many"),
    ] {
        let refused = sinew_integrators::build("rk4", &plain().with_text(key, word)).err();
        assert!(
            matches!(&refused, Some(OptionError::Value { .. })),
            "{refused:?}"
        );
    }
    let refused = sinew_integrators::build("rk4", &plain().with_number("threads", 0.0)).err();
    assert!(refused.is_some());
}

#[test]
fn the_plain_loops_do_not_pass_for_single_precision() {
    let options = plain()
        .with_text("precision", "f32")
        .with_text("machine", "reference");
    let refused = sinew_integrators::build("rk4", &options).err().unwrap();
    assert!(
        refused
            .to_string()
            .contains("in which machine = \"reference\" computes"),
        "{refused}"
    );
}

#[test]
fn a_run_says_on_which_kernel_it_is() {
    let system = cube(3);
    let kernel = |precision: &str, machine: &str| {
        let options = plain()
            .with_text("precision", precision)
            .with_text("machine", machine);
        let mut method = build("central-difference", &options);
        let mut state = State::at_rest(sinew_core::System::dofs(&system));
        method.step(&system, &mut state, 1e-4).unwrap();
        method.kernel().unwrap()
    };
    assert_eq!(kernel("f64", "reference"), "reference");
    assert!(kernel("f64", "general").starts_with("general f64 "));
    assert!(kernel("f32", "repeated").starts_with("repeated f32 "));
}
