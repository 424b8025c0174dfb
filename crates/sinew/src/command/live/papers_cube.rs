//! The paper's cube, which fails: one of the scenes of the start page.

use sinew_scene::SceneSource;

/// Its name.
pub(super) const NAME: &str = "papers-cube";

/// The methods that run side by side on it: the paper's, and one that is stable with its step.
pub(super) const METHODS: [&str; 2] = ["cnn", BESIDE];

/// The method of a second pane that is opened later.
pub(super) const BESIDE: &str = "cnn-stabilised";

/// The scene.
pub(super) fn source() -> SceneSource {
    SceneSource::new("papers-cube.toml", include_str!("papers-cube.toml"))
}
