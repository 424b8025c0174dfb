//! Mistakes in `[[tool]]` and in the tables it names.

use std::fs;

use sinew_scene::{Scene, SceneSource};

use super::scenes::{OSCILLATOR, TOUCHED};
use super::{message, refusal};

const WAY: &str = "start = [0.1, 0.1, 0.32]\nvelocity = [0.0, 0.0, -0.01]\n";

#[test]
fn no_name_and_a_name_that_heads_no_column() {
    insta::assert_snapshot!(
        refusal(TOUCHED, "name = \"probe\"\n", ""),
        @"scene.toml:10: [[tool]] 1: `name` is missing: expected a name made of letters, digits, `-` and `_`"
    );
    insta::assert_snapshot!(
        refusal(TOUCHED, "name = \"probe\"", "name = \"left, right\""),
        @r#"scene.toml:11: [[tool]] 1: name = "left, right": expected a name made of letters, digits, `-` and `_`"#
    );
}

#[test]
fn a_name_that_is_taken() {
    insta::assert_snapshot!(
        refusal(TOUCHED, "name = \"jaws\"", "name = \"probe\""),
        @r#"scene.toml:17: [[tool]] 2: name = "probe" is taken by [[tool]] 1 on line 11"#
    );
}

#[test]
fn unknown_key() {
    insta::assert_snapshot!(
        refusal(TOUCHED, "friction = 0.2", "fricton = 0.2"),
        @"
    scene.toml:15: [[tool]] 1: unknown key `fricton`; did you mean `friction`?
    help: the keys here are `name`, `shape`, `shapes`, `start`, `rotation`, `table`, `velocity`, `hold`, `friction`, `touches`, `starts_inside`, `grasp`, `body`
    "
    );
}

#[test]
fn no_shape_and_two_shapes() {
    let shape = "shape = { sphere = { radius = 0.11 } }";
    insta::assert_snapshot!(refusal(TOUCHED, &format!("{shape}\n"), ""), @"scene.toml:10: [[tool]] 1: `shape` is missing: expected a table such as { sphere = { radius = 0.006 } }");
    insta::assert_snapshot!(
        refusal(TOUCHED, shape, "shape = { sphere = { radius = 0.11 }, plane = {} }"),
        @"scene.toml:12: [[tool]] 1 shape: expected exactly one of `sphere`, `capsule`, `plane`, `box`, `blade`, found `sphere`, `plane`"
    );
    insta::assert_snapshot!(
        refusal(TOUCHED, shape, &format!("{shape}\nshapes = [{{ plane = {{}} }}]")),
        @"scene.toml:12: [[tool]] 1: `shape` cannot be used with `shapes`; give one of the two"
    );
    insta::assert_snapshot!(refusal(TOUCHED, shape, "shapes = []"), @"scene.toml:12: [[tool]] 1: shapes = []: expected a list of tables such as [{ sphere = { radius = 0.006 } }]");
    insta::assert_snapshot!(refusal(TOUCHED, shape, "shapes = { plane = {} }"), @"scene.toml:12: [[tool]] 1: `shapes` is one table: write a list of tables, as there may be several");
}

#[test]
fn impossible_shapes() {
    let radius = "radius = 0.11";
    insta::assert_snapshot!(refusal(TOUCHED, radius, "radius = 0.0"), @"scene.toml:12: [[tool]] 1 shape sphere: radius = 0.0: expected a radius above 0 m, up to 1e6 m");
    insta::assert_snapshot!(refusal(TOUCHED, "radius = 0.1, length = 0.02", "radius = 0.1"), @"scene.toml:18: [[tool]] 2 shapes 1 capsule: `length` is missing: expected a length above 0 m, up to 1e6 m");
    insta::assert_snapshot!(
        refusal(TOUCHED, "size = [0.2, 0.2, 0.2]", "size = [0.2, -0.2, 0.2]"),
        @"scene.toml:18: [[tool]] 2 shapes 2 box: size = [0.2, -0.2, 0.2]: expected [x, y, z] in m, all above 0 and at most 1e6"
    );
}

