//! Logs of sessions as text: nothing is lost, and each bad line is refused by file and line.

use std::fs;
use std::path::Path;

use crate::common::{CUBE, session};
use proptest::prelude::*;
use sinew_core::{OptionValue, Options};
use sinew_world::{Command, Journal, Log, Replay, World};

fn parse(text: &str) -> Result<Log, String> {
    Log::parse(Path::new("s.log"), text).map_err(|error| error.to_string())
}

/// A log with every command.
fn log() -> String {
    let mut session = session(CUBE);
    let block = ("kind".to_owned(), OptionValue::Text("block".to_owned()));
    for command in [
        Command::Pose {
            tool: "ball".into(),
            position: [0.04, 0.1 + 0.2, -0.0],
            rotation_vector: [1e-300, 0.5, -1.0 / 3.0],
        },
        Command::LoadFactor {
            load: "load 2".into(),
            factor: 0.25,
        },
        Command::Integrator {
            id: "cnn-stabilised".to_owned(),
            options: Options::new().with("inner", OptionValue::Table([block].into())),
        },
        Command::Dt(0.001),
        Command::Grasp {
            tool: "ball".into(),
        },
        Command::Forces(vec![(60, [0.1 + 0.2, -0.0, 1e-300]), (7, [1.0, 0.0, 0.5])]),
        Command::Release {
            tool: "ball".into(),
        },
        Command::Forces(Vec::new()),
        Command::Reset,
    ] {
        session.step().unwrap();
        session.command(command).unwrap();
    }
    session.step().unwrap();
    session.log().to_text()
}

#[test]
fn a_log_comes_back_as_it_was() {
    let text = log();
    let read = parse(&text).unwrap();
    assert_eq!(read.to_text(), text);
    assert_eq!((read.entries().len(), read.steps()), (9, 10));
    let Command::Pose {
        position,
        rotation_vector,
        ..
    } = &read.entries()[0].command
    else {
        panic!("the first was a pose")
    };
    assert_eq!(
        position.map(f64::to_bits),
        [0.04, 0.1 + 0.2, -0.0].map(f64::to_bits)
    );
    assert_eq!(*rotation_vector, [1e-300, 0.5, -1.0 / 3.0]);
    // Windows' editors end lines otherwise.
    assert_eq!(parse(&text.replace('\n', "\r\n")).unwrap(), read);
}

#[test]
fn bad_lines_are_refused_by_file_line_and_what_to_do() {
    let text = log();
    let said = |from: &str, to: &str| {
        assert!(text.contains(from), "{from} in\n{text}");
        parse(&text.replacen(from, to, 1)).unwrap_err()
    };
    for (found, expected) in [
        (
            said("session log 1", "session log 2"),
            "s.log:1: a log of version 2: this program reads version 1; take a newer one",
        ),
        (
            said("sinew session log", "t_s,x_m"),
            "s.log:1: expected `sinew session log 1`: this is not the log of a session",
        ),
        (
            parse("").unwrap_err(),
            "s.log:1: expected `sinew session log 1`: this is not the log of a session",
        ),
        (
            parse("sinew session log 1\nprogram \"1\"\n").unwrap_err(),
            "s.log:2: the log is cut off before its first command",
        ),
        (
            said("program ", "programme "),
            "s.log:2: \"programme\": expected program \"VERSION\"",
        ),
        (said("scene ", "scene 0"), "s.log:3: "),
        (
            said("1 0.002 pose \"ball\"", "1 0.002 pose ball"),
            "s.log:4: \"ball\": expected the name of a tool in quotes",
        ),
        (
            said("-0.0 ", "NaN "),
            "s.log:4: \"NaN\": expected six finite numbers, position (m) and rotation vector (rad)",
        ),
        (
            said("-0.0 ", ""),
            "s.log:4: \"\": expected six finite numbers, position (m) and rotation vector (rad)",
        ),
        (
            said("factor \"load 2\" 0.25", "factor \"load 2\" 0.25 9"),
            "s.log:5: \"9\": expected the end of the line",
        ),
        (
            said("2 0.004 factor", "two 0.004 factor"),
            "s.log:5: \"two\": expected the number of steps before the command",
        ),
        (
            said("2 0.004 factor", "0 0.004 factor"),
            "s.log:5: step 0 comes after step 1 of the line above: lines must be in the order of steps",
        ),
        (
            said("2 0.004 factor", "2 0.001 factor"),
            "s.log:5: t = 0.001 s comes after t = 0.002 s of the line above: without a reset time rises with the steps",
        ),
        (
            said("factor", "faktor"),
            "s.log:5: \"faktor\": expected pose, grasp, release, factor, forces, integrator, dt, reset, cut, went-back or end",
        ),
        (
            said("10 end", "10 end\n11 end"),
            "s.log:14: a line after the end: expected none after `10 end`",
        ),
        (
            said("10 end", "4 end"),
            "s.log:13: step 4 comes after step 9 of the line above: lines must be in the order of steps",
        ),
        (
            said("dt 0.001", "dt 1e999"),
            "s.log:7: \"1e999\": expected a finite step (s)",
        ),
    ] {
        assert!(found.starts_with(expected), "{found}\nexpected {expected}");
    }
    let missing = Log::read(Path::new("/nowhere/s.log")).unwrap_err();
    assert!(missing.to_string().starts_with("/nowhere/s.log: "));
}

