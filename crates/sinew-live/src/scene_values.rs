//! A scene with the values that a command line and a page set in it.

use sinew_scene::{Scene, SceneError};
use sinew_world::{InputFile, Log};

use crate::error::LiveError;

/// A scene with the values that a command line and a page set in its file, as `KEY=VALUE`.
#[derive(Clone, Debug)]
pub(crate) struct SceneValues {
    pub(crate) scene: Scene,
    pub(crate) values: Vec<String>,
    /// The files of the scene at the time when the page was opened.
    pub(crate) files: Vec<InputFile>,
}

impl SceneValues {
    /// The same scene with another value of a key.
    pub(crate) fn with(&self, key: &str, value: &str) -> Result<Self, SceneError> {
        let assignment = format!("{key}={value}");
        let scene = Scene::parse_with(self.scene.source(), &[&assignment])?;
        let is_other = |text: &&String| text.split_once('=').is_none_or(|(own, _)| own != key);
        let mut values: Vec<String> = self.values.iter().filter(is_other).cloned().collect();
        values.push(assignment);
        Ok(Self {
            scene,
            values,
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
