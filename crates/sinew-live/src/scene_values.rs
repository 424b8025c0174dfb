//! A scene with the values that a command line and a page set in it.

use sinew_scene::{OverrideError, Scene, SceneError};

/// Reasons for which a value is not set.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ValueError {
    /// A value that has no place in the scene.
    #[error(transparent)]
    Place(#[from] OverrideError),
    /// A scene that cannot be used with it.
    #[error(transparent)]
    Scene(#[from] SceneError),
}

/// A scene with the values that a command line and a page set in its file, as `KEY=VALUE`.
#[derive(Clone, Debug)]
pub(crate) struct SceneValues {
    pub(crate) scene: Scene,
    pub(crate) values: Vec<String>,
}

impl SceneValues {
    /// The same scene with another value of a key.
    pub(crate) fn with(&self, key: &str, value: &str) -> Result<Self, ValueError> {
        let assignment = format!("{key}={value}");
        let source = self.scene.source().with_values(&[&assignment])?;
        let is_other = |text: &&String| text.split_once('=').is_none_or(|(own, _)| own != key);
        let mut values: Vec<String> = self.values.iter().filter(is_other).cloned().collect();
        values.push(assignment);
        Ok(Self {
            scene: Scene::parse(source)?,
            values,
        })
    }
}
