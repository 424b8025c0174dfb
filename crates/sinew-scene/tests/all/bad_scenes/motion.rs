//! Mistakes in `[[move]]` and in the tables it names.

use std::fs;

use sinew_scene::Scene;

use super::scenes::{MOVED, OSCILLATOR};
use super::{message, refusal};

const TOP: &str = "axes = \"z\"\ndisplacement = [0.0, 0.0, -0.01]";
const RAMP: &str = "ramp = { kind = \"sin2\", rise = 0.2 }\n";

#[test]
fn moved_and_held_in_the_same_direction() {
    insta::assert_snapshot!(
        refusal(MOVED, "axes = \"x\"\nvelocity = [0.05, 0.0, 0.0]", "axes = \"xy\"\nvelocity = [0.05, 0.01, 0.0]"),
        @"scene.toml:19: [[move]] 2: node 1 is already fixed in y; a direction can be fixed or moved, not both"
    );
}

#[test]
fn moved_twice() {
    insta::assert_snapshot!(
        refusal(MOVED, "group = \"bottom\"\naxes = \"x\"\nvelocity = [0.05, 0.0, 0.0]", "group = \"top\"\nvelocity = [0.0, 0.0, 0.1]"),
        @"scene.toml:19: [[move]] 2: node 19 is moved in z by motion 1 already"
    );
}

#[test]
fn unknown_group() {
    insta::assert_snapshot!(
        refusal(MOVED, "group = \"top\"", "group = \"tip\""),
        @r#"scene.toml:14: [[move]] 1: no group is named "tip", did you mean "top"?; the groups are "tissue" (dimension 3), "sides" (dimension 2), "top" (dimension 2), "bottom" (dimension 2)"#
    );
}

#[test]
fn unknown_key() {
    insta::assert_snapshot!(
        refusal(MOVED, TOP, "axis = \"z\"\ndisplacement = [0.0, 0.0, -0.01]"),
        @"
    scene.toml:15: [[move]] 1: unknown key `axis`; did you mean `axes`?
    help: the keys here are `group`, `where`, `axes`, `displacement`, `velocity`, `table`, `ramp`
    "
    );
}

#[test]
fn a_displacement_without_a_ramp() {
    insta::assert_snapshot!(
        refusal(MOVED, RAMP, ""),
        @r#"scene.toml:13: [[move]] 1: `ramp` is missing: expected a table such as { kind = "sin2", rise = 0.2 }"#
    );
}

#[test]
fn a_velocity_with_a_ramp() {
    insta::assert_snapshot!(
        refusal(MOVED, "velocity = [0.05, 0.0, 0.0]\n", "velocity = [0.05, 0.0, 0.0]\nramp = { kind = \"step\" }\n"),
        @"scene.toml:22: [[move]] 2: `ramp` goes with `displacement` only"
    );
}

#[test]
fn no_way_and_two_ways() {
    insta::assert_snapshot!(
        refusal(MOVED, "velocity = [0.05, 0.0, 0.0]\n", ""),
        @"scene.toml:18: [[move]] 2: expected exactly one of `displacement`, `velocity`, `table`, found none"
    );
    insta::assert_snapshot!(
        refusal(MOVED, RAMP, "velocity = [0.0, 0.0, 1.0]\n"),
        @"scene.toml:17: [[move]] 1: expected exactly one of `displacement`, `velocity`, `table`, found `displacement`, `velocity`"
    );
}

#[test]
fn a_way_along_an_axis_that_is_not_named() {
    insta::assert_snapshot!(
        refusal(MOVED, "displacement = [0.0, 0.0, -0.01]", "displacement = [0.0, 0.005, -0.01]"),
        @"scene.toml:16: [[move]] 1: 0.005 along y, which is not among the axes: expected 0"
    );
    insta::assert_snapshot!(
        refusal(MOVED, "velocity = [0.05, 0.0, 0.0]", "velocity = [0.05, 0.0, 0.1]"),
        @"scene.toml:21: [[move]] 2: 0.1 along z, which is not among the axes: expected 0"
    );
}

#[test]
fn a_jump_under_stiffness_damping() {
    insta::assert_snapshot!(
        refusal(MOVED, RAMP, "ramp = { kind = \"pulse\", from = 0.1, to = 0.4 }\n"),
        @"scene.toml:17: [[move]] 1: the position jumps at t = 0.1 s, and stiffness damping or dashpots would see an infinite velocity: let it rise over some time"
    );
}

