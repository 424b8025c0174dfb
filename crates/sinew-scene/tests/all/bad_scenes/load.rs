//! Mistakes in `[[load]]`.

use super::refusal;
use super::scenes::BODY;

#[test]
fn nothing_acts() {
    insta::assert_snapshot!(
        refusal(BODY, "traction = [0.0, 0.0, -500.0]\n", ""),
        @"scene.toml:13: [[load]] 1: expected exactly one of `traction`, `pressure`, `force`, found none"
    );
}

#[test]
fn two_kinds() {
    insta::assert_snapshot!(
        refusal(BODY, "traction = [0.0, 0.0, -500.0]", "traction = [0.0, 0.0, -500.0]\npressure = 500.0"),
        @"scene.toml:17: [[load]] 1: expected exactly one of `traction`, `pressure`, `force`, found `traction`, `pressure`"
    );
}

#[test]
fn two_components() {
    insta::assert_snapshot!(
        refusal(BODY, "[0.0, 0.0, -500.0]", "[0.0, -500.0]"),
        @"scene.toml:16: [[load]] 1: traction = [0.0, -500.0]: expected [x, y, z] in Pa, all finite"
    );
}

#[test]
fn a_component_that_is_not_a_number() {
    insta::assert_snapshot!(
        refusal(BODY, "[0.0, 0.0, -500.0]", "[0.0, 0.0, nan]"),
        @"scene.toml:16: [[load]] 1: traction = [0.0, 0.0, nan]: expected [x, y, z] in Pa, all finite"
    );
}

#[test]
fn a_number_for_a_vector() {
    insta::assert_snapshot!(
        refusal(BODY, "[0.0, 0.0, -500.0]", "-500.0"),
        @"scene.toml:16: [[load]] 1: traction = -500.0: expected [x, y, z] in Pa, all finite, found a number"
    );
}

#[test]
fn infinite_pressure() {
    insta::assert_snapshot!(
        refusal(BODY, "traction = [0.0, 0.0, -500.0]", "pressure = -inf"),
        @"scene.toml:16: [[load]] 1: pressure = -inf: expected a finite number of Pa"
    );
}

#[test]
fn unknown_group() {
    insta::assert_snapshot!(
        refusal(BODY, "group = \"top\"", "group = \"roof\""),
        @r#"scene.toml:15: [[load]] 1: no group is named "roof"; the groups are "tissue" (dimension 3), "sides" (dimension 2), "top" (dimension 2), "bottom" (dimension 2)"#
    );
}

#[test]
fn traction_in_a_volume() {
    insta::assert_snapshot!(
        refusal(BODY, "group = \"top\"", "group = \"tissue\""),
        @"scene.toml:15: [[load]] 1: group `tissue` has cells of dimension 3, expected a group of triangles (dimension 2)"
    );
}

#[test]
fn a_load_on_held_nodes_only() {
    insta::assert_snapshot!(
        refusal(BODY, "group = \"top\"", "group = \"sides\""),
        @"scene.toml:15: [[load]] 1: all nodes of group `sides` are fixed, so the load has no effect"
    );
}

#[test]
fn the_same_name_twice() {
    insta::assert_snapshot!(
        refusal(BODY, "[run]", "[[load]]\nname = \"push\"\ngroup = \"top\"\nforce = [0, 0, 1]\n[run]"),
        @r#"scene.toml:21: [[load]] 2: name = "push" is taken by [[load]] 1 on line 14"#
    );
}

#[test]
fn the_name_of_gravity() {
    insta::assert_snapshot!(
        refusal(BODY, "name = \"push\"", "name = \"gravity\""),
        @r#"scene.toml:14: [[load]] 1: name = "gravity": expected a name other than "gravity""#
    );
}

#[test]
fn unknown_ramp() {
    insta::assert_snapshot!(
        refusal(BODY, "{ kind = \"step\" }", "{ kind = \"sine\" }"),
        @r#"
    scene.toml:17: [[load]] 1 ramp: kind = "sine": expected "step", "sin2", "pulse" or "table"
    help: a sine is written as { sine = { frequency = 5.0 } }
    "#
    );
}

#[test]
fn no_kind_of_ramp() {
    insta::assert_snapshot!(
        refusal(BODY, "{ kind = \"step\" }", "{ rise = 1.0 }"),
        @"scene.toml:17: [[load]] 1 ramp: expected exactly one of `kind`, `sine`, `table`, found none"
    );
}

