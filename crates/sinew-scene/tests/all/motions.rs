//! Scenes in which parts of the body are moved.

use std::fs;
use std::path::Path;

use crate::common::{build, numbers};
use sinew_core::{Inputs, LinearSystem, State};
use sinew_scene::{ReactionOf, Scene, Simulation};

fn scene(moves: &str, damping: &str, run: &str) -> String {
    format!(
        r#"
[mesh]
cube = {{ cells = 2, edge = 0.1 }}
[[region]]
density = 1000.0
model = "linear"
youngs_modulus = 3500.0
poissons_ratio = 0.0
[damping]
{damping}
[[fixed]]
group = "bottom"
{moves}
[[probe]]
name = "top"
point = [0.05, 0.05, 0.1]
[run]
duration = 1.0
{run}
"#
    )
}

const PRESS: &str = "[[move]]\ngroup = \"top\"\ndisplacement = [0.0, 0.0, -0.01]\nramp = { kind = \"sin2\", rise = 0.2 }\n";
const NEWMARK: &str = "integrator = \"newmark\"\ndt = 0.02\n";

/// The state at the end, and the rows of the probes.
fn run(simulation: &Simulation, folder: &Path) -> (State, Vec<Vec<f64>>) {
    let (state, csv) = crate::common::run(simulation, folder);
    (state, csv.lines().skip(1).map(numbers).collect())
}

/// The three forms of a prescribed motion, each with its position along z over time.
#[test]
fn probes_on_moved_parts_show_the_way_they_are_moved() {
    let folder = tempfile::tempdir().unwrap();
    let table = "t_s,x_m,y_m,z_m\n0.1,0,0,0\n0.3,0.002,0,-0.01\n0.7,0,0,0\n";
    fs::write(folder.path().join("stroke.csv"), table).unwrap();
    let pi = std::f64::consts::PI;
    type Way<'a> = (&'a str, &'a dyn Fn(f64) -> [f64; 2]);
    let ways: [Way<'_>; 3] = [
        (PRESS, &|t| match t < 0.2 {
            true => [0.0, -0.01 * (pi / 2.0 * t / 0.2).sin().powi(2)],
            false => [0.0, -0.01],
        }),
        (
            "[[move]]\ngroup = \"top\"\nvelocity = [0.0, 0.0, -0.05]\n",
            &|t| [0.0, -0.05 * t],
        ),
        (
            "[[move]]\ngroup = \"top\"\ntable = \"stroke.csv\"\n",
            &|t| match t {
                ..0.1 => [0.0, 0.0],
                0.1..0.3 => [0.01 * (t - 0.1), -0.05 * (t - 0.1)],
                0.3..0.7 => [0.005 * (0.7 - t), -0.025 * (0.7 - t)],
                _ => [0.0, 0.0],
            },
        ),
    ];
    for (moves, expected) in ways {
        let path = folder.path().join("press.toml");
        fs::write(&path, scene(moves, "stiffness = 0.01", NEWMARK)).unwrap();
        let scene = Scene::load(&path).unwrap();
        let tables = usize::from(moves.contains("table"));
        assert_eq!(scene.input_files(), Scene::input_files_of(&path));
        assert_eq!(scene.input_files().len(), 1 + tables);
        let simulation = scene.build().unwrap();
        let (state, rows) = run(&simulation, folder.path());
        assert_eq!(rows.len(), 51);
        for row in &rows {
            let [x, z] = expected(row[0]);
            for (found, expected) in row[1..].iter().zip([x, 0.0, z]) {
                assert!((found - expected).abs() < 1e-15, "{moves} {row:?}");
            }
        }
        let [_, z] = expected(1.0);
        let shown: Vec<f64> = simulation.probes()[0]
            .displacement(state.t(), &state.u)
            .collect();
        assert!((shown[2] - z).abs() < 1e-15, "{shown:?}");
    }
}

#[test]
fn a_table_belongs_to_the_files_a_broken_scene_is_read_from() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("press.toml");
    let moves = "[[move]]\ngroup = \"top\"\ntable = \"../stroke.csv\"\nspeed = 3\n";
    fs::write(&path, scene(moves, "", NEWMARK)).unwrap();
    assert!(Scene::load(&path).is_err());
    let files = Scene::input_files_of(&path);
    assert_eq!(files, [path, folder.path().join("../stroke.csv")]);
}