#[test]
fn no_way_and_two_ways_to_move() {
    insta::assert_snapshot!(refusal(TOUCHED, "velocity = [0.0, 0.0, -0.01]\n", ""), @"scene.toml:10: [[tool]] 1: expected exactly one of `table`, `velocity`, `hold`, found none");
    insta::assert_snapshot!(
        refusal(TOUCHED, "velocity = [0.0, 0.0, -0.01]\n", "velocity = [0.0, 0.0, -0.01]\nhold = true\n"),
        @"scene.toml:15: [[tool]] 1: expected exactly one of `table`, `velocity`, `hold`, found `velocity`, `hold`"
    );
    insta::assert_snapshot!(refusal(TOUCHED, "hold = true", "hold = false"), @"scene.toml:20: [[tool]] 2: hold = false: expected true");
}

#[test]
fn a_start_that_is_missing_or_beside_a_table() {
    insta::assert_snapshot!(refusal(TOUCHED, "start = [0.1, 0.1, 0.32]\n", ""), @"scene.toml:10: [[tool]] 1: `start` is missing: expected [x, y, z] in m, of at most 1e6");
    insta::assert_snapshot!(
        refusal(TOUCHED, "velocity = [0.0, 0.0, -0.01]", "table = \"probe.csv\""),
        @"scene.toml:13: [[tool]] 1: `start` cannot be used with `table`: the table has the positions and rotations; remove it"
    );
}

#[test]
fn numbers_out_of_range() {
    insta::assert_snapshot!(refusal(TOUCHED, "friction = 0.2", "friction = -0.2"), @"scene.toml:15: [[tool]] 1: friction = -0.2: expected a coefficient from 0 to 1e6");
    insta::assert_snapshot!(
        refusal(TOUCHED, "velocity = [0.0, 0.0, -0.01]", "velocity = [0.0, 0.0, nan]"),
        @"scene.toml:14: [[tool]] 1: velocity = [0.0, 0.0, nan]: expected [x, y, z] in m/s, of at most 1e6"
    );
    insta::assert_snapshot!(refusal(TOUCHED, "to = 1.2", "to = 0.4"), @"scene.toml:23: [[tool]] 2 grasp: to = 0.4: expected a time after `from`, 0.4 s");
    insta::assert_snapshot!(
        refusal(TOUCHED, "starts_inside = \"push\"", "starts_inside = \"warn\""),
        @r#"scene.toml:22: [[tool]] 2: starts_inside = "warn": expected "refuse" or "push""#
    );
}

