//! Mistakes in `where`.

use super::refusal;
use super::scenes::PLACED;

const FLOOR: &str = "where = { below = { z = 0.0 } }";

#[test]
fn a_place_that_hits_nothing() {
    insta::assert_snapshot!(
        refusal(PLACED, FLOOR, "where = { below = { z = -0.01 } }"),
        @"scene.toml:16: [[fixed]] 1: no node is at z <= -0.01 m; the body reaches from (0, 0, 0) to (0.2, 0.2, 0.2) m"
    );
}

#[test]
fn a_place_without_a_whole_triangle() {
    insta::assert_snapshot!(
        refusal(PLACED, "where = { face = { normal = [0.0, 0.0, 1.0], angle = 20.0 }, above = { x = 0.1 } }",
            "where = { above = { x = 0.2, y = 0.2, z = 0.2 } }"),
        @"scene.toml:18: [[load]] 1: no boundary triangle has only nodes at x >= 0.2 m and y >= 0.2 m and z >= 0.2 m; of these there are 1"
    );
}

#[test]
fn a_group_and_a_place() {
    insta::assert_snapshot!(
        refusal(PLACED, FLOOR, "group = \"bottom\"\nwhere = { below = { z = 0.0 } }"),
        @"scene.toml:16: [[fixed]] 1: `group` cannot be used with `where`; give one of the two"
    );
}

#[test]
fn no_condition() {
    insta::assert_snapshot!(refusal(PLACED, FLOOR, "where = {}"), @"scene.toml:16: [[fixed]] 1: where = {}: expected conditions such as { below = { z = 0.01 } }");
}

#[test]
fn an_unknown_condition() {
    insta::assert_snapshot!(refusal(PLACED, FLOOR, "where = { blow = { z = 0.0 } }"), @"
    scene.toml:16: [[fixed]] 1 where: unknown key `blow`; did you mean `below`?
    help: the keys here are `below`, `above`, `box`, `sphere`, `cylinder`, `plane`, `face`, `nodes`, `data`
    ");
}

#[test]
fn a_bound_without_an_axis() {
    insta::assert_snapshot!(refusal(PLACED, FLOOR, "where = { below = {} }"), @"scene.toml:16: [[fixed]] 1 where: below = {}: expected a coordinate along x, y or z such as { z = 0.01 }");
}

#[test]
fn a_box_with_its_corners_exchanged() {
    insta::assert_snapshot!(
        refusal(PLACED, FLOOR, "where = { box = [[0, 0, 0.1], [0.2, 0.2, 0.0]] }"),
        @"scene.toml:16: [[fixed]] 1 where: box = [[0, 0, 0.1], [0.2, 0.2, 0.0]]: expected two corners [[x, y, z], [x, y, z]] in m, the lower one first"
    );
}

#[test]
fn a_plane_without_a_direction() {
    insta::assert_snapshot!(
        refusal(PLACED, "normal = [0.0, 0.0, 1.0], within", "normal = [0, 0, 0], within"),
        @"scene.toml:21: [[move]] 1 where plane: normal = [0, 0, 0]: expected [x, y, z], all finite and not all 0"
    );
}

#[test]
fn a_node_that_the_file_does_not_have() {
    insta::assert_snapshot!(refusal(PLACED, "nodes = [27]", "nodes = [28]"), @"scene.toml:29: [[probe]] 1: no tetrahedron has a node with tag 28");
}

#[test]
fn a_cylinder_without_an_axis() {
    let with = |axis_to: &str| {
        format!(
            "where = {{ cylinder = {{ axis_from = [0.1, 0.1, 0.0], {axis_to}radius = 0.01 }} }}"
        )
    };
    insta::assert_snapshot!(
        refusal(PLACED, FLOOR, &with("axis_to = [0.1, 0.1, 0.0], ")),
        @"scene.toml:16: [[fixed]] 1 where cylinder: axis_to = [0.1, 0.1, 0.0]: expected [x, y, z] in m, all finite, at another place than `axis_from`"
    );
    insta::assert_snapshot!(
        refusal(PLACED, FLOOR, &with("")),
        @"scene.toml:16: [[fixed]] 1 where cylinder: `axis_to` is missing: expected [x, y, z] in m, all finite, at another place than `axis_from`"
    );
    insta::assert_snapshot!(
        refusal(PLACED, FLOOR, &with("axis_to = [0.1, 0.1, 1e200], ").replace("0.01", "0.0")),
        @"scene.toml:16: [[fixed]] 1 where cylinder: axis_to = [0.1, 0.1, 1e200]: expected [x, y, z] in m, all finite, at another place than `axis_from`"
    );
}

#[test]
fn a_face_for_a_region() {
    insta::assert_snapshot!(
        refusal(PLACED, "where = { box = [[0.0, 0.0, 0.0], [0.1, 0.2, 0.2]] }",
            "where = { face = { normal = [0, 0, 1], angle = 20 } }"),
        @"scene.toml:4: [[region]] 1 where: `face` chooses triangles of the boundary, and a region is made of tetrahedra"
    );
}

#[test]
fn the_rest_twice() {
    insta::assert_snapshot!(
        refusal(PLACED, "where = { box = [[0.0, 0.0, 0.0], [0.1, 0.2, 0.2]] }", "where = \"rest\""),
        @r#"scene.toml:10: [[region]] 2: where = "rest" is taken by [[region]] 1 on line 4"#
    );
}

#[test]
fn a_rest_of_nothing() {
    insta::assert_snapshot!(
        refusal(PLACED, "[0.1, 0.2, 0.2]", "[0.2, 0.2, 0.2]"),
        @"scene.toml:10: [[region]] 2: the other regions have all 48 tetrahedra and leave none"
    );
}

#[test]
fn places_that_overlap() {
    insta::assert_snapshot!(
        refusal(PLACED, "where = \"rest\"", "where = { above = { x = 0.0 } }"),
        @"scene.toml:10: [[region]] 2: tetrahedron 1 is in region 1 already; regions must not overlap"
    );
}

#[test]
fn tetrahedra_between_two_places() {
    insta::assert_snapshot!(
        refusal(PLACED, "where = \"rest\"", "where = { above = { x = 0.11 } }"),
        @"scene.toml:10: [[region]] 2: no tetrahedron has only nodes at x >= 0.11 m; of these there are 9"
    );
}
