//! Mistakes in `[[initial]]`.

use super::refusal;
use super::scenes::BODY;

#[test]
fn nothing_set() {
    insta::assert_snapshot!(
        refusal(BODY, "[[initial]]\nvelocity = [0.0, 0.0, 1.0]", "[[initial]]"),
        @"scene.toml:18: [[initial]] 1: expected exactly one of `displacement`, `velocity`, `stretch`, `static`, found none"
    );
}

#[test]
fn two_at_once() {
    insta::assert_snapshot!(
        refusal(BODY, "velocity = [0.0, 0.0, 1.0]", "velocity = [0.0, 0.0, 1.0]\nstatic = [\"push\"]"),
        @"scene.toml:20: [[initial]] 1: expected exactly one of `displacement`, `velocity`, `stretch`, `static`, found `velocity`, `static`"
    );
}

#[test]
fn an_origin_of_nothing() {
    insta::assert_snapshot!(
        refusal(BODY, "velocity = [0.0, 0.0, 1.0]", "velocity = [0.0, 0.0, 1.0]\norigin = [0, 0, 0]"),
        @"scene.toml:20: [[initial]] 1: `origin` goes with `stretch` only"
    );
}

#[test]
fn a_static_state_of_a_group() {
    insta::assert_snapshot!(
        refusal(BODY, "velocity = [0.0, 0.0, 1.0]", "static = [\"push\"]\ngroup = \"top\""),
        @"scene.toml:20: [[initial]] 1: `group` does not go with `static`, which moves the whole body"
    );
}

#[test]
fn a_static_state_under_nothing() {
    insta::assert_snapshot!(
        refusal(BODY, "velocity = [0.0, 0.0, 1.0]", "static = []"),
        @"scene.toml:19: [[initial]] 1: static = []: expected a list of names of loads"
    );
}

#[test]
fn a_static_state_under_an_unknown_load() {
    insta::assert_snapshot!(
        refusal(BODY, "velocity = [0.0, 0.0, 1.0]", "static = [\"push\", \"pull\"]"),
        @r#"scene.toml:19: [[initial]] 1: no load is named "pull"; the named loads are `push`"#
    );
}

#[test]
fn a_static_state_under_gravity_that_is_not_there() {
    insta::assert_snapshot!(
        refusal(BODY, "velocity = [0.0, 0.0, 1.0]", "static = [\"gravity\"]"),
        @r#"scene.toml:19: [[initial]] 1: no load is named "gravity"; the named loads are `push`"#
    );
}

#[test]
fn unknown_group() {
    insta::assert_snapshot!(
        refusal(BODY, "velocity = [0.0, 0.0, 1.0]", "velocity = [0.0, 0.0, 1.0]\ngroup = \"bottum\""),
        @r#"scene.toml:20: [[initial]] 1: no group is named "bottum", did you mean "bottom"?; the groups are "tissue" (dimension 3), "sides" (dimension 2), "top" (dimension 2), "bottom" (dimension 2)"#
    );
}

#[test]
fn two_strains() {
    insta::assert_snapshot!(
        refusal(BODY, "velocity = [0.0, 0.0, 1.0]", "stretch = [0.1, 0.1]"),
        @"scene.toml:19: [[initial]] 1: stretch = [0.1, 0.1]: expected strains [x, y, z], all finite"
    );
}

/// Because of rounding, the matrices of some of these bodies have an inverse.
#[test]
fn a_static_state_of_a_body_that_nothing_holds() {
    let free = BODY.replace("[[fixed]]\ngroup = \"sides\"\n", "");
    let variants = (1..=6).flat_map(|cells| [500, 3500, 10_000].map(|modulus| (cells, modulus)));
    for (cells, modulus) in variants {
        let free = free
            .replace("cells = 2", &format!("cells = {cells}"))
            .replace("3500.0", &modulus.to_string());
        let message = refusal(&free, "velocity = [0.0, 0.0, 1.0]", "static = [\"push\"]");
        let start = "scene.toml:17: [[initial]] 1: no static state: ";
        assert!(message.starts_with(start), "{message}");
        assert!(
            message.ends_with("supports that prevent all rigid motions"),
            "{message}"
        );
    }
}

#[test]
fn a_velocity_that_is_no_formula() {
    insta::assert_snapshot!(
        refusal(BODY, "velocity = [0.0, 0.0, 1.0]", "velocity = [0.0, 0.0, \"0.5 * t\"]"),
        @r#"scene.toml:19: [[initial]] 1: velocity: "0.5 * t": `t` at character 7 of the formula: expected x, y, z, pi, sin, cos, exp, sqrt or abs"#
    );
}

#[test]
fn a_formula_without_a_finite_value_at_a_node() {
    insta::assert_snapshot!(
        refusal(BODY, "velocity = [0.0, 0.0, 1.0]", "velocity = [0.0, 0.0, \"1 / (z - 0.1)\"]"),
        @"scene.toml:19: [[initial]] 1: a formula gives inf at (0.1, 0.1, 0.1) m: expected a finite number everywhere on the part"
    );
}

/// An error before the first step: the history variables begin with the given displacement.
#[test]
fn a_state_in_which_a_law_with_memory_has_no_meaning() {
    let relaxing = BODY
        .replace(
            "model = \"springs\"\nyoungs_modulus = 3500.0\nsprings = { rule = \"lloyd\" }",
            "model = \"neo-hookean\"\nyoungs_modulus = 3500.0\npoissons_ratio = 0.3\nprony = [[0.3, 0.1]]",
        )
        .replace("group = \"sides\"", "group = \"bottom\"");
    let refused = refusal(
        &relaxing,
        "velocity = [0.0, 0.0, 1.0]",
        "where = { above = { z = 0.2 } }\ndisplacement = [0.0, 0.0, -0.35]",
    );
    assert!(
        refused.starts_with("scene.toml:19: [[initial]] 1: the body cannot begin so: element "),
        "{refused}"
    );
}
