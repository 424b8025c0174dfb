//! A scene without a text: a ball is steered into a cube of tissue, which is cut, recorded, and restored.
//!
//! ```sh
//! cargo run --release
//! ```

use sinew_core::{Moment, Verdict};
use sinew_scene::Scene;
use sinew_world::{Command, Saved, World};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = serde_json::json!({
        "mesh": { "cube": { "cells": 6, "edge": 0.06 } },
        "region": [{ "density": 1060, "model": "linear", "youngs_modulus": 6000, "poissons_ratio": 0.4 }],
        "damping": { "mass": 15 },
        "fixed": [{ "group": "bottom" }],
        "tool": [{ "name": "ball", "shape": { "sphere": { "radius": 0.012 } }, "start": [0.03, 0.03, 0.073], "hold": true }],
        "cutting": {},
        "run": { "duration": 1.0, "integrator": "symplectic-euler", "dt": 0.0005 },
    });
    let mut world = World::new(Scene::from_value(&scene, ".")?)?;
    let mut deepest = 0.0_f64;
    let mut recorder = |moment: &Moment<'_>| {
        deepest = moment.state.u.iter().copied().fold(deepest, f64::min);
        Ok(Verdict::Continue)
    };
    let ball = world.tool("ball")?;
    world.steer(ball, [0.03, 0.03, 0.066], [0.0; 3])?; // m, rad
    world.advance_to(0.1, &mut recorder)?;
    let saved = Saved::from_bytes(&world.save().to_bytes()?)?; // a value, which other processes read as well
    let [from, to] = [0.07, 0.03].map(|z| [[0.031, -0.01, z], [0.031, 0.07, z]]);
    world.command(Command::Cut { from, to })?;
    world.advance_to(0.2, &mut recorder)?;
    let area = |world: &World| world.cuts().map_or(f64::NAN, |cuts| cuts.report.area);
    let cut = area(&world);
    world.restore(&saved)?;
    println!("pressed by {deepest} m, cut over {cut} m2");
    println!("at {} s again, cut over {} m2", world.t(), area(&world));
    assert!(deepest < -0.005 && cut > 0.001 && area(&world) == 0.0);
    Ok(())
}
