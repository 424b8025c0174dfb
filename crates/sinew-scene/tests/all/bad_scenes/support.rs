//! Mistakes in `[[fixed]]`.

use super::refusal;
use super::scenes::BODY;

#[test]
fn no_group() {
    insta::assert_snapshot!(
        refusal(BODY, "[[fixed]]\ngroup = \"sides\"", "[[fixed]]"),
        @r#"scene.toml:11: [[fixed]] 1: `group` is missing: expected the name of a group, { name = "liver", dim = 2 } where several have it, or where = { .. } in its place"#
    );
}

#[test]
fn unknown_group() {
    insta::assert_snapshot!(
        refusal(BODY, "group = \"sides\"", "group = \"side\""),
        @r#"scene.toml:12: [[fixed]] 1: no group is named "side", did you mean "sides"?; the groups are "tissue" (dimension 3), "sides" (dimension 2), "top" (dimension 2), "bottom" (dimension 2)"#
    );
}

#[test]
fn the_same_axis_twice() {
    insta::assert_snapshot!(
        refusal(BODY, "group = \"sides\"", "group = \"sides\"\naxes = \"xx\""),
        @r#"scene.toml:13: [[fixed]] 1: axes = "xx": expected some of the letters x, y and z, each once"#
    );
}

#[test]
fn an_unknown_axis() {
    insta::assert_snapshot!(
        refusal(BODY, "group = \"sides\"", "group = \"sides\"\naxes = \"xw\""),
        @r#"scene.toml:13: [[fixed]] 1: axes = "xw": expected some of the letters x, y and z, each once"#
    );
}

#[test]
fn no_axis() {
    insta::assert_snapshot!(
        refusal(BODY, "group = \"sides\"", "group = \"sides\"\naxes = \"\""),
        @r#"scene.toml:13: [[fixed]] 1: axes = "": expected some of the letters x, y and z, each once"#
    );
}

#[test]
fn nothing_left_free() {
    insta::assert_snapshot!(
        refusal(BODY, "group = \"sides\"", "group = \"tissue\""),
        @"scene.toml:12: [[fixed]] 1: no degree of freedom is free: all 27 nodes are fixed; free some of them"
    );
}

#[test]
fn one_table_for_a_list() {
    insta::assert_snapshot!(
        refusal(BODY, "[[fixed]]", "[fixed]"),
        @"scene.toml:11: `fixed` is one table: write [[fixed]], as there may be several"
    );
}
