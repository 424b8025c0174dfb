//! A motion that is saved and continued: undone, and transferred to another world.

use std::fmt::Debug;
use std::path::Path;

use serde::{Serialize, de::DeserializeOwned};
use serde_json::json;
use sinew_core::Options;
use sinew_scene::{Scene, SceneSource};
use sinew_world::{Command, CommandError, Journal, Log, Replay, RestoreError, Saved, World};

use crate::common::{CUBE, build, following, scene, session};

fn cube() -> String {
    CUBE.replace("[run]", "[cutting]\nsnap = 0.2\n[run]")
}

/// Commands of every kind at their steps.
fn drive(world: &mut World, steps: std::ops::Range<usize>) {
    let blade = |z: f64| [[0.022, -0.01, z], [0.022, 0.07, z]];
    for step in steps {
        let command = match step {
            5 | 70 => Some(Command::Pose {
                tool: "ball".into(),
                position: [0.03, 0.03, 0.071 + 1e-4 * step as f64],
                rotation_vector: [0.0; 3],
            }),
            12 | 62 => Some(Command::LoadFactor {
                load: "pull".into(),
                factor: 0.1 * step as f64,
            }),
            20 => Some(Command::Cut {
                from: blade(0.07),
                to: blade(0.035),
            }),
            66 => Some(Command::Cut {
                from: blade(0.035),
                to: blade(0.018),
            }),
            30 => Some(Command::Dt(0.001)),
            8 | 72 => Some(Command::Grasp {
                tool: "ball".into(),
            }),
            16 | 75 => Some(Command::Forces(vec![(50, [0.01, 0.0, 1e-3 * step as f64])])),
            80 => Some(Command::Release {
                tool: "ball".into(),
            }),
            _ => None,
        };
        if let Some(command) = command {
            world.command(command).unwrap();
        }
        world.step().unwrap();
    }
}

#[test]
fn a_driven_and_cut_world_continues_bit_for_bit_here_and_in_another_world() {
    let mut world = session(&cube());
    drive(&mut world, 0..60);
    assert!(world.cuts().unwrap().changes > 0);
    // A command that waits for the next step is kept too.
    world
        .command(Command::LoadFactor {
            load: "load 2".into(),
            factor: 0.5,
        })
        .unwrap();
    world
        .command(Command::Forces(vec![(51, [0.0, 0.02, 0.0])]))
        .unwrap();
    let saved = world.save();
    drive(&mut world, 60..100);
    let end = world.save();
    world.restore(&saved).unwrap();
    assert_eq!(world.save(), saved);
    drive(&mut world, 60..100);
    assert!(world.save() == end, "undone and done again");
    let mut other = session(&cube());
    other.step().unwrap();
    other.restore(&saved).unwrap();
    drive(&mut other, 60..100);
    assert!(other.save() == end, "in another world");
    // The log is that of the whole motion.
    let mut replay = Replay::new(scene(&cube()), other.log().clone()).unwrap();
    while replay.step().unwrap().is_some() {}
    assert_eq!(replay.world().state(), world.state());
}

#[test]
fn a_world_takes_the_motion_of_its_own_scene_and_kind_only() {
    let mut followed = following(build(&cube()));
    let refused = followed.command(Command::Dt(0.001));
    assert!(matches!(refused, Err(CommandError::Follows)));
    followed.advance(20, &mut ()).unwrap();
    let saved = followed.save();
    followed.advance(20, &mut ()).unwrap();
    let end = followed.state().clone();
    followed.restore(&saved).unwrap();
    followed.advance(20, &mut ()).unwrap();
    assert_eq!(*followed.state(), end);
    let mut driven = session(&cube());
    assert!(matches!(
        driven.restore(&saved),
        Err(RestoreError::OtherWorld)
    ));
    assert!(matches!(
        followed.restore(&driven.save()),
        Err(RestoreError::OtherWorld)
    ));
    let other = scene(&cube().replace("cells = 3", "cells = 2"));
    let other = Scene::build(other).unwrap();
    assert!(matches!(
        following(other).restore(&saved),
        Err(RestoreError::OtherScene)
    ));
}

