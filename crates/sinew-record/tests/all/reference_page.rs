//! The page on the folder of a run names exactly the files and values that runs write.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use serde_json::Value;
use sinew_record::{Companion, Ended, Request, RunEnd, RunFolder};
use sinew_scene::{Scene, SceneSource};
use sinew_world::{Replay, World};

use crate::common::build;

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/run-folder.md");

/// Names of each section of the page, or of each file of a folder.
type Names = BTreeMap<String, BTreeSet<String>>;

const BODY: &str = "[mesh]\ncube = { cells = 3, edge = 0.1, split = \"kuhn\" }\n[[fixed]]\ngroup = \"bottom\"\n[[probe]]\nname = \"tip\"\n\
    point = [0.0, 0.0, 0.1]\n[[region]]\ndensity = 1000.0\nyoungs_modulus = 3000.0\npoissons_ratio = 0.3\n";

const LOADED: &str = "model = \"linear\"\n[[load]]\nname = \"press\"\ngroup = \"top\"\ntraction = [0.0, 0.0, -20.0]\n\
    [run]\nduration = 0.02\nintegrator = \"newmark\"\ndt = 0.002\n";

/// A ball on a coupling, moved by a table, next to a moved part, with all optional fields and probes.
const TOUCHED: &str = "model = \"linear\"\n[[move]]\ngroup = \"top\"\naxes = \"x\"\ndisplacement = [0.01, 0.0, 0.0]\n\
    ramp = { kind = \"sin2\", rise = 0.1 }\n[[probe]]\nname = \"speed\"\npoint = [0.0, 0.0, 0.1]\nquantity = \"velocity\"\n\
    [[probe]]\nname = \"load\"\npoint = [0.0, 0.0, 0.1]\nquantity = \"stress\"\n[[tool]]\nname = \"ball\"\n\
    shape = { sphere = { radius = 0.05 } }\ntable = \"ball.csv\"\n\
    body = { mass = 0.1, inertia = [1e-3, 1e-3, 1e-3], coupling = 100.0, rotational_coupling = 1.0 }\n[run]\nduration = 0.02\n\
    integrator = \"central-difference\"\ndt = 0.001\n[output]\nacceleration = true\nstep_limit = true\n";

const BALL: &str =
    "t_s,x_m,y_m,z_m,rx_rad,ry_rad,rz_rad\n0,0.05,0.05,0.151,0,0,0\n0.02,0.05,0.05,0.145,0,0,0\n";

const CUT: &str = "model = \"linear\"\n[[tool]]\nname = \"blade\"\nshape = { blade = { length = 0.3 } }\nstart = [-0.02, 0.05, 0.05]\n\
    rotation = [1.5707963267948966, 0.0, 0.0]\nvelocity = [6.0, 0.0, 0.0]\n[cutting]\ntool = \"blade\"\n[run]\nduration = 0.03\n\
    integrator = \"newmark\"\ndt = 0.002\n";

const RELAXING: &str = "model = \"neo-hookean\"\nprony = [[0.3, 0.05]]\n[run]\nduration = 0.02\n\
    integrator = \"central-difference\"\ndt = 0.001\n";

/// A scene far beyond its stable step, so that surfaces pass through each other.
const WILD: &str = "model = \"linear\"\n[[load]]\ngroup = \"top\"\ntraction = [0.0, 0.0, -20.0]\n[run]\nduration = 10.0\n\
    integrator = \"central-difference\"\ndt = 0.1\n";

const OSCILLATOR: &str = "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 0.1\nvelocity = 1.0\n[run]\nduration = 0.1\n\
    integrator = \"newmark\"\ndt = 0.01\n";

struct Interrupted;

impl Companion for Interrupted {
    fn is_interrupted(&self) -> bool {
        true
    }
}

fn run(path: &Path, text: &str, companion: &mut dyn Companion) -> RunEnd {
    let simulation = build(text);
    let request = Request {
        threads: Some("1".to_owned()),
        warnings: vec!["beware".to_owned()],
        values: vec!["run.dt=0.002".to_owned()],
        again: true,
    };
    let folder = RunFolder::create(path, &simulation, &request).unwrap();
    folder
        .run(&mut crate::common::world(&simulation), companion)
        .unwrap()
}