#[test]
fn an_impossible_ramp() {
    insta::assert_snapshot!(
        refusal(MOVED, "rise = 0.2", "rise = 0.0"),
        @"scene.toml:17: [[move]] 1 ramp: rise = 0.0: expected a finite time above 0 s"
    );
}

#[test]
fn an_oscillator_is_not_moved() {
    let moved =
        "damping = 1.0\nvelocity = -5.0\n[[move]]\ngroup = \"base\"\nvelocity = [0.1, 0.0, 0.0]\n";
    insta::assert_snapshot!(
        refusal(OSCILLATOR, "damping = 1.0\nvelocity = -5.0\n", moved),
        @"scene.toml:6: `move` does not go with [oscillator]"
    );
}

/// The message about the scene whose top follows a table with these contents, or one that is missing; its folder
/// is shown as `<folder>`.
fn table_refusal(contents: Option<&str>) -> String {
    let folder = tempfile::tempdir().unwrap();
    if let Some(contents) = contents {
        fs::write(folder.path().join("stroke.csv"), contents).unwrap();
    }
    let path = folder.path().join("scene.toml");
    let text = MOVED.replace(RAMP, "");
    let text = text.replace("displacement = [0.0, 0.0, -0.01]", "table = \"stroke.csv\"");
    fs::write(&path, text).unwrap();
    let error = Scene::load(path).unwrap().build().unwrap_err();
    message(&error).replace(&folder.path().display().to_string(), "<folder>")
}

fn rows(rows: &str) -> String {
    table_refusal(Some(&format!("t_s,x_m,y_m,z_m\n{rows}")))
}

#[test]
fn no_such_table() {
    insta::assert_snapshot!(
        table_refusal(None),
        @"<folder>/scene.toml:16: [[move]] 1: <folder>/stroke.csv: cannot be read: No such file or directory (os error 2)"
    );
}

#[test]
fn a_table_with_other_columns() {
    insta::assert_snapshot!(
        table_refusal(Some("t,x,y,z\n0,0,0,0\n")),
        @r#"<folder>/scene.toml:16: [[move]] 1: <folder>/stroke.csv:1: the first line is "t,x,y,z": expected the names of the columns, t_s,x_m,y_m,z_m"#
    );
}

#[test]
fn a_table_whose_times_fall() {
    insta::assert_snapshot!(
        rows("0,0,0,0\n0.2,0,0,0.1\n0.1,0,0,0.2\n"),
        @"<folder>/scene.toml:16: [[move]] 1: <folder>/stroke.csv:4: t_s = 0.1 does not come after 0.2, the time of the row before"
    );
}

#[test]
fn a_table_with_gaps() {
    insta::assert_snapshot!(
        rows("0,0,0,0\n0.2,0,0,\n"),
        @r#"<folder>/scene.toml:16: [[move]] 1: <folder>/stroke.csv:3: z_m is "": expected a finite number"#
    );
    insta::assert_snapshot!(
        rows("0,0,0,0\n\n0.2,0,0,0\n"),
        @"<folder>/scene.toml:16: [[move]] 1: <folder>/stroke.csv:3: expected 4 numbers, t_s,x_m,y_m,z_m, found 0"
    );
}

#[test]
fn a_table_with_a_word_for_a_number() {
    insta::assert_snapshot!(
        rows("0,0,0,0\n0.2,0,0,deep\n"),
        @r#"<folder>/scene.toml:16: [[move]] 1: <folder>/stroke.csv:3: z_m is "deep": expected a finite number"#
    );
}

#[test]
fn a_table_without_rows() {
    insta::assert_snapshot!(
        rows(""),
        @"<folder>/scene.toml:16: [[move]] 1: <folder>/stroke.csv:1: there is no row below the names of the columns: expected at least one"
    );
}

#[test]
fn a_table_along_an_axis_that_is_not_named() {
    insta::assert_snapshot!(
        rows("0,0,0,0\n0.2,0.001,0,0\n"),
        @"<folder>/scene.toml:16: [[move]] 1: <folder>/stroke.csv:3: x_m = 0.001, but the axis is not among `axes`: expected 0"
    );
}

#[test]
fn a_table_that_does_not_begin_at_rest_under_stiffness_damping() {
    insta::assert_snapshot!(
        rows("0.1,0,0,0.001\n0.2,0,0,0\n"),
        @"<folder>/scene.toml:16: [[move]] 1: the position jumps at t = 0 s, and stiffness damping or dashpots would see an infinite velocity: let it rise over some time"
    );
}