#[test]
fn parameters_of_another_ramp() {
    for (ramp, foreign) in [
        (r#"kind = "step", rise = 1.0"#, "rise"),
        (r#"kind = "sin2", rise = 1.0, to = 1.0"#, "to"),
        (r#"kind = "pulse", from = 0, to = 1, values = []"#, "values"),
        (
            r#"kind = "table", times = [0], values = [0], from = 0"#,
            "from",
        ),
    ] {
        assert_eq!(
            refusal(BODY, r#"kind = "step""#, ramp),
            format!(
                "scene.toml:17: [[load]] 1 ramp: `{foreign}` does not go with this kind of ramp"
            )
        );
    }
}

#[test]
fn a_ramp_over_several_lines() {
    let pulse = "[load.ramp]\nkind = \"pulse\"\nfrom = 0.2\nto = 0.1";
    insta::assert_snapshot!(
        refusal(BODY, "ramp = { kind = \"step\" }", pulse),
        @"scene.toml:20: [[load]] 1 ramp: pulse from 0.2 s to 0.1 s: expected finite times with from < to"
    );
    let table = "[load.ramp]\nkind = \"table\"\nvalues = [1.0]\ntimes = [nan]";
    insta::assert_snapshot!(
        refusal(BODY, "ramp = { kind = \"step\" }", table),
        @"scene.toml:20: [[load]] 1 ramp: times = [nan]: expected a list of finite times in s"
    );
}

#[test]
fn no_rise() {
    insta::assert_snapshot!(
        refusal(BODY, "{ kind = \"step\" }", "{ kind = \"sin2\" }"),
        @"scene.toml:17: [[load]] 1 ramp: `rise` is missing: expected a finite time above 0 s"
    );
}

#[test]
fn a_rise_in_no_time() {
    insta::assert_snapshot!(
        refusal(BODY, "{ kind = \"step\" }", "{ kind = \"sin2\", rise = 0.0 }"),
        @"scene.toml:17: [[load]] 1 ramp: rise = 0.0: expected a finite time above 0 s"
    );
}

#[test]
fn a_pulse_backwards() {
    insta::assert_snapshot!(
        refusal(BODY, "{ kind = \"step\" }", "{ kind = \"pulse\", from = 0.2, to = 0.1 }"),
        @"scene.toml:17: [[load]] 1 ramp: pulse from 0.2 s to 0.1 s: expected finite times with from < to"
    );
}

#[test]
fn a_table_with_a_value_missing() {
    insta::assert_snapshot!(
        refusal(BODY, "{ kind = \"step\" }", "{ kind = \"table\", times = [0.0, 1.0], values = [1.0] }"),
        @"scene.toml:17: [[load]] 1 ramp: 2 times and 1 values: expected as many of each, at least one"
    );
}

#[test]
fn a_table_back_in_time() {
    insta::assert_snapshot!(
        refusal(BODY, "{ kind = \"step\" }", "{ kind = \"table\", times = [0.0, 1.0, 0.5], values = [1, 2, 3] }"),
        @"scene.toml:17: [[load]] 1 ramp: entry 2 of the table: expected finite numbers and increasing times"
    );
}

#[test]
fn a_group_whose_name_breaks_the_line() {
    let message = refusal(BODY, "group = \"top\"", "group = \"to\\np\"");
    assert_eq!(message.lines().count(), 1, "{message}");
    let start = "scene.toml:15: [[load]] 1: no group is named \"to p\"";
    assert!(message.starts_with(start), "{message}");
}

#[test]
fn following_traction() {
    insta::assert_snapshot!(
        refusal(BODY, "traction = [0.0, 0.0, -500.0]", "traction = [0.0, 0.0, -500.0]\nfollow = false"),
        @"scene.toml:17: [[load]] 1: `follow` goes with `pressure` only"
    );
}

#[test]
fn pressure_that_follows_a_linear_region() {
    insta::assert_snapshot!(
        refusal(BODY, "traction = [0.0, 0.0, -500.0]", "pressure = 500.0\nfollow = true"),
        @r#"scene.toml:17: [[load]] 1: `follow` needs a region of large deformation, such as `model = "neo-hookean"`"#
    );
}

#[test]
fn a_sine_that_is_none() {
    let sine = |keys: &str| refusal(BODY, "{ kind = \"step\" }", &format!("{{ sine = {keys} }}"));
    insta::assert_snapshot!(
        sine("{ frequency = 0.0 }"),
        @"scene.toml:17: [[load]] 1 ramp sine: frequency = 0.0: expected a finite frequency above 0 Hz"
    );
    insta::assert_snapshot!(
        sine("{ phase = 1.0 }"),
        @"scene.toml:17: [[load]] 1 ramp sine: `frequency` is missing: expected a finite frequency above 0 Hz"
    );
    insta::assert_snapshot!(
        sine("{ frequency = 1.0, phase = inf }"),
        @"scene.toml:17: [[load]] 1 ramp sine: phase = inf: expected a finite angle in rad"
    );
    insta::assert_snapshot!(
        sine("{ frequency = 1.0 }, kind = \"step\""),
        @"scene.toml:17: [[load]] 1 ramp: expected exactly one of `kind`, `sine`, `table`, found `kind`, `sine`"
    );
}

#[test]
fn a_third_value_at_one_time() {
    let table = "{ kind = \"table\", times = [0.0, 0.1, 0.1, 0.1], values = [0, 1, 2, 3] }";
    insta::assert_snapshot!(
        refusal(BODY, "{ kind = \"step\" }", table),
        @"scene.toml:17: [[load]] 1 ramp: entry 3 of the table is the third at t = 0.1 s: expected two at most, the value before a jump and that after it"
    );
}

#[test]
fn a_file_of_factors_that_is_not_there_or_none() {
    let folder = tempfile::tempdir().unwrap();
    let with = |written: &str| {
        let path = folder.path().join(written);
        refusal(
            BODY,
            "{ kind = \"step\" }",
            &format!("{{ table = {:?} }}", path.display().to_string()),
        )
        .replace(&folder.path().display().to_string(), "<folder>")
    };
    insta::assert_snapshot!(
        with("load.csv"),
        @"scene.toml:17: [[load]] 1: <folder>/load.csv: cannot be read: No such file or directory (os error 2)"
    );
    std::fs::write(
        folder.path().join("late.csv"),
        "t_s,factor\n0,0\n0.2,1\n0.1,0\n",
    )
    .unwrap();
    insta::assert_snapshot!(
        with("late.csv"),
        @"scene.toml:17: [[load]] 1: <folder>/late.csv:4: t_s = 0.1 does not come after 0.2, the time of the row before"
    );
    insta::assert_snapshot!(
        refusal(BODY, "{ kind = \"step\" }", "{ table = \"\" }"),
        @r#"scene.toml:17: [[load]] 1 ramp: table = "": expected the path of a CSV file, seen from the scene"#
    );
}