#[test]
fn a_journal_holds_what_no_later_pose_can_replace_and_in_the_end_all() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.log");
    let mut journal = Journal::create(path.clone()).unwrap();
    let text = || fs::read_to_string(&path).unwrap();
    let pose = |z: f64| Command::Pose {
        tool: "ball".into(),
        position: [0.04, 0.04, z],
        rotation_vector: [0.0; 3],
    };
    let mut session = session(CUBE);
    session.command(pose(0.2)).unwrap();
    journal.keep_up(session.log()).unwrap();
    assert!(
        !text().contains("pose"),
        "another one may come before the step"
    );
    session.command(pose(0.19)).unwrap();
    session.step().unwrap();
    session.command(Command::Reset).unwrap();
    journal.keep_up(session.log()).unwrap();
    assert!(text().contains("0.19") && !text().contains("0.2 ") && !text().contains("reset"));
    // Killed here, it can be repeated as far as it goes.
    let kept = Log::read(&path).unwrap();
    assert_eq!(kept.entries(), &session.log().entries()[..1]);
    session.step().unwrap();
    journal.keep_up(session.log()).unwrap();
    session.command(pose(0.18)).unwrap();
    journal.finish(session.log()).unwrap();
    assert_eq!(text(), session.log().to_text());

    let refused = Journal::create(path.clone()).unwrap_err().to_string();
    assert!(refused.contains("--replay"), "{refused}");
    fs::remove_file(&path).unwrap();
    let mut journal = Journal::create(path.clone()).unwrap();
    journal.keep_up(session.log()).unwrap();
    journal.begin_anew().unwrap();
    journal.finish(session.log()).unwrap();
    assert_eq!(text(), session.log().to_text());
}

/// A world that is restored has a shorter log, and the file follows.
#[test]
fn a_journal_follows_a_log_that_goes_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.log");
    let text = || fs::read_to_string(&path).unwrap();
    let mut world = session(CUBE);
    let mut journal = Journal::create(path.clone()).unwrap();
    let mut drive = |world: &mut World, factors: &[f64]| {
        for factor in factors {
            let load = "pull".into();
            let factor = *factor;
            world.command(Command::LoadFactor { load, factor }).unwrap();
            world.step().unwrap();
            journal.keep_up(world.log()).unwrap();
            let kept = Log::read(&path).unwrap();
            assert_eq!(kept.entries(), world.log().entries());
        }
    };
    let begun = world.save();
    drive(&mut world, &[0.1, 0.2, 0.3]);
    let saved = world.save();
    drive(&mut world, &[0.4, 0.5, 0.6, 0.7, 0.8]);
    world.restore(&saved).unwrap();
    drive(&mut world, &[5.0, 6.0, 7.0, 8.0]);
    world.restore(&begun).unwrap();
    drive(&mut world, &[9.0]);
    // As many commands as before it was restored.
    world.restore(&begun).unwrap();
    drive(&mut world, &[10.0]);
    world.restore(&begun).unwrap();
    journal.keep_up(world.log()).unwrap();
    assert_eq!(text(), "", "no command is left");
    world.step().unwrap();
    journal.finish(world.log()).unwrap();
    assert_eq!(text(), world.log().to_text());
}

#[test]
fn a_log_without_an_end_goes_as_far_as_its_last_whole_command() {
    let text = log();
    let without_end = text.replace("10 end\n", "");
    let whole = parse(&without_end).unwrap();
    assert!(whole.is_cut_off() && !parse(&text).unwrap().is_cut_off());
    assert_eq!((whole.entries().len(), whole.steps()), (9, 9));
    // Of a number of which digits are missing nothing is taken.
    for missing in 1..6 {
        let part = &without_end[..without_end.len() - missing];
        assert_eq!(parse(part).unwrap().entries().len(), 8, "{part}");
    }
    assert_eq!(parse(text.trim_end()).unwrap(), parse(&text).unwrap());
}

#[test]
fn a_log_says_which_values_its_scene_had() {
    let session = session(CUBE).with_values(&["run.dt=0.001".to_owned()]);
    let log = parse(&session.log().to_text()).unwrap();
    assert_eq!(log, *session.log());
    assert_eq!(log.header().values, ["run.dt=0.001"]);
    let other = crate::common::scene(&CUBE.replace("0.3", "0.4"));
    let refused = Replay::new(other, log).err().unwrap().to_string();
    assert!(refused.contains("--set 'run.dt=0.001'"), "{refused}");
}

proptest! {
    /// Cut off, or with a byte changed, a log is read or refused, and nothing panics.
    #[test]
    fn spoilt_logs_are_read_or_refused(at in 0.0..1.0f64, byte in 32u8..127, cut in any::<bool>()) {
        let mut text = LOG.with(String::clone).into_bytes();
        let at = (at * text.len() as f64) as usize;
        if cut {
            text.truncate(at);
        } else {
            text[at] = byte;
        }
        if let Ok(text) = String::from_utf8(text) {
            let _ = parse(&text);
        }
    }
}

thread_local! {
    static LOG: String = log();
}
