//! A moment that is saved.

use std::path::{Path, PathBuf};

use sinew_scene::Scene;
use sinew_scene::output::{OutputError, OutputFolder};

use super::pane::Pane;
use crate::protocol::Event;

/// Most folders that are looked through for a free name.
const MOST: u32 = 10_000;

/// Reasons for which nothing is saved.
#[derive(Debug, thiserror::Error)]
pub(crate) enum SaveError {
    /// A file that cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// Too many folders.
    #[error("{MOST} moments are saved here already")]
    Full,
    /// The folder that this program works in is gone.
    #[error("no folder to save in: {0}")]
    Folder(#[from] std::io::Error),
}

/// Writes the scene, and state and commands of each pane, into a new folder of the current one.
pub(crate) fn save(scene: &Scene, panes: &[Pane]) -> Result<Event, SaveError> {
    let here = std::env::current_dir()?;
    let mut names = (1..=MOST).map(|number| here.join(format!("live-{number}")));
    let path = names.find(|path| path.symlink_metadata().is_err());
    let path = path.ok_or(SaveError::Full)?;
    let folder = OutputFolder::new(&path, &scene.input_files());
    let copy = folder.write("scene.toml", scene.source().text().as_bytes())?;
    let mut logs = Vec::new();
    for (number, pane) in (1..).zip(panes) {
        folder.write(&format!("state-{number}.bin"), &pane.state_bytes())?;
        logs.push(folder.write(&format!("commands-{number}.log"), pane.log().as_bytes())?);
    }
    let scene = scene_to_run(scene, &copy);
    let log = logs.first().map(|log| shown(log)).unwrap_or_default();
    Ok(Event::Saved {
        folder: path.display().to_string(),
        replay: format!("sinew run {} --replay {log}", shown(&scene)),
    })
}

/// The scene's own file, beside which its meshes lie, unless it is another text.
fn scene_to_run(scene: &Scene, copy: &Path) -> PathBuf {
    let source = scene.source();
    let own = std::fs::read_to_string(source.path());
    match own.is_ok_and(|text| text == source.text()) {
        true => source.path().to_owned(),
        false => copy.to_owned(),
    }
}

/// A path as a shell takes it.
fn shown(path: &Path) -> String {
    let path = path.display().to_string();
    match path.contains(|letter: char| letter.is_whitespace() || letter == '\'') {
        true => format!("'{}'", path.replace('\'', r"'\''")),
        false => path,
    }
}
