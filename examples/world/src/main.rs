//! A scene without a text: a ball is steered into a cube of tissue, which is cut, recorded, and made whole again.
//!
//! ```sh
//! cargo run --release
//! ```

use sinew_core::{Moment, Verdict};
use sinew_scene::Scene;
use sinew_world::{Command, Saved, World};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = Scene::from_value(
        &serde_json::json!({
            "mesh": { "cube": { "cells": 6, "edge": 0.06 } },
            "region": [{ "density": 1060, "model": "linear", "youngs_modulus": 6000, "poissons_ratio": 0.4 }],
            "damping": { "mass": 15 },
            "fixed": [{ "group": "bottom" }],
            "tool": [{ "name": "ball", "shape": { "sphere": { "radius": 0.012 } }, "start": [0.03, 0.03, 0.073], "hold": true }],
            "cutting": {},
            "run": { "duration": 1.0, "integrator": "symplectic-euler", "dt": 0.0005 },
        }),
        ".",
    )?;
    let mut world = World::new(scene)?;
    let mut deepest = 0.0_f64;
    let mut recorder = |moment: &Moment<'_>| {
        deepest = moment.state.u.iter().copied().fold(deepest, f64::min);
        Ok(Verdict::Continue)
    };
    let ball = world.tool("ball")?;
    world.steer(ball, [0.03, 0.03, 0.066], [0.0; 3])?;
    world.advance_to(0.1, &mut recorder)?;
    // A value, which other processes read as well.
    let whole = Saved::from_bytes(&world.save().to_bytes()?)?;
    let blade = |z: f64| [[0.031, -0.01, z], [0.031, 0.07, z]];
    world.command(Command::Cut {
        from: blade(0.07),
        to: blade(0.03),
    })?;
    world.advance_to(0.2, &mut recorder)?;
    let area = world.cuts().map_or(0.0, |cuts| cuts.report.area);
    println!(
        "pressed by {:.1} mm, cut over {:.1} cm2",
        -1e3 * deepest,
        1e4 * area
    );
    world.restore(&whole)?;
    println!(
        "whole again at t = {} s, {} faces cut",
        world.t(),
        world.cuts().map_or(0, |cuts| cuts.report.faces)
    );
    let is_whole = world.cuts().is_some_and(|cuts| cuts.report.faces == 0);
    if deepest > -0.005 || area < 0.001 || !is_whole {
        return Err(
            "the ball should have pressed the cube, and the blade cut it until it was restored"
                .into(),
        );
    }
    Ok(())
}
