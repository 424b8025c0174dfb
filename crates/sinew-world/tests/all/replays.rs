//! Sessions repeated from their logs: every state has the same bits.

use std::path::Path;

use crate::common::{CUBE, scene, session};
use proptest::prelude::Rng;
use proptest::test_runner::{RngAlgorithm, TestRng};
use sinew_core::Options;
use sinew_world::{Command, Log, Replay, World};

/// Random numbers, the same in every run.
struct Dice(TestRng);

impl Dice {
    fn new() -> Self {
        Self(TestRng::deterministic_rng(RngAlgorithm::ChaCha))
    }

    fn share(&mut self) -> f64 {
        f64::from(self.0.next_u32()) / f64::from(u32::MAX)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + self.share() * (high - low)
    }

    fn of<T: Clone>(&mut self, list: &[T]) -> T {
        list[self.0.next_u32() as usize % list.len()].clone()
    }
}

/// A random command, possibly one that is refused.
fn command(dice: &mut Dice) -> Command {
    match dice.0.next_u32() % 24 {
        20 => Command::Grasp {
            tool: dice.of(&["ball", "plate", "needle"]).into(),
        },
        21 => Command::Release {
            tool: dice.of(&["ball", "plate", "needle"]).into(),
        },
        22 | 23 => {
            let force = |_| {
                (
                    dice.0.next_u32() % 66,
                    [0; 3].map(|_| dice.between(-0.02, 0.02)),
                )
            };
            Command::Forces((0..3).map(force).collect())
        }
        0..=9 => Command::Pose {
            tool: dice.of(&["ball", "ball", "plate", "needle"]).into(),
            position: [
                dice.between(0.0, 0.06),
                dice.between(0.0, 0.06),
                dice.between(0.06, 0.09),
            ],
            rotation_vector: [0; 3].map(|_| dice.between(-4.0, 4.0)),
        },
        10..=13 => Command::LoadFactor {
            load: dice.of(&["pull", "load 2", "gravity", "push"]).into(),
            factor: dice.between(-1.0, 2.0),
        },
        14 | 15 => Command::Integrator {
            id: dice
                .of(&[
                    "symplectic-euler",
                    "central-difference",
                    "cnn-symplectic",
                    "cnn-stabilised",
                    "newmark",
                ])
                .to_owned(),
            options: Options::new(),
        },
        16 | 17 => Command::Dt(dice.of(&[1e-3, 2e-3, 0.0015, 1.0 / 600.0, 3e-3, 0.02, 0.0])),
        18 => Command::Reset,
        // Flat, upright or turned on itself; through the cube, a part of it, or beside.
        _ => Command::Cut {
            from: [0; 2].map(|_| [0; 3].map(|_| dice.between(-0.03, 0.09))),
            to: [0; 2].map(|_| [0; 3].map(|_| dice.between(-0.03, 0.09))),
        },
    }
}

/// All data that determine the motion. The loads that led to a state are not among them, and a command changes them
/// between two steps.
fn bytes(session: &World) -> Vec<u8> {
    let mut state = session.state().clone();
    state.loads = None;
    state.to_bytes(session.body().system()).unwrap()
}

#[test]
fn thousands_of_random_commands_are_repeated_bit_for_bit() {
    repeated(CUBE, 4000);
}

#[test]
fn so_are_cuts_by_hand_while_a_blade_and_a_burner_go_their_way() {
    let text = CUBE.replace(
        "[run]",
        "[[tool]]\nname = \"blade\"\nshape = { blade = { length = 0.1 } }\nstart = [0.03, 0.03, 0.12]\nvelocity = [0.01, 0.0, -0.2]\n\
         rotation = [1.5707963267948966, 0.0, 0.0]\n[[tool]]\nname = \"burner\"\nshape = { sphere = { radius = 0.01 } }\n\
         start = [0.0, 0.0, 0.1]\nvelocity = [0.05, 0.05, -0.1]\n[cutting]\nsnap = 0.25\ntool = \"blade\"\nremove = { tool = \"burner\" }\n\
         pieces = \"remove\"\n[run]",
    );
    repeated(&text, 400);
}

