//! Saving the current state.

use std::ffi::OsString;
use std::path::{Component, Path, PathBuf};

use sinew_core::BytesError;
use sinew_scene::output::{OutputError, OutputFolder};

use super::pane::Pane;
use crate::protocol::Event;
use crate::scene_values::SceneValues;

/// Largest number of folders that are checked for a free name.
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
    /// A file of the scene that cannot be read.
    #[error("{}, which the scene reads: {source}", path.display())]
    Input {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: std::io::Error,
    },
    /// A state that cannot be written.
    #[error(transparent)]
    State(#[from] BytesError),
    /// The working folder of this program no longer exists.
    #[error("no folder to save in: {0}")]
    Folder(#[from] std::io::Error),
}

/// Writes the scene with all that it reads, and state and commands of each pane, into a new folder of the current one.
/// The files have the same relative positions as the original files, so that the scene finds them.
pub(crate) fn save(scene: &SceneValues, panes: &[Pane]) -> Result<Event, SaveError> {
    let here = std::env::current_dir()?;
    let mut names = (1..=MOST).map(|number| here.join(format!("live-{number}")));
    let path = names.find(|path| path.symlink_metadata().is_err());
    let path = path.ok_or(SaveError::Full)?;
    let files = scene.scene.input_files();
    let folder = OutputFolder::new(&path, &files);
    let places = places(&files);
    let mut inputs = Vec::new();
    for (file, place) in files.iter().zip(&places).skip(1) {
        match scene.scene.source().read(file) {
            Ok(content) => inputs.push((place, content)),
            Err(source) => {
                let path = file.clone();
                return Err(SaveError::Input { path, source });
            }
        }
    }
    for (place, content) in inputs {
        folder.write(place, &content)?;
    }
    let text = scene.scene.source().text();
    let own = places.first().and_then(|own| own.rsplit_once('/'));
    let own = own.map_or(String::new(), |(above, _)| format!("{above}/"));
    let copy = folder.write(&format!("{own}scene.toml"), text.as_bytes())?;
    let mut logs = Vec::new();
    for (number, pane) in (1..).zip(panes) {
        folder.write(&format!("state-{number}.bin"), &pane.state_bytes()?)?;
        logs.push(folder.write(
            &format!("commands-{number}.log"),
            pane.log().to_text().as_bytes(),
        )?);
    }
    let log = logs.first().map(|log| word(&log.display().to_string()));
    Ok(Event::Saved {
        folder: path.display().to_string(),
        replay: format!(
            "sinew run {} --replay {}",
            word(&copy.display().to_string()),
            log.unwrap_or_default()
        ),
    })
}

/// Paths of files in a new folder that keep their relative positions, with `/` between the parts: relative to the
/// folder that contains all of them.
fn places(files: &[PathBuf]) -> Vec<String> {
    let whole: Vec<Vec<OsString>> = files.iter().map(|file| parts(file)).collect();
    let folders = whole
        .iter()
        .map(|parts| &parts[..parts.len().saturating_sub(1)]);
    let shared = folders.reduce(|one, other| {
        let same = one.iter().zip(other).take_while(|(a, b)| a == b).count();
        &one[..same]
    });
    let shared = shared.map_or(0, <[OsString]>::len);
    let below = |parts: &Vec<OsString>| {
        let names = parts[shared..].iter();
        let names = names.map(|name| name.to_string_lossy());
        names.collect::<Vec<_>>().join("/")
    };
    whole.iter().map(below).collect()
}

/// The parts of a path from the root on, without `.` and `..`.
fn parts(path: &Path) -> Vec<OsString> {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut parts = Vec::new();
    for part in whole.components() {
        match part {
            Component::Normal(name) => parts.push(name.to_owned()),
            Component::ParentDir => {
                parts.pop();
            }
            _ => {}
        }
    }
    parts
}

/// A word quoted for a shell.
fn word(text: &str) -> String {
    let is_plain = |letter: char| letter.is_alphanumeric() || "_-./=+:,@%".contains(letter);
    match text.chars().all(is_plain) {
        true => text.to_owned(),
        false => format!("'{}'", text.replace('\'', r"'\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_lie_to_each_other_as_they_did() {
        let of = |files: &[&str]| {
            let files: Vec<PathBuf> = files.iter().map(PathBuf::from).collect();
            places(&files)
        };
        assert_eq!(of(&["/a/scenes/press.toml"]), ["press.toml"]);
        assert_eq!(
            of(&["/a/scenes/press.toml", "/a/scenes/t.csv"]),
            ["press.toml", "t.csv"]
        );
        let beside = [
            "scenes/press.toml",
            "scenes/../meshes/m.msh",
            "scenes/t.csv",
        ];
        assert_eq!(
            of(&beside),
            ["scenes/press.toml", "meshes/m.msh", "scenes/t.csv"]
        );
        assert_eq!(of(&["/a/b/s.toml", "/c/m.msh"]), ["a/b/s.toml", "c/m.msh"]);
    }

    #[test]
    fn words_with_other_letters_are_quoted_for_the_shell() {
        assert_eq!(word("scenes/press.toml"), "scenes/press.toml");
        assert_eq!(
            word("tool.1.shape={ plane = {} }"),
            "'tool.1.shape={ plane = {} }'"
        );
        assert_eq!(word("it's $HOME"), r"'it'\''s $HOME'");
    }
}
