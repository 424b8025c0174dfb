//! A scene with values of the command line.

use std::path::Path;

#[cfg(feature = "implicit")]
use sinew_integrators::Memory;
use sinew_integrators::explicit::Substeps;
use sinew_scene::output::complain;
use sinew_scene::{Scene, TimeStep};

use super::Failure;
#[cfg(feature = "implicit")]
use super::memory_left::memory_left;

/// Values that the command line sets in a scene.
#[derive(clap::Args)]
pub(crate) struct Values {
    /// Another integrator than the scene's; options of the scene's integrator that it does not have are an error
    #[arg(long, value_name = "ID")]
    integrator: Option<String>,
    /// Another step than the scene's, in s, or auto
    #[arg(long, value_name = "STEP", allow_negative_numbers = true)]
    dt: Option<String>,
    /// Another value of a key of the scene, such as region.1.youngs_modulus=4000: tables of a list by their
    /// numbers from 1 on; ~KEY removes a value; may be given several times
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

impl Values {
    /// Assignments of the command line to keys of the scene, as `key=value`.
    pub(crate) fn assignments(&self) -> Vec<String> {
        let named = [("run.integrator", &self.integrator), ("run.dt", &self.dt)];
        let named = named
            .into_iter()
            .filter_map(|(key, value)| Some(format!("{key}={}", value.as_ref()?)));
        named.chain(self.set.iter().cloned()).collect()
    }

    /// Reads a scene with them.
    pub(crate) fn load(&self, path: &Path) -> Result<Scene, Failure> {
        self.check()?;
        let scene = Scene::load_with(path, &self.assignments())?;
        self.say_of_parts(&scene);
        limit_memory(&scene);
        Ok(scene)
    }

    /// Warns of settings that a step of the command line removes from a scene with dt = "auto".
    fn say_of_parts(&self, scene: &Scene) {
        let is_auto = |scene: &Scene| scene.settings().dt == TimeStep::Auto;
        let key = |set: &String| key_of("--set", set);
        let sets_step = self.assignments().iter().any(|set| key(set) == "run.dt");
        let keeps_parts = scene.settings().options.get(Substeps::KEY).is_some();
        if !sets_step || is_auto(scene) || keeps_parts {
            return;
        }
        // Without the command line's values it may not be a whole scene.
        if Scene::load(scene.source().path()).is_ok_and(|own| is_auto(&own)) {
            complain(&format!(
                "dt = \"auto\" of the scene is replaced by a step that is not cut where a body of large deformation stiffens; with --set run.{}=auto it is",
                Substeps::KEY
            ));
        }
    }

    /// The first option that was given.
    #[cfg(feature = "live")]
    pub(crate) fn first_option(&self) -> Option<&'static str> {
        let integrator = self.integrator.as_ref().map(|_| "--integrator");
        let dt = self.dt.as_ref().map(|_| "--dt");
        let set = self.set.first().map(|_| "--set");
        integrator.or(dt).or(set)
    }

    /// Refuses two values for one key.
    fn check(&self) -> Result<(), Failure> {
        let integrator = self.integrator.iter().map(|value| ("--integrator", value));
        let dt = self.dt.iter().map(|value| ("--dt", value));
        let set = self.set.iter().map(|assignment| ("--set", assignment));
        let given: Vec<(String, String)> = integrator
            .chain(dt)
            .chain(set)
            .map(|(option, value)| (key_of(option, value), format!("{option} {value}")))
            .collect();
        for (index, (key, second)) in given.iter().enumerate() {
            if let Some((_, first)) = given[..index].iter().find(|(other, _)| other == key) {
                return Err(Failure::SetTwice {
                    key: key.clone(),
                    first: first.clone(),
                    second: second.clone(),
                });
            }
        }
        Ok(())
    }
}

/// Share of the memory left that a factor may take.
#[cfg(feature = "implicit")]
const SHARE: f64 = 0.9;

/// The memory that factors of a scene may take: the scene's limit, or nine tenths of the available memory.
#[cfg(feature = "implicit")]
pub fn memory_of(scene: &Scene) -> Memory {
    let asked = scene.settings().memory.map(|megabytes| 1e6 * megabytes);
    let left = || Some(SHARE * memory_left()? as f64);
    let bytes = asked.or_else(left);
    bytes.map_or(Memory::unlimited(), |bytes| Memory::of(bytes as u64))
}

/// Limits factors to that much memory from now on.
#[cfg(feature = "implicit")]
pub(super) fn limit_memory(scene: &Scene) {
    Memory::set_left(Some(memory_of(scene)));
}

/// Without implicit methods there are no factors.
#[cfg(not(feature = "implicit"))]
pub(super) fn limit_memory(_: &Scene) {}

/// The key of the scene that an option sets.
fn key_of(option: &str, value: &str) -> String {
    match option {
        "--set" => {
            let (key, _) = value.split_once('=').unwrap_or((value, ""));
            key.split('.').map(str::trim).collect::<Vec<_>>().join(".")
        }
        option => format!("run.{}", option.trim_start_matches('-')),
    }
}