/// Steers a scene with random commands, and repeats the session from its log.
fn repeated(text: &str, commands: usize) {
    let (mut session, mut dice) = (session(text), Dice::new());
    let (mut states, mut refused, mut failed) = (vec![bytes(&session)], 0, 0);
    for _ in 0..commands {
        refused += usize::from(session.command(command(&mut dice)).is_err());
        if session.step().is_err() {
            failed += 1;
            if session.steps() == states.len() {
                states.push(bytes(&session));
            }
            session.command(Command::Reset).unwrap();
        } else {
            states.push(bytes(&session));
        }
    }
    assert!(
        refused > commands / 20 && failed > commands / 1000,
        "{refused} {failed}"
    );
    assert!(session.log().entries().len() > commands / 2);
    let read = Log::parse(Path::new("s.log"), &session.log().to_text()).unwrap();
    assert_eq!(read, *session.log());
    for part in parts(&session) {
        let log = Log::parse(Path::new("s.log"), &part.text).unwrap();
        let mut replay = Replay::new(scene(text), log.clone()).unwrap();
        // What came before a reset is not repeated.
        assert_eq!(replay.world().steps(), part.begins);
        assert!(bytes(replay.world()) == states[0]);
        while replay.step().unwrap().is_some() {
            let step = replay.world().steps();
            assert!(bytes(replay.world()) == states[step], "step {step}");
        }
        assert_eq!(replay.world().steps(), part.ends);
        assert_eq!(replay.world().log(), &log);
    }
    let mut replay = Replay::new(scene(text), read).unwrap();
    while replay.step().unwrap().is_some() {}
    assert!(bytes(replay.world()) == bytes(&session));
    assert_eq!(replay.world().log(), session.log());
}

/// A session up to before one of its resets, or to its end.
struct Part {
    /// Number of steps before the reset with which it begins.
    begins: usize,
    ends: usize,
    /// The log.
    text: String,
}

fn parts(session: &World) -> Vec<Part> {
    let (text, entries) = (session.log().to_text(), session.log().entries());
    let lines: Vec<&str> = text.lines().collect();
    let head = lines.len() - entries.len() - 1;
    let resets = (0..).zip(entries);
    let resets = resets.filter(|(_, entry)| entry.command == Command::Reset);
    let ends = resets.map(|(place, entry)| (place, entry.step));
    let mut begins = 0;
    let ends = ends.chain([(entries.len(), session.steps())]);
    ends.map(|(place, ends)| Part {
        begins: std::mem::replace(&mut begins, ends),
        ends,
        text: format!("{}\n{ends} end\n", lines[..head + place].join("\n")),
    })
    .collect()
}

#[test]
fn a_course_has_the_methods_and_the_mean_step_of_what_was_taken_since_the_reset() {
    let mut session = session(CUBE);
    let to = |id: &str| Command::Integrator {
        id: id.to_owned(),
        options: Options::new(),
    };
    session.step().unwrap();
    session.command(to("cnn-stabilised")).unwrap();
    session.step().unwrap();
    session.command(Command::Reset).unwrap();
    session.command(to("central-difference")).unwrap();
    let first = session.steps();
    let replayed = |session: &mut World, command, steps| {
        session.command(command).unwrap();
        for _ in 0..steps {
            session.step().unwrap();
        }
        let mut replay = Replay::new(scene(CUBE), session.log().clone()).unwrap();
        while replay.step().unwrap().is_some() {}
        let course = replay.course_so_far();
        assert_eq!(course, replay.course());
        course
    };
    let even = replayed(&mut session, to("cnn-symplectic"), 3);
    assert_eq!(
        even.methods,
        [("cnn-symplectic".to_owned(), Options::new())]
    );
    let is_even = (even.is_even(), even.has_one_length);
    assert_eq!(
        (even.first, even.steps, even.dt, is_even),
        (first, 3, 0.002, (true, true))
    );
    let shorter = replayed(&mut session, Command::Dt(0.001), 1);
    assert_eq!(shorter.methods.len(), 1);
    assert!((shorter.dt - 0.00175).abs() < 1e-15 && !shorter.has_one_length);
    let several = replayed(&mut session, to("cnn-stabilised"), 4);
    let ids: Vec<&str> = several.methods.iter().map(|(id, _)| id.as_str()).collect();
    assert_eq!(ids, ["cnn-symplectic", "cnn-stabilised"]);
    assert!((several.dt - 0.011 / 8.0).abs() < 1e-15 && !several.is_even());
}

