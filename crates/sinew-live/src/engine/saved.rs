//! A moment that is saved.

use std::path::Path;

use sinew_scene::SceneSource;
use sinew_scene::output::{OutputError, OutputFolder};

use super::pane::Pane;
use crate::protocol::Event;
use crate::scene_values::SceneValues;

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
pub(crate) fn save(scene: &SceneValues, panes: &[Pane]) -> Result<Event, SaveError> {
    let here = std::env::current_dir()?;
    let mut names = (1..=MOST).map(|number| here.join(format!("live-{number}")));
    let path = names.find(|path| path.symlink_metadata().is_err());
    let path = path.ok_or(SaveError::Full)?;
    let folder = OutputFolder::new(&path, &scene.scene.input_files());
    let text = scene.scene.source().text();
    let copy = folder.write("scene.toml", text.as_bytes())?;
    let mut logs = Vec::new();
    for (number, pane) in (1..).zip(panes) {
        folder.write(&format!("state-{number}.bin"), &pane.state_bytes())?;
        logs.push(folder.write(
            &format!("commands-{number}.log"),
            pane.log().to_text().as_bytes(),
        )?);
    }
    let log = logs.first().map(|log| word(&log.display().to_string()));
    let own = own_file(scene);
    let note = match &own {
        None => beside_others(scene, &copy),
        Some(_) => None,
    };
    Ok(Event::Saved {
        folder: path.display().to_string(),
        replay: format!(
            "sinew run {} --replay {}",
            own.unwrap_or_else(|| word(&copy.display().to_string())),
            log.unwrap_or_default()
        ),
        note,
    })
}

/// The scene as words of a command: its own file, beside which its meshes and tables lie, with the values that are set in it; `None` where the file has changed
/// since.
fn own_file(scene: &SceneValues) -> Option<String> {
    let source = scene.scene.source();
    let own = std::fs::read_to_string(source.path());
    let own = own.map(|text| SceneSource::new(source.path(), text).with_values(&scene.values));
    if !matches!(own, Ok(Ok(own)) if own.text() == source.text()) {
        return None;
    }
    let mut words = word(&source.path().display().to_string());
    for value in &scene.values {
        words.push_str(" --set ");
        words.push_str(&word(value));
    }
    Some(words)
}

/// Where the copy of a scene that reads other files finds them: its text, by whose hash the log knows it, names them as seen from the folder of its own file.
fn beside_others(scene: &SceneValues, copy: &Path) -> Option<String> {
    let files = scene.scene.input_files();
    let [own, _, ..] = files.as_slice() else {
        return None;
    };
    let folder = own.parent().filter(|folder| *folder != Path::new(""));
    Some(format!(
        "The scene's file has changed since, and its copy names other files as seen from {}: copy {} there first, and give that.",
        folder.unwrap_or(Path::new(".")).display(),
        copy.display()
    ))
}

/// A word as a shell takes it.
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
    fn words_with_other_letters_are_quoted_for_the_shell() {
        assert_eq!(word("scenes/press.toml"), "scenes/press.toml");
        assert_eq!(
            word("tool.1.shape={ plane = {} }"),
            "'tool.1.shape={ plane = {} }'"
        );
        assert_eq!(word("it's $HOME"), r"'it'\''s $HOME'");
    }
}
