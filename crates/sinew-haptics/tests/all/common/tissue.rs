//! A block of tissue under a tool in the hand of a device.

use sinew_haptics::ToolSimulation;
use sinew_scene::{Scene, SceneSource};
use sinew_world::World;

/// Edge of the block (m).
pub(crate) const EDGE: f64 = 0.06;

/// The block of a law, such as `model = "linear"`, under a tool of this shape, turned by a rotation vector (rad), in steps of `dt` (s).
pub(crate) fn under(
    shape: &str,
    rotation_vector: [f64; 3],
    law: &str,
    (method, dt): (&str, f64),
) -> ToolSimulation {
    let text = format!(
        "[mesh]\ncube = {{ cells = 6, edge = {EDGE}, split = \"kuhn\" }}\n[[region]]\ndensity = 1060.0\n{law}\n\
         youngs_modulus = 3500.0\npoissons_ratio = 0.3\n[damping]\nmass = 20.0\n[[fixed]]\ngroup = \"bottom\"\n\
         [[tool]]\nname = \"tool\"\nshape = {shape}\nstart = [0.03, 0.03, {}]\nrotation = {rotation_vector:?}\nhold = true\n\
         [run]\nduration = 10.0\nintegrator = \"{method}\"\ndt = {dt}\n",
        EDGE + 0.05
    );
    let scene = Scene::parse(SceneSource::new("block.toml", text)).unwrap();
    ToolSimulation::new(World::new(scene).unwrap(), "tool").unwrap()
}
