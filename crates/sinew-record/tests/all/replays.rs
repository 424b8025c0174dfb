//! Results of sessions that are replayed from their logs.

use std::fs;
use std::path::Path;

use serde_json::Value;
use sinew_core::Options;
use sinew_record::{Companion, Ended, Request, RunFolder};
use sinew_scene::{Scene, SceneSource};
use sinew_world::{Command, Replay, World};

use crate::common::{run, table};

/// A cube under a load that acts from the beginning.
const TEXT: &str = "title = \"cube\"\n[mesh]\ncube = { cells = 3, edge = 0.1 }\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\n\
    youngs_modulus = 3000.0\npoissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n[[load]]\nname = \"press\"\ngroup = \"top\"\n\
    traction = [0.0, 0.0, -20.0]\n[run]\nduration = 0.1\nintegrator = \"newmark\"\ndt = 0.002\n[output]\nfields = { frames = 5 }\n";

fn scene() -> Scene {
    Scene::parse(SceneSource::new("scene.toml", TEXT)).unwrap()
}

fn steps(session: &mut World, count: usize) {
    for _ in 0..count {
        session.step().unwrap();
    }
}

#[test]
fn a_session_without_commands_leaves_the_tables_and_frames_of_the_run() {
    let place = tempfile::tempdir().unwrap();
    let (ran, again) = (place.path().join("ran"), place.path().join("again"));
    let mut simulation = scene().build().unwrap();
    simulation.end_at_duration();
    run(&ran, &simulation, &mut ());
    let mut session = World::new(scene()).unwrap();
    steps(&mut session, 50);
    let mut replay = Replay::new(scene(), session.log().clone()).unwrap();
    let end = RunFolder::replay(&again, &mut replay, &Request::default(), &mut ()).unwrap();
    assert_eq!((end.ended, end.steps, end.frames), (Ended::Finished, 50, 6));
    let files = ["probes.csv", "energy.csv", "reactions.csv", "fields.pvd"];
    let frame = fs::read_dir(ran.join("fields")).unwrap().last().unwrap();
    let frame = format!("fields/{}", frame.unwrap().file_name().to_string_lossy());
    for file in files.into_iter().chain([frame.as_str()]) {
        let [ran, again] = [&ran, &again].map(|folder| fs::read(folder.join(file)).unwrap());
        assert!(ran == again, "{file}");
    }
    assert!(again.join("report.html").exists() && again.join("summary.json").exists());
    let said = RunFolder::reopen(&again).unwrap_err().to_string();
    assert!(said.contains("with which no run can go on"), "{said}");
}

/// Loads scaled by commands, another step, and a reset before: the balance of mean acceleration is closed except for
/// rounding.
#[test]
fn a_driven_session_is_recorded_since_its_last_reset_and_its_energy_adds_up() {
    let place = tempfile::tempdir().unwrap();
    let mut session = World::new(scene()).unwrap();
    steps(&mut session, 7);
    session.command(Command::Reset).unwrap();
    let factor = |factor| Command::LoadFactor {
        load: "press".into(),
        factor,
    };
    for (command, count) in [
        (factor(2.5), 10),
        (Command::Dt(0.0015), 10),
        (factor(-1.0), 20),
    ] {
        steps(&mut session, 10);
        session.command(command).unwrap();
        steps(&mut session, count);
    }
    let mut replay = Replay::new(scene(), session.log().clone()).unwrap();
    let out = place.path().join("out");
    let end = RunFolder::replay(&out, &mut replay, &Request::default(), &mut ()).unwrap();
    assert_eq!((end.ended, end.steps), (Ended::Finished, 70));
    assert!(replay.world().state() == session.state());
    let rows = table(&out.join("energy.csv"));
    let t = &rows["t_s"];
    assert_eq!((t.len(), t[0]), (71, 0.0));
    assert!(t.windows(2).all(|pair| pair[0] < pair[1]), "time rises");
    let most = |name: &str| {
        rows[name]
            .iter()
            .fold(0.0, |most: f64, x| most.max(x.abs()))
    };
    assert!(
        most("remainder_J") < 1e-10 * most("elastic_J"),
        "{} {}",
        most("remainder_J"),
        most("elastic_J")
    );
    let pulls = table(&out.join("reactions.csv"));
    let at_the_end = *pulls["fixed_1_bottom_f_z_N"].last().unwrap();
    assert!(at_the_end.is_finite());
    let log = fs::read_to_string(out.join("session.log")).unwrap();
    assert_eq!(log, session.log().to_text());
}

fn summary(folder: &Path) -> Value {
    serde_json::from_slice(&fs::read(folder.join("summary.json")).unwrap()).unwrap()
}

/// An observer that ends a run at the first query after this time (s).
struct Impatient {
    from: f64,
    t: f64,
}

impl Companion for Impatient {
    fn is_interrupted(&self) -> bool {
        self.t >= self.from
    }

    fn progress(&mut self, _steps: usize, t: f64) {
        self.t = t;
    }
}

#[test]
fn a_session_names_the_methods_and_the_mean_step_of_what_was_repeated() {
    let place = tempfile::tempdir().unwrap();
    let mut session = World::new(scene()).unwrap();
    let to = |id: &str| Command::Integrator {
        id: id.to_owned(),
        options: Options::new(),
    };
    session.command(to("cnn-stabilised")).unwrap();
    steps(&mut session, 10);
    let recorded = |session: &World, name: &str, companion: &mut dyn Companion| {
        let mut replay = Replay::new(scene(), session.log().clone()).unwrap();
        let path = place.path().join(name);
        let end = RunFolder::replay(&path, &mut replay, &Request::default(), companion).unwrap();
        let report = fs::read_to_string(path.join("report.html")).unwrap();
        (end, summary(&path), report)
    };
    let (end, one, _) = recorded(&session, "one", &mut ());
    assert_eq!(end.stepping.methods_in_words(), "`cnn-stabilised`");
    assert_eq!(end.stepping.length_in_words(), "0.002 s");
    assert_eq!(
        (&one["integrator"], &one["dt_s"]),
        (&"cnn-stabilised".into(), &0.002.into())
    );
    session.command(to("newmark")).unwrap();
    session.command(Command::Dt(0.005)).unwrap();
    steps(&mut session, 10);
    let (end, two, report) = recorded(&session, "two", &mut ());
    assert!((end.stepping.dt() - 0.0035).abs() < 1e-15);
    assert_eq!(end.stepping.length_in_words(), "3.500e-3 s on average");
    let said = "several methods, `cnn-stabilised` and `newmark`";
    assert_eq!(end.stepping.methods_in_words(), said);
    assert!(report.contains(&said.replace('`', "")));
    assert!(report.contains("20 steps of 3.500e-3 s on average"));
    assert_eq!(two["integrator"], "several");
    assert!((two["dt_s"].as_f64().unwrap() - 0.0035).abs() < 1e-15);
    assert_eq!(two["options"], Value::Null);
    // What was switched after the interruption is no part of what was recorded.
    let mut companion = Impatient {
        from: 0.009,
        t: 0.0,
    };
    let (end, part, _) = recorded(&session, "part", &mut companion);
    assert!(matches!(end.ended, Ended::Interrupted { .. }) && end.steps < 10);
    assert_eq!(
        (&part["integrator"], &part["dt_s"]),
        (&"cnn-stabilised".into(), &0.002.into())
    );
}
