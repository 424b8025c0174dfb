//! A scene with the values that a command line and pages set in it.

use sinew_scene::{Scene, SceneError};
use sinew_world::{InputFile, Log};

use crate::error::LiveError;

/// A key of a scene with its other value, or `None` if it is removed.
pub(crate) type Change = (String, Option<String>);

/// A scene with the values that a command line and pages set in its file.
#[derive(Clone, Debug)]
pub(crate) struct SceneValues {
    /// The scene with the values of all of them.
    pub(crate) scene: Scene,
    /// The scene with the values of the command line.
    opened: Scene,
    /// The values of the command line, as `KEY=VALUE`.
    given: Vec<String>,
    /// The values that pages set.
    changes: Vec<Change>,
    /// The files of the scene at the time when the page was opened.
    files: Vec<InputFile>,
}

impl SceneValues {
    /// A scene with these values of a command line and these files.
    pub(crate) fn new(scene: Scene, given: Vec<String>, files: Vec<InputFile>) -> Self {
        Self {
            opened: scene.clone(),
            scene,
            given,
            changes: Vec::new(),
            files,
        }
    }

    /// All values as a command line has them: those that pages set replace those that were given to it, as a key may be set
    /// once.
    pub(crate) fn values(&self) -> Vec<String> {
        let is_set = |key: &str| {
            let mut set = self.changes.iter().filter(|(_, value)| value.is_some());
            set.any(|(own, _)| own == key)
        };
        let given = self.given.iter().filter(|text| {
            let key = text.split_once('=').map(|(key, _)| key.trim());
            !key.is_some_and(is_set)
        });
        given.cloned().chain(assignments(&self.changes)).collect()
    }

    /// The scene as it was opened.
    pub(crate) fn opened(&self) -> &Scene {
        &self.opened
    }

    /// The same scene with other values of keys.
    pub(crate) fn with(&self, changes: Vec<Change>) -> Result<Self, SceneError> {
        let mut all = self.changes.clone();
        all.retain(|(key, _)| changes.iter().all(|(other, _)| other != key));
        all.extend(changes);
        self.with_all(all)
    }

    /// The same scene with other values of the keys that pages set, each changed or left out.
    pub(crate) fn with_changed(
        &self,
        change: impl FnMut(Change) -> Option<Change>,
    ) -> Result<Self, SceneError> {
        self.with_all(self.changes.iter().cloned().filter_map(change).collect())
    }

    fn with_all(&self, changes: Vec<Change>) -> Result<Self, SceneError> {
        let values: Vec<String> = assignments(&changes).collect();
        Ok(Self {
            scene: Scene::parse_with(self.opened.source(), &values)?,
            changes,
            ..self.clone()
        })
    }

    /// Refuses the session of this log if a file of the scene has changed: its body could not be compared with the
    /// shown ones.
    pub(crate) fn check_files(&self, log: &Log) -> Result<(), LiveError> {
        let now = &log.header().inputs;
        let changed = now.iter().find(|file| !self.files.contains(file));
        match changed {
            Some(file) => Err(LiveError::Changed {
                path: file.path.clone(),
            }),
            None => Ok(()),
        }
    }
}

fn assignments(changes: &[Change]) -> impl Iterator<Item = String> {
    changes.iter().map(|(key, value)| match value {
        Some(value) => format!("{key}={value}"),
        None => format!("~{key}"),
    })
}

#[cfg(test)]
mod tests {
    use sinew_scene::SceneSource;

    use super::*;

    #[test]
    fn the_values_of_a_page_give_its_scene_and_set_each_key_once() {
        let text = "[mesh]\ncube = { cells = 2, edge = 0.1 }\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\n\
                    youngs_modulus = 3000.0\npoissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n\
                    [run]\nduration = 1.0\nintegrator = \"newmark\"\ndt = 0.01\n";
        let source = SceneSource::new("cube.toml", text);
        let given = ["run.dt=0.02", "run.beta=0.3", "run.gamma=0.6"].map(str::to_owned);
        let opened = Scene::parse_with(&source, &given).unwrap();
        let values = SceneValues::new(opened, given.to_vec(), Vec::new());
        let change = |key: &str, value: Option<&str>| (key.to_owned(), value.map(str::to_owned));
        let other = values.with(vec![
            change("run.dt", Some("auto")),
            change("run.integrator", Some("central-difference")),
            change("run.beta", None),
            change("run.gamma", None),
        ]);
        let other = other.unwrap();
        assert_eq!(
            other.values(),
            [
                "run.beta=0.3",
                "run.gamma=0.6",
                "run.dt=auto",
                "run.integrator=central-difference",
                "~run.beta",
                "~run.gamma"
            ]
        );
        let again = Scene::parse_with(&source, &other.values()).unwrap();
        assert_eq!(again.source().text(), other.scene.source().text());
        assert_eq!(other.with_changed(|_| None).unwrap().values(), given);
    }
}
