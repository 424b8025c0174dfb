//! Mistakes in `[[probe]]`.

use super::refusal;
use super::scenes::BODY;

#[test]
fn no_name() {
    insta::assert_snapshot!(
        refusal(BODY, "name = \"centre\"\n", ""),
        @"scene.toml:24: [[probe]] 1: `name` is missing: expected a name made of letters, digits, `-`, `_` and `.`"
    );
}

#[test]
fn a_name_with_a_comma() {
    insta::assert_snapshot!(
        refusal(BODY, "name = \"centre\"", "name = \"top,centre\""),
        @r#"scene.toml:25: [[probe]] 1: name = "top,centre": expected a name made of letters, digits, `-`, `_` and `.`"#
    );
}

#[test]
fn no_point() {
    insta::assert_snapshot!(
        refusal(BODY, "point = [0.1, 0.1, 0.1]", ""),
        @"scene.toml:24: [[probe]] 1: `point` is missing: expected [x, y, z] in m, all finite"
    );
}

#[test]
fn a_point_nowhere() {
    insta::assert_snapshot!(
        refusal(BODY, "point = [0.1, 0.1, 0.1]", "point = [0.1, 0.1, inf]"),
        @"scene.toml:26: [[probe]] 1: point = [0.1, 0.1, inf]: expected [x, y, z] in m, all finite"
    );
}

#[test]
fn the_same_name_twice() {
    insta::assert_snapshot!(
        refusal(BODY, "[[probe]]", "[[probe]]\nname = \"centre\"\npoint = [0, 0, 0]\n[[probe]]"),
        @r#"scene.toml:28: [[probe]] 2: name = "centre" is taken by [[probe]] 1 on line 25"#
    );
}
