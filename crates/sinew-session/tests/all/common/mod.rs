//! Scenes that tests drive.

#![allow(clippy::panic, reason = "a test fails by panicking")]

use sinew_scene::{Scene, SceneSource};
use sinew_session::Session;

/// A cube of tissue under its weight and a traction, with a ball above it that comes down and a plate beside it.
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

/// A strip that begins rolled up, so that its ends are in each other, and opens slowly.
pub(crate) const ROLLED: &str = r#"
[mesh]
block = { cells = [24, 1, 1], size = [0.24, 0.01, 0.01] }
[[region]]
density = 1000.0
model = "neo-hookean"
youngs_modulus = 10.0
poissons_ratio = 0.3
[[initial]]
displacement = ["(0.035 - z) * sin(x / 0.035) - x", 0.0, "0.035 - (0.035 - z) * cos(x / 0.035) - z"]
[run]
free_flight = true
duration = 0.05
integrator = "central-difference"
dt = 0.001
"#;

/// A scene by its text.
pub(crate) fn scene(text: &str) -> Scene {
    Scene::parse(SceneSource::new("cube.toml", text)).unwrap_or_else(|error| panic!("{error}"))
}

/// A session of a scene by its text.
pub(crate) fn session(text: &str) -> Session {
    Session::new(scene(text)).unwrap_or_else(|error| panic!("{error}"))
}