/// Hooke's law, a static state after the motion has decayed: E A d/L at both ends.
#[test]
fn reactions_name_their_tables_and_bear_the_pull() {
    let folder = tempfile::tempdir().unwrap();
    let text = scene(PRESS, "mass = 60.0\nstiffness = 0.01", NEWMARK);
    let simulation = build(&text.replace("duration = 1.0", "duration = 4.0"));
    let (state, _) = run(&simulation, folder.path());
    let reactions = simulation.body().reactions(&state, Inputs::none()).unwrap();
    let [fixed, moved] = &reactions[..] else {
        panic!("{reactions:?}");
    };
    assert_eq!(
        (fixed.by, moved.by),
        (ReactionOf::Fixed(0), ReactionOf::Move(0))
    );
    assert_eq!(
        (fixed.on.to_string(), moved.by.to_string()),
        ("`bottom`".into(), "[[move]] 1".into())
    );
    let hookes = 3500.0 * 0.1 * 0.1 * 0.01 / 0.1;
    assert!(
        (fixed.force[2] / hookes - 1.0).abs() < 1e-9,
        "{reactions:?}"
    );
    assert!(
        (moved.force[2] / -hookes - 1.0).abs() < 1e-9,
        "{reactions:?}"
    );
}

#[test]
fn a_plan_says_what_is_moved() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("stroke.csv"),
        "t_s,x_m,y_m,z_m\n0,0,0,0\n0.5,0.01,0,0\n",
    )
    .unwrap();
    let moves = format!(
        "{}[[move]]\ngroup = \"sides\"\naxes = \"x\"\ntable = \"stroke.csv\"\n",
        PRESS.replace("group = \"top\"", "group = \"top\"\naxes = \"z\"")
    );
    let text = scene(&moves, "", NEWMARK).replace("[[fixed]]\ngroup = \"bottom\"\n", "");
    let path = folder.path().join("press.toml");
    fs::write(&path, text).unwrap();
    let plan = Scene::load(&path)
        .unwrap()
        .build()
        .unwrap()
        .plan()
        .to_string();
    let lines: Vec<&str> = plan.lines().collect();
    let at = lines
        .iter()
        .position(|line| line.starts_with("moves"))
        .unwrap();
    insta::assert_snapshot!(lines[at..at + 2].join("\n"), @r"
    moves       `top` in z, 9 nodes: to [0, 0, -0.01] m rising for 0.2 s
                `sides` in x, 24 nodes: by stroke.csv, 2 rows from 0 s to 0.5 s
    ");
    assert!(plan.contains("point, moved"), "{plan}");
}

/// The warnings of a simulation, one line each.
fn said(simulation: &Simulation) -> Vec<String> {
    let warnings = simulation.warnings();
    warnings.iter().map(ToString::to_string).collect()
}

#[test]
fn a_jump_without_damping_and_a_load_on_a_moved_part_are_warned_about() {
    let jump = PRESS.replace("kind = \"sin2\", rise = 0.2", "kind = \"step\"");
    let load = "[[load]]\nname = \"push\"\ngroup = \"top\"\ntraction = [0.0, 0.0, -9.0]\n[[load]]\ngroup = \"sides\"\npressure = 5.0\n";
    let simulation = build(&scene(&format!("{jump}{load}"), "mass = 2.0", NEWMARK));
    insta::assert_snapshot!(said(&simulation).join("\n"), @r#"
    [[move]] 1 of `top` jumps at t = 0 s, at infinite speed: waves start from it that no mesh resolves; a rise takes time
    [[load]] "push" falls on nodes of [[move]] 1 of `top`: there it changes the reaction and no motion
    [[load]] 2 on `sides` falls on nodes of [[move]] 1 of `top`: there it changes the reaction and no motion
    "#);
    assert!(build(&scene(PRESS, "", NEWMARK)).warnings().is_empty());
}

/// A method that does not support loads that change within its steps is refused, with the table at fault.
#[test]
fn a_motion_that_a_method_cannot_follow_is_refused_before_the_run() {
    let propagator =
        |kind: &str| format!("integrator = \"propagator\"\nkind = \"{kind}\"\ndt = 0.03\n");
    let late = PRESS.replace(
        "kind = \"sin2\", rise = 0.2",
        "kind = \"table\", times = [0.05, 0.2], values = [0.0, 1.0]",
    );
    let simulation = build(&scene(&late, "stiffness = 0.01", &propagator("chebyshev")));
    let refused = simulation.refused_load().unwrap();
    assert_eq!(
        (refused.load.as_str(), refused.instant),
        ("[[move]] 1 of `top`", 0.05)
    );
    assert!(said(&simulation).contains(&refused.to_string()));
    let rising = build(&scene(PRESS, "stiffness = 0.01", &propagator("two-step")));
    assert_eq!(rising.refused_load().unwrap().load, "[[move]] 1 of `top`");
    // Gravity keeps its name next to motions.
    let text = format!("gravity = [0.0, 0.0, -9.81]\n{}", scene(PRESS, "", NEWMARK));
    let loads = build(&text);
    let model = &loads.model().body().unwrap().model;
    assert_eq!(model.operators().loads().len(), 2);
    assert_eq!(model.item_of_load(0), Some(sinew_fem::Item::Gravity));
}
