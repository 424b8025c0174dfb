//! What is wrong with `[run]`.

use crate::refusal;
use crate::scenes::BODY;

#[test]
fn no_duration() {
    insta::assert_snapshot!(
        refusal(BODY, "duration = 1.0\n", ""),
        @"scene.toml:20: [run]: `duration` is missing: expected a finite time above 0 s"
    );
}

#[test]
fn zero_duration() {
    insta::assert_snapshot!(
        refusal(BODY, "duration = 1.0", "duration = 0"),
        @"scene.toml:21: [run]: duration = 0: expected a finite time above 0 s"
    );
}

#[test]
fn endless() {
    insta::assert_snapshot!(
        refusal(BODY, "duration = 1.0", "duration = inf"),
        @"scene.toml:21: [run]: duration = inf: expected a finite time above 0 s"
    );
}

#[test]
fn no_samples() {
    insta::assert_snapshot!(
        refusal(BODY, "dt = 0.02", "dt = 0.02\nsamples = 0"),
        @"scene.toml:24: [run]: samples = 0: expected a whole number from 1 to 1000000"
    );
}

#[test]
fn half_a_sample() {
    insta::assert_snapshot!(
        refusal(BODY, "dt = 0.02", "dt = 0.02\nsamples = 0.5"),
        @"scene.toml:24: [run]: samples = 0.5: expected a whole number from 1 to 1000000, found a number"
    );
}

#[test]
fn zero_step() {
    insta::assert_snapshot!(
        refusal(BODY, "dt = 0.02", "dt = 0.0"),
        @"scene.toml:23: [run]: dt = 0.0: expected a finite step above 0 s"
    );
}

#[test]
fn backwards_step() {
    insta::assert_snapshot!(
        refusal(BODY, "dt = 0.02", "dt = -0.02"),
        @"scene.toml:23: [run]: dt = -0.02: expected a finite step above 0 s"
    );
}

#[test]
fn automatic_step() {
    insta::assert_snapshot!(
        refusal(BODY, "dt = 0.02", "dt = \"auto\""),
        @r#"
    scene.toml:23: [run]: dt = "auto": expected a finite step above 0 s, found a string
    help: a scene always gives dt; with substeps = "auto" an explicit integrator cuts it into stable parts
    "#
    );
}

#[test]
fn unknown_integrator() {
    let message = refusal(BODY, "\"newmark\"", "\"newmerk\"");
    let start = "scene.toml:22: [run]: unknown integrator `newmerk`; there are `forward-euler`, ";
    assert!(message.starts_with(start), "{message}");
    assert!(
        message.ends_with("\nhelp: did you mean `newmark`?"),
        "{message}"
    );
}

#[test]
fn unknown_option() {
    let message = refusal(BODY, "dt = 0.02", "dt = 0.02\nbta = 0.25");
    let start = "scene.toml:24: [run]: `newmark` has no option `bta`; it takes `beta`, ";
    assert!(message.starts_with(start), "{message}");
    assert!(
        message.ends_with("\nhelp: did you mean `beta`?"),
        "{message}"
    );
}

#[test]
fn an_option_out_of_range() {
    insta::assert_snapshot!(
        refusal(BODY, "dt = 0.02", "dt = 0.02\nbeta = -1.0"),
        @"scene.toml:24: [run]: `newmark`: beta = -1: expected a number from 0 to 1"
    );
}

#[test]
fn an_option_that_is_not_a_number() {
    insta::assert_snapshot!(
        refusal(BODY, "dt = 0.02", "dt = 0.02\nbeta = nan"),
        @"scene.toml:24: [run]: beta = nan: expected a finite number, a string, or a table of these"
    );
}

#[test]
fn an_option_of_no_known_type() {
    insta::assert_snapshot!(
        refusal(BODY, "dt = 0.02", "dt = 0.02\nbeta = [0.25]"),
        @"scene.toml:24: [run]: beta = [0.25]: expected a finite number, a string, or a table of these, found a list"
    );
}

#[test]
fn a_list_deep_in_an_option() {
    insta::assert_snapshot!(
        refusal(BODY, "dt = 0.02", "dt = 0.02\ninner = { kind = [1] }"),
        @"scene.toml:24: [run]: inner = { kind = [1] }: expected a finite number, a string, or a table of these, found a table"
    );
}
