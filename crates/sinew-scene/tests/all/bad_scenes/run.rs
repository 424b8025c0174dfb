//! Mistakes in `[run]`.

use super::refusal;
use super::scenes::BODY;

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
        @r#"scene.toml:23: [run]: dt = 0.0: expected a finite step above 0 s, or "auto""#
    );
}

#[test]
fn backwards_step() {
    insta::assert_snapshot!(
        refusal(BODY, "dt = 0.02", "dt = -0.02"),
        @r#"scene.toml:23: [run]: dt = -0.02: expected a finite step above 0 s, or "auto""#
    );
}

#[test]
fn automatic_step_of_a_method_without_a_limit() {
    insta::assert_snapshot!(
        refusal(BODY, "dt = 0.02", "dt = \"auto\""),
        @r#"
    scene.toml:23: [run]: dt = "auto" finds no step: `newmark` is stable at any step
    help: give dt in s; `sinew plan --tolerance` finds one that is accurate enough
    "#
    );
}

#[test]
fn automatic_step_of_a_method_that_is_never_stable() {
    let undamped = BODY.replace("mass = 80.0", "mass = 0.0");
    let body = undamped.replace("\"newmark\"", "\"forward-euler\"");
    insta::assert_snapshot!(
        refusal(&body, "dt = 0.02", "dt = \"auto\""),
        @r#"
    scene.toml:23: [run]: dt = "auto" finds no step: `forward-euler` is stable at no step on this scene
    help: give dt in s; `sinew plan --tolerance` finds one that is accurate enough
    "#
    );
}

#[test]
fn automatic_step_that_substeps_leave_nothing_to() {
    let body = BODY.replace("\"newmark\"", "\"rk4\"\nsubsteps = \"auto\"");
    insta::assert_snapshot!(refusal(&body, "dt = 0.02", "dt = \"auto\""), @r#"
    scene.toml:24: [run]: dt = "auto" finds no step: `rk4` is stable at any step
    help: give dt in s; `sinew plan --tolerance` finds one that is accurate enough
    "#);
}

#[test]
fn a_word_that_is_no_step() {
    insta::assert_snapshot!(
        refusal(BODY, "dt = 0.02", "dt = \"fast\""),
        @r#"scene.toml:23: [run]: dt = "fast": expected a finite step above 0 s, or "auto""#
    );
}

#[test]
fn an_option_of_another_integrator() {
    insta::assert_snapshot!(
        refusal(BODY, "dt = 0.02", "dt = 0.02\npatches = \"auto\""),
        @r"
    scene.toml:24: [run]: `newmark` has no option `patches`; it takes `beta`, `gamma`, `newton_tolerance`, `newton_iterations`, `factor`
    help: `patches` is an option of `central-difference`
    "
    );
}

#[test]
fn a_factor_in_between() {
    insta::assert_snapshot!(
        refusal(BODY, "dt = 0.02", "dt = 0.02\nfactor = \"sometimes\""),
        @r#"scene.toml:24: [run]: `newmark`: factor = "sometimes": expected "auto", "always" or "never""#
    );
}

#[test]
fn a_misspelt_step_is_not_called_missing() {
    insta::assert_snapshot!(
        refusal(BODY, "dt = 0.02", "dtt = 0.02"),
        @r#"scene.toml:23: [run]: `newmark` has no option `dtt`; it takes `beta`, `gamma`, `newton_tolerance`, `newton_iterations`, `factor`"#
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
