//! Scenes for the tests of worlds.

#![allow(clippy::panic, reason = "a test fails by panicking")]

use sinew_core::State;
use sinew_scene::{Scene, SceneSource, Simulation};
use sinew_world::{Ended, World};

/// A cube of tissue under its weight and a traction, with a ball above it that comes down and a plate next to it.
pub(crate) const CUBE: &str = r#"
gravity = [0.0, 0.0, -9.81]
[mesh]
cube = { cells = 3, edge = 0.06 }
[[region]]
density = 1060.0
model = "linear"
youngs_modulus = 6000.0
poissons_ratio = 0.4
[damping]
mass = 15.0
[[fixed]]
group = "bottom"
[[load]]
name = "pull"
group = "top"
traction = [80.0, 0.0, 40.0]
ramp = { kind = "sin2", rise = 0.05 }
[[load]]
group = "sides"
traction = [30.0, 0.0, 0.0]
[[tool]]
name = "ball"
shape = { sphere = { radius = 0.012 } }
start = [0.04, 0.04, 0.08]
velocity = [0.0, 0.0, -0.05]
friction = 0.3
[[tool]]
name = "plate"
shape = { plane = {} }
start = [0.08, 0.03, 0.03]
rotation = [0.0, -1.5707963267948966, 0.0]
hold = true
[run]
duration = 0.3
integrator = "symplectic-euler"
dt = 0.002
"#;

/// A scene from its text.
pub(crate) fn scene(text: &str) -> Scene {
    Scene::parse(SceneSource::new("cube.toml", text)).unwrap_or_else(|error| panic!("{error}"))
}

/// A session of a scene from its text.
pub(crate) fn session(text: &str) -> World {
    World::new(scene(text)).unwrap_or_else(|error| panic!("{error}"))
}

/// Builds the scene of a text.
pub(crate) fn build(text: &str) -> Simulation {
    scene(text)
        .build()
        .unwrap_or_else(|error| panic!("{error}"))
}

/// A world that follows its scene.
pub(crate) fn following(simulation: Simulation) -> World {
    let integrator = simulation
        .integrator()
        .unwrap_or_else(|error| panic!("{error}"));
    World::following(simulation, integrator).unwrap_or_else(|error| panic!("{error}"))
}

/// Takes this number of steps.
pub(crate) fn advance(world: &mut World, steps: usize) {
    let ended = world.advance(steps, &mut ());
    assert_eq!(
        ended.unwrap_or_else(|error| panic!("{error}")),
        Ended::Finished
    );
}

/// The state at the end of a scene.
pub(crate) fn end_of(simulation: Simulation) -> State {
    let steps = simulation.run().steps;
    let mut world = following(simulation);
    advance(&mut world, steps);
    world.state().clone()
}
