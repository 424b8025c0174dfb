//! Warnings of `sinew run` and `sinew plan`.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::sinew;
use sinew::mesh::Mesh;
use sinew::mesh::structured::{self, Split};

fn scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let files = [folder.join("hard"), folder]
        .into_iter()
        .flat_map(|folder| fs::read_dir(folder).unwrap())
        .map(|entry| entry.unwrap().path());
    files
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .collect()
}

/// The warnings of the plan, which are its last paragraph.
fn warned_by_plan(scene: &Path) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let said = sinew(folder.path(), &["plan", scene.to_str().unwrap()]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let lines = said.out.lines();
    let warnings = lines.skip_while(|line| !line.starts_with("warning "));
    let mut joined: Vec<String> = Vec::new();
    for line in warnings {
        // Lines that go on with a warning stand farther in.
        match (line.strip_prefix("              "), joined.last_mut()) {
            (Some(rest), Some(before)) => *before = format!("{before} {rest}"),
            _ => joined.push(line[12..].to_owned()),
        }
    }
    joined
}

fn warned_by_run(scene: &Path) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let said = sinew(folder.path(), &["run", scene.to_str().unwrap()]);
    let warnings = said
        .err
        .lines()
        .filter_map(|line| line.strip_prefix("warning: "));
    // What a motion does, no plan knows.
    const OF_MOTION: [&str; 5] = [
        "nothing keeps parts or surfaces of a body apart",
        "a principal strain of",
        "a rotation of about",
        "inside out at some instant",
        "that were put in",
    ];
    let of_motion = |warning: &&str| OF_MOTION.iter().any(|words| warning.contains(words));
    warnings
        .filter(|warning| !of_motion(warning))
        .map(str::to_owned)
        .collect()
}

#[test]
fn run_warns_of_all_that_the_plan_of_each_scene_warns_of() {
    let scenes = scenes();
    assert!(scenes.len() >= 18, "{scenes:?}");
    let mut warned = 0;
    for scene in scenes {
        let planned = warned_by_plan(&scene);
        assert_eq!(planned, warned_by_run(&scene), "{}", scene.display());
        warned += planned.len();
    }
    assert!(warned > 0, "no scene has a warning to compare");
}

const TAP: &str = r#"
[mesh]
file = "cube.msh"
[[region]]
group = "tissue"
density = 1060.0
model = "springs"
youngs_modulus = 3500.0
springs = { rule = "lloyd", damping_ratio = 0.1 }
[[fixed]]
group = "bottom"
[[load]]
group = "top"
traction = [0.0, 0.0, -0.1]
ramp = { kind = "pulse", from = 0.0131, to = 0.0137 }
[[probe]]
name = "top"
point = [0.05, 0.05, 0.1]
[run]
duration = 0.5
integrator = "newmark"
dt = 0.005
"#;

/// A cube with a node that belongs to no tetrahedron.
fn cube_and_a_stray_node() -> Mesh {
    let mut mesh = structured::cube(2, 0.1, Split::Kuhn).unwrap().to_mesh();
    mesh.points.push([1.0; 3]);
    mesh.node_tags.push(mesh.points.len() as u64);
    if let Some(entity) = mesh.node_entities.last().copied() {
        mesh.node_entities.push(entity);
    }
    mesh
}

#[test]
fn each_kind_of_warning_is_given_by_plan_and_by_run() {
    let cases: [(&str, &str, &[&str]); 4] = [
        ("", "", &["[[load]] 1 on `top` changes twice"]),
        (
            "newmark\"\ndt = 0.005",
            "central-difference\"\ndt = 0.02",
            &["times the stable step of", "changes twice"],
        ),
        (
            "newmark",
            "forward-euler",
            &["nothing is known about the step", "changes twice"],
        ),
        (
            "duration = 0.5",
            "duration = 0.004",
            &["after the run of 0.004 s", "is longer than the duration"],
        ),
    ];
    for (from, to, expected) in cases {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("tap.toml");
        assert!(TAP.contains(from));
        fs::write(&scene, TAP.replacen(from, to, 1)).unwrap();
        let mut file = fs::File::create(folder.path().join("cube.msh")).unwrap();
        sinew::mesh::write_msh41_ascii(&cube_and_a_stray_node(), &mut file).unwrap();
        let planned = warned_by_plan(&scene);
        assert_eq!(planned, warned_by_run(&scene), "{to}");
        assert_eq!(planned.len(), 1 + expected.len(), "{planned:?}");
        let expected = ["nodes in no tetrahedron, dropped"].iter().chain(expected);
        for (warning, expected) in planned.iter().zip(expected) {
            assert!(warning.contains(expected), "{warning}");
        }
    }
}

#[test]
fn strict_makes_warnings_errors_before_a_run_begins() {
    let folder = tempfile::tempdir().unwrap();
    let cube = "cube = { cells = 2, edge = 0.1 }";
    let tap = TAP.replace("file = \"cube.msh\"", cube);
    let quiet = tap.replace("from = 0.0131, to = 0.0137", "from = 0.1, to = 0.2");
    fs::write(folder.path().join("tap.toml"), tap).unwrap();
    fs::write(folder.path().join("quiet.toml"), quiet).unwrap();
    for command in ["plan", "run"] {
        let said = sinew(folder.path(), &[command, "tap.toml", "--strict"]);
        assert_eq!(said.code, Some(2), "{}", said.err);
        let last = said.err.lines().last().unwrap();
        assert_eq!(last, "error: 1 warning, which --strict makes an error");
        let rows = said.out.lines().filter(|line| line.starts_with("0.0,"));
        assert_eq!(rows.count(), 0, "nothing has run: {}", said.out);
        let said = sinew(folder.path(), &[command, "quiet.toml", "--strict"]);
        assert_eq!(said.code, Some(0), "{}", said.err);
    }
}