#[test]
fn nothing_to_touch() {
    insta::assert_snapshot!(refusal(TOUCHED, "touches = \"sides\"", "touches = \"side\""), @r#"scene.toml:21: [[tool]] 2: no group is named "side", did you mean "sides"?; the groups are "tissue" (dimension 3), "sides" (dimension 2), "top" (dimension 2), "bottom" (dimension 2)"#);
    insta::assert_snapshot!(refusal(TOUCHED, "touches = \"sides\"", "touches = \"bottom\""), @"scene.toml:21: [[tool]] 2: the tool can touch no node: all 9 are fixed or have a prescribed motion");
}

#[test]
fn a_tool_that_begins_inside_the_body() {
    insta::assert_snapshot!(
        refusal(TOUCHED, "start = [0.1, 0.1, 0.32]", "start = [0.1, 0.1, 0.3]"),
        @r#"
    scene.toml:13: [[tool]] 1: the tool begins inside the body: node 23 is 0.01 m deep in it
    help: move it away, or say starts_inside = "push": the first step pushes the tissue out
    "#
    );
    let within = WAY.replace("0.32", "0.11");
    let small = TOUCHED.replace("radius = 0.11", "radius = 0.01");
    insta::assert_snapshot!(refusal(&small, WAY, &within), @"
    scene.toml:13: [[tool]] 1: the tool begins inside the body, in tetrahedron 25, and holds no node that it could push out
    help: move it out of the body
    ");
    insta::assert_snapshot!(
        refusal(&small, WAY, &format!("{within}starts_inside = \"push\"\n")),
        @"
    scene.toml:13: [[tool]] 1: the tool begins inside the body, in tetrahedron 25, and holds no node that it could push out
    help: move it out of the body
    "
    );
}

#[test]
fn an_oscillator_has_no_tools() {
    let touched = "damping = 1.0\nvelocity = -5.0\n[[tool]]\nname = \"probe\"\nshape = { plane = {} }\nstart = [0, 0, 0]\nhold = true\n";
    insta::assert_snapshot!(
        refusal(OSCILLATOR, "damping = 1.0\nvelocity = -5.0\n", touched),
        @"scene.toml:6: `tool` does not go with [oscillator]"
    );
}

/// The message about the scene whose probe follows a table with these contents, or one that is missing; its folder is
/// shown as `<folder>`.
fn table_refusal(contents: Option<&str>) -> String {
    let folder = tempfile::tempdir().unwrap();
    if let Some(contents) = contents {
        fs::write(folder.path().join("probe.csv"), contents).unwrap();
    }
    let path = folder.path().join("scene.toml");
    fs::write(&path, TOUCHED.replace(WAY, "table = \"probe.csv\"\n")).unwrap();
    let error = Scene::load(path).unwrap().build().unwrap_err();
    message(&error).replace(&folder.path().display().to_string(), "<folder>")
}

#[test]
fn tables_that_cannot_be_used() {
    insta::assert_snapshot!(table_refusal(None), @"<folder>/scene.toml:13: [[tool]] 1: <folder>/probe.csv: cannot be read: No such file or directory (os error 2)");
    insta::assert_snapshot!(table_refusal(Some("t_s,x_m,y_m\n0,0,0\n")), @r#"<folder>/scene.toml:13: [[tool]] 1: <folder>/probe.csv:1: the first line is "t_s,x_m,y_m": expected the names of the columns, t_s,x_m,y_m,z_m or t_s,x_m,y_m,z_m,rx_rad,ry_rad,rz_rad"#);
    insta::assert_snapshot!(
        table_refusal(Some("t_s,x_m,y_m,z_m,rx_rad,ry_rad,rz_rad\n0,0,0,1,0,0,0\n1,0,0,1\n")),
        @"<folder>/scene.toml:13: [[tool]] 1: <folder>/probe.csv:3: expected 7 numbers, t_s,x_m,y_m,z_m,rx_rad,ry_rad,rz_rad, found 4"
    );
    let rows = |rows: &str| table_refusal(Some(&format!("t_s,x_m,y_m,z_m\n{rows}")));
    insta::assert_snapshot!(rows("0,0,0,1\n0.5,0,0,1\n0.5,0,0,1\n"), @"<folder>/scene.toml:13: [[tool]] 1: <folder>/probe.csv:4: t_s = 0.5 does not come after 0.5, the time of the row before");
    insta::assert_snapshot!(rows("0,0,0,1\n0.5,0,0,1\n0.2,0,0,1\n"), @"<folder>/scene.toml:13: [[tool]] 1: <folder>/probe.csv:4: t_s = 0.2 does not come after 0.5, the time of the row before");
    insta::assert_snapshot!(rows("0,0,nan,1\n"), @r#"<folder>/scene.toml:13: [[tool]] 1: <folder>/probe.csv:2: y_m is "nan": expected a finite number"#);
    insta::assert_snapshot!(rows(""), @"<folder>/scene.toml:13: [[tool]] 1: <folder>/probe.csv:1: there is no row below the names of the columns: expected at least one");
    insta::assert_snapshot!(rows("0,0.1,0.1,0.2\n"), @r#"
    <folder>/scene.toml:13: [[tool]] 1: the tool begins inside the body: node 23 is 0.11 m deep in it
    help: move it away, or say starts_inside = "push": the first step pushes the tissue out
    "#);
}

#[test]
fn a_body_that_there_cannot_be() {
    let with = |body: &str| {
        let to = format!("friction = 0.2\nbody = {{ {body} }}");
        refusal(TOUCHED, "friction = 0.2", &to)
    };
    insta::assert_snapshot!(with("inertia = [1.0, 1.0, 1.0], coupling = 1.0, rotational_coupling = 1.0"), @"scene.toml:16: [[tool]] 1 body: `mass` is missing: expected a mass from 1e-15 kg to 1e15 kg");
    insta::assert_snapshot!(with("mass = 1.0, inertia = [1.0, 1.0, 0.0], coupling = 1.0, rotational_coupling = 1.0"), @"scene.toml:16: [[tool]] 1 body: inertia = [1.0, 1.0, 0.0]: expected [x, y, z] in kg m^2, all from 1e-30 to 1e15 and none larger than the sum of the other two, as it is for every body");
    insta::assert_snapshot!(with("mass = 1.0, inertia = [1.0, 1.0, 3.0], coupling = 1.0, rotational_coupling = 1.0"), @"scene.toml:16: [[tool]] 1 body: inertia = [1.0, 1.0, 3.0]: expected [x, y, z] in kg m^2, all from 1e-30 to 1e15 and none larger than the sum of the other two, as it is for every body");
    insta::assert_snapshot!(with("mass = 1.0, inertia = [1.0, 1.0, 1.0], coupling = -1.0, rotational_coupling = 1.0"), @"scene.toml:16: [[tool]] 1 body: coupling = -1.0: expected a stiffness from 0 N/m to 1e15 N/m");
}

#[test]
fn sizes_and_rotations_that_cannot_be_meant() {
    insta::assert_snapshot!(refusal(TOUCHED, "radius = 0.1, length = 0.02", "radius = 1e-12, length = 0.02"), @"scene.toml:18: [[tool]] 2 shapes 1 capsule: a radius or half a thickness of 1e-12 m, less than 1e-9 of the body, 0.2 m: expected more; are its lengths in m?");
    insta::assert_snapshot!(refusal(TOUCHED, "friction = 0.2", "friction = 0.2\nrotation = [0.0, 2e6, 0.0]"), @"scene.toml:16: [[tool]] 1: rotation = [0.0, 2e6, 0.0]: expected [rx, ry, rz] in rad, an angle of at most 1e6");
}

/// Errors have the lines of sizes and moments, not of the table that contains them.
#[test]
fn a_mistake_in_a_table_of_several_lines_has_its_own_line() {
    let body = "friction = 0.2\nbody = {\n  mass = 1.0,\n  inertia = [1.0, 1.0, 3.0],\n  coupling = 1.0, rotational_coupling = 1.0 }";
    insta::assert_snapshot!(refusal(TOUCHED, "friction = 0.2", body), @r#"scene.toml:18: [[tool]] 1 body: inertia = [1.0, 1.0, 3.0]: expected [x, y, z] in kg m^2, all from 1e-30 to 1e15 and none larger than the sum of the other two, as it is for every body"#);
    let shape = "shape = {\n  sphere = {\n    radius = 1e-12 } }";
    insta::assert_snapshot!(refusal(TOUCHED, "shape = { sphere = { radius = 0.11 } }", shape), @r#"scene.toml:14: [[tool]] 1 shape sphere: a radius or half a thickness of 1e-12 m, less than 1e-9 of the body, 0.2 m: expected more; are its lengths in m?"#);
    let dotted = "shape.sphere.radius = 1e-12";
    insta::assert_snapshot!(refusal(TOUCHED, "shape = { sphere = { radius = 0.11 } }", dotted), @r#"scene.toml:12: [[tool]] 1 shape sphere: a radius or half a thickness of 1e-12 m, less than 1e-9 of the body, 0.2 m: expected more; are its lengths in m?"#);
}

/// Squares and products of these numbers would overflow.
#[test]
fn numbers_beyond_all_bounds() {
    let body = |from: &str, to: &str| {
        let all = "mass = 1.0, inertia = [1.0, 1.0, 1.0], coupling = 1.0, rotational_coupling = 1.0, damping = 1.0";
        assert!(all.contains(from));
        let to = format!("friction = 0.2\nbody = {{ {} }}", all.replace(from, to));
        refusal(TOUCHED, "friction = 0.2", &to)
    };
    insta::assert_snapshot!(body("damping = 1.0", "damping = 1e300"), @r#"scene.toml:16: [[tool]] 1 body: damping = 1e300: expected a share from 0 to 1e6"#);
    for (from, to) in [
        ("mass = 1.0", "mass = 1e300"),
        ("mass = 1.0", "mass = 5e-324"),
        ("[1.0, 1.0, 1.0]", "[1e300, 1e300, 1e300]"),
        ("[1.0, 1.0, 1.0]", "[5e-324, 5e-324, 5e-324]"),
        (", coupling = 1.0", ", coupling = 1e300"),
        ("rotational_coupling = 1.0", "rotational_coupling = 1e300"),
    ] {
        let said = body(from, to);
        assert!(
            said.starts_with("scene.toml:16: [[tool]] 1 body: "),
            "{said}"
        );
    }
    for (from, to) in [
        ("radius = 0.11", "radius = 1e300"),
        ("radius = 0.11", "radius = 5e-324"),
        ("start = [0.1, 0.1, 0.32]", "start = [0.1, 0.1, 1e300]"),
        (
            "velocity = [0.0, 0.0, -0.01]",
            "velocity = [0.0, 0.0, -1e300]",
        ),
        ("friction = 0.2", "friction = 1e300"),
        ("length = 0.02", "length = 1e300"),
        ("size = [0.2, 0.2, 0.2]", "size = [0.2, 0.2, 1e300]"),
        ("at = [0.0, 0.0, 0.0]", "at = [0.0, 0.0, 1e300]"),
    ] {
        let said = refusal(TOUCHED, from, to);
        assert!(
            said.starts_with("scene.toml:1") && said.contains("expected"),
            "{said}"
        );
    }
    insta::assert_snapshot!(table_refusal(Some("t_s,x_m,y_m,z_m\n0,0,0,1e300\n")), @r#"<folder>/scene.toml:13: [[tool]] 1: at t = 0 s the tool is at [0.0, 0.0, 1e300] m: expected coordinates of at most 1e6 m"#);
}

#[test]
fn methods_that_tools_cannot_push() {
    let method = "integrator = \"symplectic-euler\"";
    insta::assert_snapshot!(refusal(TOUCHED, method, "integrator = \"newmark\""), @r#"scene.toml:26: [run]: `newmark`: this method does not support tools: contact needs one mass block for each node and a position update with the new velocity; take `central-difference` without `patches`, `symplectic-euler`, `cnn-symplectic`, `cnn-stabilised` with one block for each cell, or `cnn-energy` with kind = "ie""#);
    insta::assert_snapshot!(refusal(TOUCHED, method, "integrator = \"cnn-energy\"\nkind = \"trap\""), @r#"scene.toml:26: [run]: `cnn-energy`: this method does not support tools: contact needs one mass block for each node and a position update with the new velocity; take `central-difference` without `patches`, `symplectic-euler`, `cnn-symplectic`, `cnn-stabilised` with one block for each cell, or `cnn-energy` with kind = "ie""#);
    insta::assert_snapshot!(refusal(TOUCHED, method, &format!("{method}\nsaturation = \"auto\"")), @r#"scene.toml:27: [run]: `symplectic-euler`: tools do work that the limits of a guard do not know; take saturation = "off", or leave it out"#);
    insta::assert_snapshot!(refusal(TOUCHED, method, "integrator = \"rk4\""), @r#"scene.toml:26: [run]: `rk4`: this method does not support tools: contact needs one mass block for each node and a position update with the new velocity; take `central-difference` without `patches`, `symplectic-euler`, `cnn-symplectic`, `cnn-stabilised` with one block for each cell, or `cnn-energy` with kind = "ie""#);
}

/// Patches are made during the set-up of the method, since they depend on the body.
#[test]
fn patches_that_a_body_needs_and_tools_cannot_push() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../scenes/ready/slivers.toml"
    );
    let tool = "[[tool]]\nname = \"lid\"\nshape = { plane = {} }\nrotation = [3.14159, 0.0, 0.0]\nstart = [0.02, 0.02, 0.03]\nhold = true\n";
    let text = fs::read_to_string(path).unwrap() + tool;
    let scene = Scene::parse(SceneSource::new(path, text)).unwrap();
    let simulation = scene.build().unwrap();
    let mut integrator = simulation.integrator().unwrap();
    let refused = simulation.set_up(&mut *integrator).unwrap_err();
    let said = message(&refused).replace(path, "slivers.toml");
    insta::assert_snapshot!(said, @r#"slivers.toml:46: [run]: `central-difference`: this method does not support tools: contact needs one mass block for each node and a position update with the new velocity; take `central-difference` without `patches`, `symplectic-euler`, `cnn-symplectic`, `cnn-stabilised` with one block for each cell, or `cnn-energy` with kind = "ie""#);
}
