//! Title and instruments of a run folder.

use std::path::{Path, PathBuf};

use serde_json::Value;
use sinew_record::Instruments;
use sinew_scene::{Scene, SceneSource};

use super::run_files::read_within;

/// The title of a run and its instruments, as far as they are known.
pub(super) struct Known {
    pub(super) title: Option<String>,
    pub(super) instruments: Instruments,
}

/// The title and the instruments that the scene of a run folder describes.
pub(super) fn known_of(folder: &Path) -> Known {
    match scene_of(folder) {
        Ok(scene) => Known {
            title: Some(scene.title_or_path().into_owned()),
            instruments: Instruments::of(&scene, &|name| read_within(folder, name)),
        },
        Err(reason) => Known {
            title: None,
            instruments: Instruments {
                tools: Vec::new(),
                missing: vec![format!("tools are not shown: {reason}")],
            },
        },
    }
}

/// The scene of a run folder. Its files may be absent: only its text is needed.
fn scene_of(folder: &Path) -> Result<Scene, String> {
    let read = |name: &str| {
        let bytes = read_within(folder, name).map_err(|reason| format!("{name}: {reason}"))?;
        String::from_utf8(bytes).map_err(|reason| format!("{name}: {reason}"))
    };
    let record = read("run.json")?;
    let record: Value =
        serde_json::from_str(&record).map_err(|reason| format!("run.json: {reason}"))?;
    let path = record["scene"]
        .as_str()
        .map_or_else(|| folder.join("scene.toml"), PathBuf::from);
    let source = SceneSource::new(path, read("scene.toml")?);
    Scene::parse(source).map_err(|error| format!("scene.toml: {error}"))
}
