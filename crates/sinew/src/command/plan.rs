//! `sinew plan`.

use std::path::Path;

use sinew_scene::Scene;

use super::{Failure, say};

pub(crate) fn run(scene: &Path) -> Result<(), Failure> {
    let simulation = Scene::load(scene)?.build()?;
    say(simulation.plan().to_string().trim_end());
    Ok(())
}
