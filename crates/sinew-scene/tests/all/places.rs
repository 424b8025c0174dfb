//! Parts of a body chosen by position.

use crate::common::{build, numbers, run};
use sinew_scene::{Scene, SceneSource, Simulation};

const CUBE: &str = r#"gravity = [0.0, 0.0, -9.81]
[mesh]
cube = { cells = 4, edge = 0.1 }
[[region]]
density = 1060.0
model = "linear"
youngs_modulus = 3500.0
poissons_ratio = 0.3
[[fixed]]
group = "bottom"
[[move]]
group = "top"
axes = "x"
velocity = [0.01, 0.0, 0.0]
[[load]]
group = "sides"
pressure = 20.0
[[load]]
group = "top"
force = [0.0, 0.1, 0.0]
[[initial]]
group = "top"
velocity = [0.0, 0.0, 0.1]
[run]
duration = 0.1
integrator = "central-difference"
dt = 0.001
[[probe]]
name = "top"
point = [0.05, 0.05, 0.1]
"#;

/// The same parts chosen by position, each with another condition.
fn placed() -> String {
    let mut text = CUBE.to_owned();
    for (group, place) in [
        (
            "[[fixed]]\ngroup = \"bottom\"",
            "[[fixed]]\nwhere = { below = { z = 0.0 } }",
        ),
        (
            "[[move]]\ngroup = \"top\"",
            "[[move]]\nwhere = { box = [[0, 0, 0.09], [0.1, 0.1, 0.11]] }",
        ),
        (
            "[[load]]\ngroup = \"top\"",
            "[[load]]\nwhere = { face = { normal = [0, 0, 1], angle = 45 } }",
        ),
        (
            "[[initial]]\ngroup = \"top\"",
            "[[initial]]\nwhere = { plane = { point = [9, 9, 0.1], normal = [0, 0, -2], within = 0.001 } }",
        ),
        ("point = [0.05, 0.05, 0.1]", "where = { nodes = [113] }"),
        (
            "[[region]]\n",
            "[[region]]\nwhere = { sphere = { center = [0.05, 0.05, 0.05], radius = 0.1 } }\n",
        ),
    ] {
        assert_eq!(text.matches(group).count(), 1, "{group}");
        text = text.replace(group, place);
    }
    text
}

/// The last displacement of all nodes, and the probes.
fn result(simulation: &Simulation) -> (Vec<f64>, String) {
    let folder = tempfile::tempdir().unwrap();
    let (state, probes) = run(simulation, folder.path());
    (state.u, probes)
}

#[test]
fn a_run_with_places_has_the_bits_of_one_with_groups() {
    let (groups, places) = (build(CUBE), build(&placed()));
    assert_eq!(groups.system().dofs(), places.system().dofs());
    assert_eq!(result(&groups), result(&places));
    let (_, probes) = result(&places);
    let last = numbers(probes.lines().last().unwrap());
    assert!(last[1..].iter().all(|u| *u != 0.0), "{last:?}");
}

/// The pressure p on a face of area A pushes with p A, also if the face's nodes belong to other parts.
#[test]
fn pressure_on_a_place_pushes_with_its_area() {
    let text = CUBE.replace(
        "group = \"sides\"",
        "where = { face = { normal = [1, 0, 0], angle = 1 }, above = { z = 0.05 } }",
    );
    let simulation = build(&text);
    let body = simulation.model().body().unwrap();
    let facts = body.model.report().loads[0];
    let expected = 20.0 * 0.1 * 0.05;
    assert!((facts.asked[0] + expected).abs() < 1e-12, "{facts:?}");
    assert!(facts.asked[1].abs() + facts.asked[2].abs() < 1e-12);
    let [part] = &body.selected[..] else {
        unreachable!("one part is selected")
    };
    assert_eq!((part.by.as_str(), part.nodes), ("[[load]] 1", 15));
    assert!((part.area - 0.005).abs() < 1e-12);
}

/// Two halves of different density: the masses follow from the volumes.
#[test]
fn a_region_for_the_rest_takes_what_the_others_leave() {
    let halves = |first: &str, second: &str| {
        let region = |place: &str, density: f64| {
            format!(
                "[[region]]\nwhere = {place}\ndensity = {density}\nmodel = \"linear\"\n\
                 youngs_modulus = 3500.0\npoissons_ratio = 0.3\n"
            )
        };
        let text = format!(
            "[mesh]\ncube = {{ cells = 4, edge = 0.1 }}\n{}{}[run]\nduration = 1.0\n\
             integrator = \"newmark\"\ndt = 0.1\n",
            region(first, 1000.0),
            region(second, 2000.0)
        );
        let simulation = build(&text);
        let report = simulation.model().body().unwrap().model.report().clone();
        (report.mass, report.regions[1].tets)
    };
    // A quarter of 1 l with 1000 kg/m3, three quarters with 2000.
    let (mass, rest) = halves("{ below = { x = 0.025 } }", "\"rest\"");
    assert!((mass - 1.75).abs() < 1e-9, "{mass}");
    assert_eq!(rest, 6 * 48);
    // The rest may stand before the others.
    let (mass, upper) = halves("\"rest\"", "{ above = { z = 0.025 } }");
    assert!((mass - 1.75).abs() < 1e-9, "{mass}");
    assert_eq!(upper, 6 * 48);
}

#[test]
fn the_plan_says_what_a_place_hits() {
    let plan = build(&placed()).plan().to_string();
    let lines: Vec<&str> = plan
        .lines()
        .skip_while(|line| !line.starts_with("where"))
        .take_while(|line| !line.starts_with("regions"))
        .collect();
    insta::assert_snapshot!(lines.join("\n"), @"
    where       [[region]] 1: `tetrahedra within 0.1 m of (0.05, 0.05, 0.05)`: 125 nodes, 384
                  tetrahedra, 0.001 m3
                [[fixed]] 1: `nodes at z <= 0 m`: 25 nodes, 0.01 m2 of the surface
                [[move]] 1: `nodes at 0 <= x <= 0.1 m and 0 <= y <= 0.1 m and 0.09 <= z <= 0.11 m`: 25
                  nodes, 0.01 m2 of the surface
                [[load]] 2: `nodes facing (0, 0, 1) within 45 degrees`: 25 nodes, 0.01 m2 of the surface
                [[initial]] 1: `nodes within 0.001 m of the plane through (9, 9, 0.1) across (0, 0,
                  -2)`: 25 nodes, 0.01 m2 of the surface
                [[probe]] 1: `nodes tagged 113`: 1 node, 0 m2 of the surface
    ");
    // Groups of the scene are not listed as those of the mesh.
    let words: Vec<&str> = plan.split_whitespace().collect();
    let groups = "groups `tissue` (384 tetrahedra), `sides` (128 triangles), `top` (32 triangles), `bottom` (32 triangles) where";
    assert!(words.join(" ").contains(groups), "{plan}");
}

#[test]
fn a_place_follows_the_mesh_that_a_scene_is_built_on() {
    use sinew_mesh::structured::{Split, cube};
    let scene = Scene::parse(SceneSource::new("scene.toml", placed())).unwrap();
    let finer = scene.build_on(cube(8, 0.1, Split::Kuhn).unwrap()).unwrap();
    let body = finer.model().body().unwrap();
    let floor = body.selected.iter().find(|part| part.by == "[[fixed]] 1");
    let floor = floor.unwrap();
    assert_eq!(floor.nodes, 81);
    assert!((floor.area - 0.01).abs() < 1e-12);
}
