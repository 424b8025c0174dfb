//! A scene with the values that a command line and a page set in it.

use sinew_scene::{Scene, SceneError};

/// A scene with the values that a command line and a page set in its file, as `KEY=VALUE`.
#[derive(Clone, Debug)]
pub(crate) struct SceneValues {
    pub(crate) scene: Scene,
    pub(crate) values: Vec<String>,
}

impl SceneValues {
    /// The same scene with another value of a key.
    pub(crate) fn with(&self, key: &str, value: &str) -> Result<Self, SceneError> {
        let assignment = format!("{key}={value}");
        let scene = Scene::parse_with(self.scene.source(), &[&assignment])?;
        let is_other = |text: &&String| text.split_once('=').is_none_or(|(own, _)| own != key);
        let mut values: Vec<String> = self.values.iter().filter(is_other).cloned().collect();
        values.push(assignment);
        Ok(Self { scene, values })
    }
}
