//! What is written of sessions that are repeated by their logs.

use std::fs;

use sinew_record::{Ended, Request, RunFolder};
use sinew_scene::{Scene, SceneSource};
use sinew_session::{Command, Replay, Session};

use crate::common::{run, table};

/// A cube under a load that is there from the beginning on.
const TEXT: &str = "title = \"cube\"\n[mesh]\ncube = { cells = 3, edge = 0.1 }\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\n\
    youngs_modulus = 3000.0\npoissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n[[load]]\nname = \"press\"\ngroup = \"top\"\n\
    traction = [0.0, 0.0, -20.0]\n[run]\nduration = 0.1\nintegrator = \"newmark\"\ndt = 0.002\n[output]\nfields = { frames = 5 }\n";

fn scene() -> Scene {
    Scene::parse(SceneSource::new("scene.toml", TEXT)).unwrap()
}

fn steps(session: &mut Session, count: usize) {
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
    let mut session = Session::new(scene()).unwrap();
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

/// Loads that are turned up and down, another step, and a reset before: the balance of mean acceleration is closed but for rounding.
#[test]
fn a_driven_session_is_recorded_since_its_last_reset_and_its_energy_adds_up() {
    let place = tempfile::tempdir().unwrap();
    let mut session = Session::new(scene()).unwrap();
    steps(&mut session, 7);
    session.command(Command::Reset).unwrap();
    let factor = |factor| Command::LoadFactor {
        load: "press".to_owned(),
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
    assert!(replay.session().state() == session.state());
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
