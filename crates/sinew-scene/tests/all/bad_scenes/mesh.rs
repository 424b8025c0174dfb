//! Mistakes in `[mesh]`.

use super::refusal;
use super::scenes::{BLOCK, BODY};

#[test]
fn no_source() {
    insta::assert_snapshot!(
        refusal(BODY, "cube = { cells = 2, edge = 0.2 }", ""),
        @"scene.toml:2: [mesh]: expected exactly one of `file`, `cube`, `block`, found none"
    );
}

#[test]
fn two_sources() {
    insta::assert_snapshot!(
        refusal(BODY, "cube = {", "file = \"a.msh\"\ncube = {"),
        @"scene.toml:4: [mesh]: expected exactly one of `file`, `cube`, `block`, found `file`, `cube`"
    );
}

#[test]
fn no_cells() {
    insta::assert_snapshot!(
        refusal(BODY, "cells = 2", "cells = 0"),
        @"scene.toml:3: [mesh] cube: cells = 0: expected a whole number from 1 to 100"
    );
}

#[test]
fn too_many_cells() {
    insta::assert_snapshot!(
        refusal(BODY, "cells = 2", "cells = 1_000_000"),
        @"scene.toml:3: [mesh] cube: cells = 1_000_000: expected a whole number from 1 to 100"
    );
}

#[test]
fn half_a_cell() {
    insta::assert_snapshot!(
        refusal(BODY, "cells = 2", "cells = 2.5"),
        @"scene.toml:3: [mesh] cube: cells = 2.5: expected a whole number from 1 to 100, found a number"
    );
}

#[test]
fn no_edge() {
    insta::assert_snapshot!(
        refusal(BODY, "edge = 0.2", "edge = 0"),
        @"scene.toml:3: [mesh] cube: edge = 0: expected a finite length above 0 m"
    );
}

#[test]
fn edge_left_out() {
    insta::assert_snapshot!(
        refusal(BODY, "cells = 2, edge = 0.2", "cells = 2"),
        @"scene.toml:3: [mesh] cube: `edge` is missing: expected a finite length above 0 m"
    );
}

#[test]
fn unknown_split() {
    insta::assert_snapshot!(
        refusal(BODY, "edge = 0.2", "edge = 0.2, split = \"khun\""),
        @r#"
    scene.toml:3: [mesh] cube: split = "khun": expected "mirrored" or "kuhn"
    help: did you mean `kuhn`?
    "#
    );
}

#[test]
fn unknown_key_of_the_cube() {
    insta::assert_snapshot!(
        refusal(BODY, "edge = 0.2", "egde = 0.2"),
        @"
    scene.toml:3: [mesh] cube: unknown key `egde`; did you mean `edge`?
    help: the keys here are `cells`, `edge`, `split`
    "
    );
}

#[test]
fn cube_that_is_no_table() {
    insta::assert_snapshot!(
        refusal(BODY, "{ cells = 2, edge = 0.2 }", "10"),
        @"scene.toml:3: [mesh]: cube = 10: expected a table, found a whole number"
    );
}

#[test]
fn a_block_of_too_many_cells() {
    insta::assert_snapshot!(
        refusal(BLOCK, "[3, 1, 2]", "[1000, 1000, 2]"),
        @"scene.toml:2: [mesh] block: cells = [1000, 1000, 2]: expected three whole numbers above 0 with a product of at most 1000000"
    );
}

#[test]
fn a_block_of_two_numbers() {
    insta::assert_snapshot!(
        refusal(BLOCK, "[3, 1, 2]", "[3, 1]"),
        @"scene.toml:2: [mesh] block: cells = [3, 1]: expected three whole numbers above 0 with a product of at most 1000000"
    );
}

#[test]
fn a_block_without_cells_along_an_axis() {
    insta::assert_snapshot!(
        refusal(BLOCK, "[3, 1, 2]", "[3, 0, 2]"),
        @"scene.toml:2: [mesh] block: cells = [3, 0, 2]: expected three whole numbers above 0 with a product of at most 1000000"
    );
}

#[test]
fn a_block_without_height() {
    insta::assert_snapshot!(
        refusal(BLOCK, "[300, 50, 100]", "[300, 50, 0.0]"),
        @"scene.toml:2: [mesh] block: size = [300, 50, 0.0]: expected three finite lengths above 0 m"
    );
}

#[test]
fn a_block_too_small_for_its_cells() {
    insta::assert_snapshot!(
        refusal(BLOCK, "[300, 50, 100]", "[5e-324, 50, 100]"),
        @"scene.toml:2: [mesh]: 3 cells along x on an edge of 5e-324 cannot be told apart in floating point"
    );
}

#[test]
fn a_scale_of_nothing() {
    insta::assert_snapshot!(
        refusal(BLOCK, "scale = 0.001", "scale = 0"),
        @"scene.toml:3: [mesh]: scale = 0: expected a finite factor above 0, e.g. 0.001 for a mesh in millimetres"
    );
}

#[test]
fn a_scale_in_words() {
    insta::assert_snapshot!(
        refusal(BLOCK, "scale = 0.001", "scale = \"mm\""),
        @r#"scene.toml:3: [mesh]: scale = "mm": expected a finite factor above 0, e.g. 0.001 for a mesh in millimetres, found a string"#
    );
}

#[test]
fn a_scale_beyond_all_numbers() {
    insta::assert_snapshot!(
        refusal(BLOCK, "scale = 0.001", "scale = 1e307"),
        @"scene.toml:3: [mesh]: scale = 1e307: expected a factor that leaves all coordinates finite"
    );
}

#[test]
fn a_turn_about_nothing() {
    insta::assert_snapshot!(
        refusal(BLOCK, "[0, 0, 1]", "[0, 0, 0]"),
        @"scene.toml:4: [mesh] rotate: axis = [0, 0, 0]: expected [x, y, z], all finite, not all 0"
    );
}

#[test]
fn a_turn_by_nothing() {
    insta::assert_snapshot!(
        refusal(BLOCK, ", degrees = 90", ""),
        @"scene.toml:4: [mesh] rotate: `degrees` is missing: expected a finite angle in degrees"
    );
}

#[test]
fn a_turn_in_radians() {
    insta::assert_snapshot!(
        refusal(BLOCK, "degrees = 90", "radians = 1.57"),
        @"
    scene.toml:4: [mesh] rotate: unknown key `radians`
    help: the keys here are `axis`, `degrees`
    "
    );
}

#[test]
fn an_order_of_a_block() {
    insta::assert_snapshot!(
        refusal(BLOCK, "scale = 0.001", "order = \"linear\""),
        @"scene.toml:3: [mesh]: `order` goes with `file`: cubes and blocks are linear"
    );
}

#[test]
fn an_order_that_there_is_not() {
    insta::assert_snapshot!(
        refusal(BODY, "cube = { cells = 2, edge = 0.2 }", "file = \"a.msh\"\norder = 2"),
        @r#"scene.toml:4: [mesh]: order = 2: expected "linear", found a whole number"#
    );
    insta::assert_snapshot!(
        refusal(BODY, "cube = { cells = 2, edge = 0.2 }", "file = \"a.msh\"\norder = \"quadratic\""),
        @r#"scene.toml:4: [mesh]: order = "quadratic": expected "linear""#
    );
}