#[test]
fn a_log_of_another_scene_is_refused_and_of_another_program_warned() {
    let mut session = session(CUBE);
    session.step().unwrap();
    let text = session.log().to_text();
    let log = |text: &str| Log::parse(Path::new("s.log"), text).unwrap();
    let other = scene(&CUBE.replace("6000.0", "6001.0"));
    let said = Replay::new(other, log(&text)).err().unwrap().to_string();
    assert_eq!(
        said,
        "the log is that of another scene: its text differs; give the scene, and the values of the command line, with which the session ran"
    );
    let own = Replay::new(scene(CUBE), log(&text)).unwrap();
    assert!(own.warnings().is_empty());
    let theirs = text.replace(env!("CARGO_PKG_VERSION"), "0.0.7");
    let said = Replay::new(scene(CUBE), log(&theirs))
        .unwrap()
        .warnings()
        .remove(0);
    assert!(
        said.starts_with("the log was written by sinew 0.0.7, and this is "),
        "{said}"
    );
}

#[test]
fn a_table_that_changed_is_another_scene() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cube.toml");
    let table = folder.path().join("ball.csv");
    let by_table = CUBE.replace(
        "start = [0.04, 0.04, 0.08]\nvelocity = [0.0, 0.0, -0.05]",
        "table = \"ball.csv\"",
    );
    std::fs::write(&path, by_table).unwrap();
    let rows = "t_s,x_m,y_m,z_m\n0.0,0.04,0.04,0.08\n0.2,0.04,0.04,0.07\n";
    std::fs::write(&table, rows).unwrap();
    let load = || sinew_scene::Scene::load(&path).unwrap();
    let mut session = World::new(load()).unwrap();
    session.step().unwrap();
    let log = session.log().clone();
    assert!(Replay::new(load(), log.clone()).is_ok());
    std::fs::write(&table, rows.replace("0.2,", "0.3,")).unwrap();
    let said = Replay::new(load(), log).err().unwrap().to_string();
    assert!(said.contains("ball.csv has changed"), "{said}");
}

#[test]
fn a_log_that_was_changed_is_refused_where_it_does_not_fit() {
    let mut session = session(CUBE);
    for dt in [0.001, 0.0015] {
        session.step().unwrap();
        session.command(Command::Dt(dt)).unwrap();
    }
    session.step().unwrap();
    let text = session.log().to_text();
    let said = |from: &str, to: &str| {
        assert!(text.contains(from), "{from} in {text}");
        let log = Log::parse(Path::new("s.log"), &text.replace(from, to)).unwrap();
        let mut replay = Replay::new(scene(CUBE), log).unwrap();
        loop {
            match replay.step() {
                Ok(Some(_)) => {}
                Ok(None) => return String::new(),
                Err(error) => return error.to_string(),
            }
        }
    };
    assert_eq!(said("end", "end"), "");
    let other = said("dt 0.001\n", "dt 0.0011\n");
    assert!(
        other.starts_with("after step 2 the time is 0.0031"),
        "{other}"
    );
    let refused = said("dt 0.0015\n", "dt 0.0\n");
    assert!(
        refused.starts_with("command 2 of the log, after step 2: dt = 0 s: expected"),
        "{refused}"
    );
    let unknown = said("dt 0.0015\n", "pose \"needle\" 0 0 0 0 0 0\n");
    assert!(
        unknown.contains("no tool is named \"needle\"; there are \"ball\", \"plate\""),
        "{unknown}"
    );
}
