//! Mistakes in the file as a whole.

use super::refusal;
use super::scenes::{BODY, OSCILLATOR};

#[test]
fn text_that_is_not_toml() {
    insta::assert_snapshot!(
        refusal(BODY, "density = 1060.0", "density = "),
        @"scene.toml:5: not TOML: string values must be quoted, expected literal string"
    );
}

#[test]
fn a_number_with_a_unit() {
    insta::assert_snapshot!(
        refusal(BODY, "density = 1060.0", "density = 1.06 g/cm3"),
        @"
    scene.toml:5: not TOML: string values must be quoted, expected literal string
    help: numbers have no units: they are in m, kg, s, N and Pa, so 6 kPa is 6000.0
    "
    );
}

#[test]
fn a_key_given_twice() {
    insta::assert_snapshot!(
        refusal(BODY, "density = 1060.0", "density = 1060.0\ndensity = 1060.0"),
        @"scene.toml:6: not TOML: duplicate key"
    );
}

#[test]
fn an_unknown_table() {
    insta::assert_snapshot!(
        refusal(BODY, "[damping]", "[dampening]"),
        @"
    scene.toml:9: unknown key `dampening`; did you mean `damping`?
    help: the keys here are `title`, `mesh`, `oscillator`, `region`, `damping`, `fixed`, `move`, `tool`, `cutting`, `load`, `gravity`, `initial`, `run`, `probe`, `output`
    "
    );
}

#[test]
fn a_title_that_is_no_text() {
    insta::assert_snapshot!(
        refusal(BODY, "title = \"a cube\"", "title = 7"),
        @"scene.toml:1: title = 7: expected a title in quotes, found a whole number"
    );
}

#[test]
fn neither_body_nor_oscillator() {
    insta::assert_snapshot!(
        refusal(BODY, "[mesh]\ncube = { cells = 2, edge = 0.2 }", ""),
        @"scene.toml: expected exactly one of `mesh`, `oscillator`, found none"
    );
}

#[test]
fn body_and_oscillator() {
    insta::assert_snapshot!(
        refusal(BODY, "[damping]", "[oscillator]\nmass = 1.0\n[damping]"),
        @"scene.toml:9: expected exactly one of `mesh`, `oscillator`, found `mesh`, `oscillator`"
    );
}

#[test]
fn no_run() {
    insta::assert_snapshot!(
        refusal(OSCILLATOR, "[run]\nduration = 1.0\nintegrator = \"newmark\"\ndt = 0.02", ""),
        @"scene.toml: `run` is missing: expected a table [run]"
    );
}

#[test]
fn a_number_for_a_table() {
    let run = "[run]\nduration = 1.0\nintegrator = \"newmark\"\ndt = 0.02\n";
    let without = OSCILLATOR.replace(run, "");
    insta::assert_snapshot!(
        refusal(&without, "[oscillator]", "run = 1\n[oscillator]"),
        @"scene.toml:1: run = 1: expected a table, found a whole number"
    );
}

#[test]
fn gravity_below_a_table() {
    insta::assert_snapshot!(
        refusal(BODY, "[[probe]]", "gravity = [0, 0, -9.81]\n[[probe]]"),
        @"
    scene.toml:24: [run]: unknown key `gravity`
    help: write `gravity` at the top of the file, before the first [table]
    "
    );
}

#[test]
fn gravity_that_is_not_a_number() {
    insta::assert_snapshot!(
        refusal(BODY, "title = \"a cube\"", "gravity = [0.0, 0.0, nan]"),
        @"scene.toml:1: gravity = [0.0, 0.0, nan]: expected [x, y, z] in m/s2, all finite"
    );
}

#[test]
fn numbers_for_a_list_of_tables() {
    let probe = "[[probe]]\nname = \"centre\"\npoint = [0.1, 0.1, 0.1]\n";
    let without = BODY.replace(probe, "");
    insta::assert_snapshot!(
        refusal(&without, "title = \"a cube\"", "probe = [1, 2]"),
        @"scene.toml:1: probe = 1: expected a list of tables, each under its own [[probe]], found a whole number"
    );
}

#[test]
fn gravity_in_words_below_a_table() {
    insta::assert_snapshot!(
        refusal(BODY, "mass = 80.0", "gravity = \"down\""),
        @"
    scene.toml:10: [damping]: unknown key `gravity`
    help: write `gravity` at the top of the file, before the first [table]
    "
    );
}