/// Every difference between scenes counts, also one that neither the body nor the numbers of tools and loads show; and
/// saved cuts contain their own body.
#[test]
fn the_state_of_another_scene_is_refused_also_after_a_cut() {
    let mut world = session(&cube());
    drive(&mut world, 0..25);
    assert!(world.cuts().unwrap().changes > 0);
    let before = world.save();
    for (ours, theirs) in [
        ("edge = 0.06", "edge = 0.061"),
        ("[80.0, 0.0, 40.0]", "[81.0, 0.0, 40.0]"),
        ("-9.81]", "9.81]"),
        ("radius = 0.012", "radius = 0.011"),
        ("snap = 0.2", "snap = 0.25"),
        ("\"plate\"", "\"board\""),
        ("youngs_modulus = 6000.0", "youngs_modulus = 6001.0"),
    ] {
        for steps in [0, 25] {
            let text = cube().replace(ours, theirs);
            let mut other = session(&text);
            drive(&mut other, 0..steps);
            let refused = world.restore(&other.save()).expect_err(theirs).to_string();
            assert!(refused.contains("another scene"), "{theirs}: {refused}");
            assert!(world.save() == before, "{theirs}");
            let mut followed = following(build(&cube()));
            let refused = followed.restore(&following(build(&text)).save());
            let refused = refused.expect_err(theirs).to_string();
            assert!(refused.contains("another scene"), "{theirs}: {refused}");
        }
    }
}

#[test]
fn a_file_with_other_content_makes_another_scene() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("pull.csv");
    let text = cube().replace(
        "{ kind = \"sin2\", rise = 0.05 }",
        "{ table = \"pull.csv\" }",
    );
    let world = |last: f64| {
        std::fs::write(&table, format!("t_s,factor\n0.0,0.0\n0.1,{last}\n")).unwrap();
        let source = SceneSource::new(folder.path().join("cube.toml"), text.clone());
        World::new(Scene::parse(source).unwrap()).unwrap()
    };
    let (mut one, other) = (world(1.0), world(2.0));
    let refused = one.restore(&other.save()).unwrap_err().to_string();
    assert!(refused.contains("another scene"), "{refused}");
    one.restore(&world(1.0).save()).unwrap();
}

#[test]
fn a_motion_by_another_method_is_restored_where_the_scene_is_the_same() {
    let mut world = session(&cube());
    let switch = Command::Integrator {
        id: "central-difference".to_owned(),
        options: Options::new(),
    };
    world.command(switch).unwrap();
    world.step().unwrap();
    let saved = world.save();
    let mut fresh = session(&cube());
    fresh.restore(&saved).unwrap();
    assert_eq!(fresh.integrator().id(), "central-difference");
    assert!(fresh.save() == saved);
}

#[test]
fn a_motion_that_failed_is_restored_as_one_that_failed() {
    let mut world = session(&cube());
    world.command(Command::Dt(0.2)).unwrap();
    let failed = (0..1000).find_map(|_| world.step().err()).unwrap();
    assert!(world.advance(0, &mut ()).is_err(), "it does not go on");
    let bytes = world.save().to_bytes().unwrap();
    let mut fresh = session(&cube());
    fresh.restore(&Saved::from_bytes(&bytes).unwrap()).unwrap();
    assert_eq!(fresh.failure(), Some(&failed));
    assert!(fresh.save().to_bytes().unwrap() == bytes);
    let refused = fresh.command(Command::Dt(0.001));
    assert!(matches!(refused, Err(CommandError::Failed)));
    assert_eq!(fresh.step().unwrap_err(), failed);
    assert!(fresh.advance(0, &mut ()).is_err());
    for world in [&mut world, &mut fresh] {
        world.command(Command::Reset).unwrap();
        world.advance(3, &mut ()).unwrap();
    }
    assert!(world.save() == fresh.save());
    assert_eq!(world.log(), fresh.log());
}

/// Numbers that are not possible in any motion are refused immediately, and do not end the program later.
#[test]
fn a_motion_with_numbers_that_cannot_be_is_refused() {
    let mut world = session(&cube());
    drive(&mut world, 0..25);
    let (saved, before) = (serde_json::to_value(world.save()).unwrap(), world.save());
    for (place, value) in [
        ("/commanded/steps", json!(u64::MAX)),
        ("/commanded/dt", json!(0.0)),
        ("/commanded/dt", json!(-0.002)),
        ("/commanded/tools/0/0/0/0", json!(1e300)),
        ("/commanded/factors/0", json!(1e300)),
        ("/commanded/blade/0/0", json!(1e300)),
        ("/commanded/log/0/step", json!(u64::MAX)),
        ("/cuts/cut/epoch", json!(u64::MAX)),
        ("/cuts/totals/changes", json!(u64::MAX)),
        ("/state/state/clock/steps", json!(u64::MAX)),
        ("/state/state/clock/dt", json!(-0.002)),
    ] {
        let mut altered = saved.clone();
        *altered.pointer_mut(place).expect(place) = value;
        let altered: Saved = serde_json::from_value(altered).expect(place);
        assert!(world.restore(&altered).is_err(), "{place}");
        assert!(world.save() == before, "{place}");
    }
    world
        .restore(&serde_json::from_value(saved).unwrap())
        .unwrap();
}

