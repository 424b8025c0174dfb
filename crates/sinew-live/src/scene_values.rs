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

    /// All values as a command line has them: those of pages follow those that were given to it.
    pub(crate) fn values(&self) -> Vec<String> {
        let given = self.given.iter().cloned();
        given.chain(assignments(&self.changes)).collect()
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
