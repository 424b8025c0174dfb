//! `sinew run --replay`.

use std::fs;

use crate::common::sinew;
use sinew_scene::Scene;
use sinew_testkit::scenes::ROLLED;
use sinew_world::{Command, World};

/// A block under its weight, which a blade splits within .025 s.
const SPLIT: &str = "gravity = [3.0, 0.0, -5.0]\n[mesh]\ncube = { cells = 3, edge = 0.1 }\n[[region]]\ndensity = 1000.0\n\
    model = \"linear\"\nyoungs_modulus = 3000.0\npoissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n[[probe]]\nname = \"top\"\n\
    point = [0.0, 0.0, 0.1]\n[[tool]]\nname = \"blade\"\nshape = { blade = { length = 0.3 } }\nstart = [-0.02, 0.05, 0.05]\n\
    rotation = [1.5707963267948966, 0.0, 0.0]\nvelocity = [6.0, 0.0, 0.0]\n[cutting]\ntool = \"blade\"\n\
    [run]\nduration = 0.1\nintegrator = \"newmark\"\ndt = 0.002\n";

#[test]
fn the_probes_of_a_session_that_only_waits_are_those_of_the_run_also_after_cuts() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("split.toml"), SPLIT).unwrap();
    let mut session = World::new(Scene::load(path("split.toml")).unwrap()).unwrap();
    for _ in 0..7 {
        session.step().unwrap();
    }
    session.command(Command::Reset).unwrap();
    for _ in 0..50 {
        session.step().unwrap();
    }
    assert!(session.cuts().unwrap().changes > 1);
    fs::write(path("a.log"), session.log().to_text()).unwrap();
    let ran = sinew(folder.path(), &["run", "split.toml", "--probes", "ran.csv"]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    let replay = ["run", "split.toml", "--replay", "a.log", "--probes"];
    let said = sinew(folder.path(), &[&replay[..], &["again.csv"]].concat());
    assert_eq!(said.code, Some(0), "{}", said.err);
    let expected = "split.toml: the 50 steps since the last reset repeated, of 57 steps and 1 commands; t = 0.100000 s\n";
    assert!(said.out.starts_with(expected), "{}", said.out);
    let [ran, again] = ["ran.csv", "again.csv"].map(|name| fs::read_to_string(path(name)).unwrap());
    assert_eq!(again.lines().count(), 52);
    assert!(ran == again, "{again}");
}

#[test]
fn probes_alone_of_a_run_and_of_a_session_tell_that_the_body_is_in_itself() {
    let folder = tempfile::tempdir().unwrap();
    let probe = "[[probe]]\nname = \"end\"\npoint = [0.24, 0.0, 0.0]\n";
    fs::write(folder.path().join("rolled.toml"), [ROLLED, probe].concat()).unwrap();
    let mut session = World::new(Scene::load(folder.path().join("rolled.toml")).unwrap()).unwrap();
    for _ in 0..50 {
        session.step().unwrap();
    }
    fs::write(folder.path().join("a.log"), session.log().to_text()).unwrap();
    for more in [
        &["--probes", "ran.csv"][..],
        &["--replay", "a.log", "--probes", "again.csv"],
    ] {
        let said = sinew(folder.path(), &[&["run", "rolled.toml"][..], more].concat());
        assert_eq!(said.code, Some(0), "{}", said.err);
        assert!(said.err.contains("is in itself"), "{}", said.err);
    }
    fs::write(folder.path().join("split.toml"), SPLIT).unwrap();
    let said = sinew(folder.path(), &["plan", "split.toml", "--json"]);
    let plan: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    let sections = plan["sections"].as_array().unwrap();
    let apart = sections
        .iter()
        .find(|section| section["heading"] == "apart");
    assert!(
        apart.unwrap()["lines"]
            .to_string()
            .contains("only the faces of their cut keep them apart")
    );
}