#[test]
fn a_plan_in_json_lists_its_warnings_with_their_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let cube = "cube = { cells = 2, edge = 0.1 }";
    let tap = TAP.replace("file = \"cube.msh\"", cube);
    fs::write(folder.path().join("tap.toml"), tap).unwrap();
    let said = sinew(folder.path(), &["plan", "tap.toml", "--json"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let plan: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    let warnings = plan["warnings"].as_array().unwrap();
    assert_eq!(warnings.len(), 1);
    assert_eq!(warnings[0]["kind"], "unresolved-load");
    assert_eq!(warnings[0]["numbers"]["dt_s"], 0.005);
    assert_eq!(plan["steps"], 100);
    let headings = plan["sections"].as_array().unwrap().iter();
    let headings: Vec<&str> = headings.map(|s| s["heading"].as_str().unwrap()).collect();
    assert_eq!(headings[..2], ["mesh", "regions"]);
}

#[test]
fn a_run_of_more_than_a_minute_is_warned_of_before_it_begins() {
    let folder = tempfile::tempdir().unwrap();
    let spring = "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = -5.0\n[run]\nduration = 1e9\n\
                  integrator = \"newmark\"\ndt = 0.01\n";
    fs::write(folder.path().join("spring.toml"), spring).unwrap();
    for arguments in [
        &["plan", "spring.toml"][..],
        &["run", "spring.toml"],
        &["run", "spring.toml", "--out", "long"],
    ] {
        let said = sinew(folder.path(), &[arguments, &["--strict"]].concat());
        assert_eq!(said.code, Some(2), "{}", said.err);
        let text = format!("{}{}", said.out, said.err);
        // The plan breaks its lines.
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(text.contains("the run is predicted to take"), "{text}");
        assert!(text.contains("100000000000 steps of 0.01 s"), "{text}");
        assert!(!folder.path().join("long").exists(), "no folder");
    }
    let said = sinew(folder.path(), &["plan", "spring.toml", "--json"]);
    let plan: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    let warning = &plan["warnings"][0];
    assert_eq!(warning["kind"], "long-run");
    assert!(warning["numbers"]["run_s"].as_f64().unwrap() > 60.0);
}

/// Fibres that catch a thrown cube: its stable step falls far below that at rest, of which this step is half.
const CAUGHT: &str = r#"
[mesh]
cube = { cells = 4, edge = 0.1, split = "kuhn" }
[[region]]
density = 1000.0
model = "stable-neo-hookean"
youngs_modulus = 5000.0
poissons_ratio = 0.4
fibres = { direction = [0, 0, 1], k1 = 2000.0, k2 = 20.0 }
[[fixed]]
group = "bottom"
[[initial]]
velocity = [0, 0, "20*z"]
[run]
duration = 0.5
integrator = "central-difference"
dt = 0.0005
[[probe]]
name = "corner"
point = [0.1, 0.1, 0.1]
"#;

#[test]
fn a_motion_with_energy_from_nothing_is_told_with_and_without_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("caught.toml"), CAUGHT).unwrap();
    for arguments in [
        &["run", "caught.toml"][..],
        &["run", "caught.toml", "--out", "out"],
    ] {
        // In the last steps some processors bring a fibre to its limit.
        let said = sinew(folder.path(), arguments);
        let mut warnings = said.err.lines();
        let told = |line: &str| {
            line.starts_with("warning: the motion has ") && line.ends_with("dt = \"auto\"")
        };
        assert!(warnings.any(told), "{arguments:?}: {}", said.err);
    }
    let follows = CAUGHT.replace("dt = 0.0005", "dt = \"auto\"");
    fs::write(folder.path().join("caught.toml"), follows).unwrap();
    let said = sinew(folder.path(), &["run", "caught.toml"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(!said.err.contains("the motion has"), "{}", said.err);
}

/// Saint Venant's tissue, stretched and released, with a step that is stable at rest, swings until it tears.
#[test]
fn a_step_that_the_body_outran_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let text = CAUGHT
        .replace(
            "fibres = { direction = [0, 0, 1], k1 = 2000.0, k2 = 20.0 }",
            "",
        )
        .replace("stable-neo-hookean", "stvk")
        .replace("velocity = [0, 0, \"20*z\"]", "velocity = [0, 0, \"30*z\"]")
        .replace("duration = 0.5", "duration = 1.0")
        .replace("dt = 0.0005", "dt = 0.0025");
    fs::write(folder.path().join("torn.toml"), text).unwrap();
    let said = sinew(folder.path(), &["run", "torn.toml"]);
    assert_eq!(said.code, Some(1), "{}", said.err);
    let told = said
        .err
        .contains("times the stable step of `central-difference` about the body as it is at t = ");
    assert!(told, "{}", said.err);
}