#[test]
fn what_is_read_of_a_saved_motion_under_a_guard_is_equal_to_it() {
    // Without tools, whose work the limits of a guard do not know.
    let (body, run) = (
        CUBE.split("[[tool]]").next().unwrap(),
        &CUBE[CUBE.find("[run]").unwrap()..],
    );
    let text = format!("{body}{run}saturation = \"auto\"\n");
    let mut world = session(&text);
    world.advance(3, &mut ()).unwrap();
    let saved = world.save();
    assert_eq!(
        Saved::from_bytes(&saved.to_bytes().unwrap()).unwrap(),
        saved
    );
}

/// Writes a value and reads it again.
fn is_read_again<T: Serialize + DeserializeOwned + PartialEq + Debug>(value: &T) {
    let written = serde_json::to_value(value).unwrap();
    assert_eq!(*value, serde_json::from_value(written).unwrap());
}

#[test]
fn reports_are_values_that_are_written_and_read() {
    let mut world = session(&cube());
    drive(&mut world, 0..60);
    for tool in world.tools() {
        is_read_again(&world.tool_report(tool).unwrap());
        is_read_again(&world.tool_gap(tool));
        // The plate is turned about y alone, so that its rotation vector keeps every bit.
        is_read_again(&world.tool_pose(tool));
    }
    is_read_again(&world.reactions().unwrap());
    is_read_again(&world.energy().unwrap());
    is_read_again(&world.overlap());
    is_read_again(&world.cuts().copied());
    is_read_again(&world.step().unwrap());
    is_read_again(&world.log().entries().to_vec());
    is_read_again(&world.advance(1, &mut ()).unwrap());
    let log = serde_json::to_value(world.log()).unwrap();
    assert_eq!(log["entries"][0]["step"], 5);
    assert_eq!(log["steps"], world.log().steps());
}

#[test]
fn a_world_goes_back_to_its_moments_and_a_replay_gives_what_it_kept() {
    let mut world = session(&cube());
    let mut moments = vec![world.moment()];
    let mut states = vec![world.state().clone()];
    for end in [15, 40, 64, 90] {
        let begun = world.steps();
        drive(&mut world, begun..end);
        moments.push(world.moment());
        states.push(world.state().clone());
    }
    let end = world.save();
    let mut other = session(&cube());
    assert!(matches!(
        other.go_back(&moments[1]),
        Err(RestoreError::OtherPast)
    ));
    for back in [3, 1] {
        world.go_back(&moments[back]).unwrap();
        assert_eq!(world.state(), &states[back]);
        // What comes later was left.
        let left = world.go_back(&moments[back + 1]);
        assert!(matches!(left, Err(RestoreError::OtherPast)), "{back}");
        assert_eq!(world.state(), &states[back]);
    }
    // The first return was left with what came after the second one.
    let [back] = world.log().went_back() else {
        panic!("{:?}", world.log().went_back());
    };
    assert_eq!((back.step, back.steps, back.t), (15, 49, states[1].t()));
    drive(&mut world, 15..90);
    assert!(world.save() == end);
    let text = world.log().to_text();
    assert_eq!(text.matches(" went-back ").count(), 1);
    assert_eq!(&Log::parse(Path::new("s.log"), &text).unwrap(), world.log());
    // It has other commands now, though as many.
    let left = world.go_back(&moments[2]);
    assert!(matches!(left, Err(RestoreError::OtherPast)));
    let mut replay = Replay::new(scene(&cube()), world.log().clone()).unwrap();
    while replay.step().unwrap().is_some() {}
    assert_eq!(replay.world().state(), world.state());
    let path = std::env::temp_dir().join(format!("sinew-went-back-{}.log", std::process::id()));
    let mut journal = Journal::create(path.clone()).unwrap();
    journal.keep_up(world.log()).unwrap();
    world.go_back(&moments[0]).unwrap();
    // Without a command the file says so at once.
    journal.keep_up(world.log()).unwrap();
    journal.keep_up(world.log()).unwrap();
    let kept = Log::read(&path).unwrap();
    assert_eq!(kept.went_back(), world.log().went_back());
    drive(&mut world, 0..20);
    journal.keep_up(world.log()).unwrap();
    journal.finish(world.log()).unwrap();
    assert_eq!(
        std::fs::read_to_string(&path).unwrap(),
        world.log().to_text()
    );
    std::fs::remove_file(path).unwrap();
}

#[test]
fn a_motion_that_failed_goes_on_from_a_moment_before() {
    let mut world = session(CUBE);
    world.advance(10, &mut ()).unwrap();
    let moment = world.moment();
    let state = world.state().clone();
    world.command(Command::Dt(1.0)).unwrap();
    assert!((0..200).any(|_| world.step().is_err()), "it diverges");
    assert!(matches!(
        world.command(Command::Dt(0.001)),
        Err(CommandError::Failed)
    ));
    world.go_back(&moment).unwrap();
    assert_eq!(world.state(), &state);
    world.advance(50, &mut ()).unwrap();
    assert!(world.log().entries().is_empty());
}