#[test]
fn the_page_names_every_file_column_array_and_key_and_no_others() {
    let place = tempfile::tempdir().unwrap();
    let path = |name: &str| place.path().join(name);
    let body = |more: &str| format!("{BODY}{more}");
    fs::write(path("ball.csv"), BALL).unwrap();
    let table = path("ball.csv").display().to_string();
    let touched = body(TOUCHED).replace("ball.csv", &table);
    for (name, text) in [
        ("loaded", body(LOADED)),
        ("touched", touched),
        ("cut", body(CUT)),
        ("relaxing", body(RELAXING)),
        ("oscillator", OSCILLATOR.to_owned()),
    ] {
        assert_eq!(run(&path(name), &text, &mut ()).ended, Ended::Finished);
    }
    let wild = run(&path("wild"), &body(WILD), &mut ()).ended;
    assert!(matches!(wild, Ended::Diverged { .. }), "{wild:?}");
    let stopped = run(&path("stopped"), &body(LOADED), &mut Interrupted).ended;
    assert!(matches!(stopped, Ended::Interrupted { .. }), "{stopped:?}");
    let scene = || Scene::parse(SceneSource::new("scene.toml", body(LOADED))).unwrap();
    let mut session = World::new(scene()).unwrap();
    session.step().unwrap();
    let mut replay = Replay::new(scene(), session.log().clone()).unwrap();
    RunFolder::replay(&path("replay"), &mut replay, &Request::default(), &mut ()).unwrap();

    let mut left = Names::new();
    for entry in fs::read_dir(place.path()).unwrap() {
        let folder = entry.unwrap().path();
        if folder.is_dir() {
            look(&folder, &folder, &mut left);
        }
    }
    let mut page = names_of_page();
    // No scene here is refused, and no method remarks anything.
    let summary = page.get_mut("summary.json").unwrap();
    for unseen in ["refused.t_s", "refused.reason", "computer.remarks[]"] {
        assert!(summary.remove(unseen), "{unseen}");
    }
    for (section, names) in &left {
        let named = page.get(section).cloned().unwrap_or_default();
        let missing: Vec<_> = names.difference(&named).collect();
        assert!(
            missing.is_empty(),
            "{section}: {missing:?} are not in {PAGE}"
        );
    }
    for (section, named) in &page {
        let names = left.get(section).cloned().unwrap_or_default();
        let stale: Vec<_> = named.difference(&names).collect();
        assert!(stale.is_empty(), "{section}: no run leaves {stale:?}");
    }
}

/// The names in the first columns of the page's tables, by their headings.
fn names_of_page() -> Names {
    let (mut names, mut section) = (Names::new(), String::new());
    for line in fs::read_to_string(PAGE).unwrap().lines() {
        if let Some(heading) = line.strip_prefix("##") {
            section = heading.trim_start_matches('#').trim().to_owned();
        } else if let Some(row) = line.strip_prefix("| `") {
            let (first, _) = row.split_once(" | ").unwrap();
            let of_section: &mut BTreeSet<String> = names.entry(section.clone()).or_default();
            for name in first.split('`').step_by(2) {
                assert!(of_section.insert(name.to_owned()), "{name} twice");
            }
        }
    }
    names
}

/// Adds the names of the files in a folder and of their contents.
fn look(folder: &Path, root: &Path, names: &mut Names) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            look(&path, root, names);
            continue;
        }
        let name = path
            .strip_prefix(root)
            .unwrap()
            .to_str()
            .unwrap()
            .to_owned();
        let name = match name.starts_with("fields/frame-") {
            true => "fields/frame-00000.vtu".to_owned(),
            false => name,
        };
        names
            .entry("Files".to_owned())
            .or_default()
            .insert(name.clone());
        let bytes = fs::read(&path).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        let found = match name.rsplit('.').next().unwrap() {
            "csv" => columns(&text),
            "vtu" => arrays(&text, name == "surface.vtu"),
            "json" if name != "manifest.json" => {
                let mut keys = BTreeSet::new();
                add_keys(
                    &serde_json::from_str(&text).unwrap(),
                    String::new(),
                    &mut keys,
                );
                keys
            }
            _ => continue,
        };
        names.entry(name).or_default().extend(found);
    }
}

/// Columns of a table, with placeholders for names of the scenes above.
fn columns(text: &str) -> BTreeSet<String> {
    let head = text.lines().find(|line| !line.starts_with('#')).unwrap();
    let general = |column: &str| {
        let of_scene = [
            ("ball_", "<tool>_"),
            ("blade_", "<tool>_"),
            ("speed_", "<probe>_"),
            ("load_", "<probe>_"),
            ("tip_", "<probe>_"),
            ("mass_", "<probe>_"),
            ("fixed_1_bottom_", "<support>_"),
            ("move_1_top_", "<support>_"),
        ];
        let known = of_scene.iter().find_map(|(name, stands)| {
            let rest = column.strip_prefix(name)?;
            Some(format!("{stands}{rest}"))
        });
        known.unwrap_or_else(|| column.to_owned())
    };
    head.split(',').map(general).collect()
}

/// Arrays at points and in cells.
fn arrays(text: &str, has_groups: bool) -> BTreeSet<String> {
    let of = |kind: &str| -> BTreeSet<String> {
        let (_, data) = text.split_once(&format!("<{kind}>")).unwrap_or_default();
        let data = data.split(&format!("</{kind}>")).next().unwrap();
        let names = data.split("Name=\"").skip(1);
        names
            .map(|name| name.split('"').next().unwrap().to_owned())
            .collect()
    };
    let (mut points, mut cells) = (of("PointData"), of("CellData"));
    if has_groups && !cells.is_empty() {
        cells = BTreeSet::from(["<group>".to_owned()]);
    }
    points.append(&mut cells);
    points
}

/// Keys of an object and of those within it; lists of numbers, the stored request and the options of a method are
/// values.
fn add_keys(value: &Value, key: String, keys: &mut BTreeSet<String>) {
    match value {
        Value::Null => {}
        Value::Object(entries) if key != "repeat" && key != "options" => {
            for (name, value) in entries {
                let dot = if key.is_empty() { "" } else { "." };
                add_keys(value, format!("{key}{dot}{name}"), keys);
            }
        }
        Value::Array(entries) if !entries.iter().any(Value::is_number) => {
            for entry in entries {
                add_keys(entry, format!("{key}[]"), keys);
            }
        }
        _ => {
            keys.insert(key);
        }
    }
}
