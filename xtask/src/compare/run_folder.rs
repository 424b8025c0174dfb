//! The folder of a run, for meshio and pyvista.

use std::path::Path;

use sinew_record::{Request, RunFolder};
use sinew_scene::{Scene, SceneSource};
use sinew_world::World;

use crate::failure::Failure;

/// A body with a probe, moving.
const SCENE: &str = "[mesh]\ncube = { cells = 4, edge = 0.1 }\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\n\
                     youngs_modulus = 3000.0\npoissons_ratio = 0.3\n[[fixed]]\ngroup = \"sides\"\n[[load]]\n\
                     group = \"top\"\npressure = 100.0\n[run]\nduration = 0.1\nintegrator = \"central-difference\"\n\
                     dt = 0.0025\n[[probe]]\nname = \"top\"\npoint = [0.05, 0.05, 0.1]\n[output]\n\
                     fields = { frames = 5 }\nacceleration = true\n\
                     step_limit = true\ncompress = true\n";

/// Runs a small scene into a folder.
pub(super) fn write(path: &Path) -> Result<(), Failure> {
    let scene = Scene::parse(SceneSource::new("compare.toml", SCENE)).map_err(Failure::chore)?;
    let simulation = scene.build().map_err(Failure::chore)?;
    let integrator = simulation.integrator().map_err(Failure::chore)?;
    let folder = RunFolder::create(path, &simulation, &Request::default());
    let folder = folder.map_err(Failure::chore)?;
    let mut world = World::following(simulation, integrator).map_err(Failure::chore)?;
    let end = folder.run(&mut world, &mut ());
    end.map(|_| ()).map_err(Failure::chore)
}
