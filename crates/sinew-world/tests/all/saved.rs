//! A motion that is kept and continued: undone, and carried over to another world.

use std::fmt::Debug;

use serde::{Serialize, de::DeserializeOwned};
use sinew_scene::Scene;
use sinew_world::{Command, CommandError, Replay, RestoreError, World};

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
        Err(RestoreError::State(_) | RestoreError::Cutting(_))
    ));
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
