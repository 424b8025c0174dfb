//! Mistakes in `[mesh]`.

use crate::refusal;
use crate::scenes::BODY;

#[test]
fn no_source() {
    insta::assert_snapshot!(
        refusal(BODY, "cube = { cells = 2, edge = 0.2 }", ""),
        @"scene.toml:2: [mesh]: expected exactly one of `file`, `cube`, found none"
    );
}

#[test]
fn two_sources() {
    insta::assert_snapshot!(
        refusal(BODY, "cube = {", "file = \"a.msh\"\ncube = {"),
        @"scene.toml:4: [mesh]: expected exactly one of `file`, `cube`, found `file`, `cube`"
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
        @r#"scene.toml:3: [mesh] cube: split = "khun": expected "kuhn" or "mirrored""#
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
