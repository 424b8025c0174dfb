//! A scene with values of the command line.

use std::path::Path;

use sinew_scene::Scene;

use super::Failure;

/// Values that the command line sets in a scene.
#[derive(clap::Args)]
pub(crate) struct Values {
    /// Another integrator than the scene's; keys that are options of the scene's own are refused by it
    #[arg(long, value_name = "ID")]
    integrator: Option<String>,
    /// Another step than the scene's, in s, or auto
    #[arg(long, value_name = "STEP")]
    dt: Option<String>,
    /// Another value of a key of the scene, such as region.1.youngs_modulus=4000: tables of a list by their
    /// numbers from 1 on; may be given several times
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

impl Values {
    /// What the command line sets, a sentence each for messages.
    pub(crate) fn assignments(&self) -> Vec<String> {
        let named = [("run.integrator", &self.integrator), ("run.dt", &self.dt)];
        let named = named
            .into_iter()
            .filter_map(|(key, value)| Some(format!("{key}={}", value.as_ref()?)));
        named.chain(self.set.iter().cloned()).collect()
    }

    /// Reads a scene with them.
    pub(crate) fn load(&self, path: &Path) -> Result<Scene, Failure> {
        Ok(Scene::load_with(path, &self.assignments())?)
    }
}
