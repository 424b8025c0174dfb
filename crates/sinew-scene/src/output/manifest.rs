//! The manifest of a folder: its owner and the files that were written into it.

use std::collections::HashSet;
use std::fs;
use std::io::ErrorKind;
use std::path::{Component, Path};

use super::error::OutputError;

/// Its name.
pub(super) const MANIFEST: &str = "manifest.json";

/// Kind, state and files of a result.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Manifest {
    pub(super) kind: String,
    pub(super) state: State,
    /// The name of the folder that it was in before it was set aside.
    pub(super) aside_of: Option<String>,
    /// Names of its files, with `/` after their folders.
    pub(super) files: Vec<String>,
}

/// The state of a result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum State {
    /// A result that is being written, or whose writer was killed.
    Unfinished,
    /// A complete result.
    Finished,
    /// A complete result that is kept until the one that replaces it is complete too.
    SetAside,
}

impl State {
    const ALL: [Self; 3] = [Self::Unfinished, Self::Finished, Self::SetAside];

    fn name(self) -> &'static str {
        match self {
            Self::Unfinished => "unfinished",
            Self::Finished => "finished",
            Self::SetAside => "set aside",
        }
    }
}

impl Manifest {
    /// The manifest in a folder; `None` if absent, or if it belongs to another program.
    pub(super) fn read(folder: &Path) -> Result<Option<Self>, OutputError> {
        let path = folder.join(MANIFEST);
        let is_file = path.symlink_metadata().map(|found| found.is_file());
        let text = match is_file.and_then(|is_file| is_file.then(|| fs::read(&path)).transpose()) {
            Ok(Some(text)) => text,
            // A link is none of ours.
            Ok(None) => return Ok(None),
            Err(error)
                if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) =>
            {
                return Ok(None);
            }
            Err(source) => return Err(OutputError::NotOpened { path, source }),
        };
        Ok(Self::parse(&text))
    }

    fn parse(text: &[u8]) -> Option<Self> {
        let json: serde_json::Value = serde_json::from_slice(text).ok()?;
        let names = json["files"].as_array()?.iter();
        let files: Vec<String> = names
            .map(|name| name.as_str().map(str::to_owned))
            .collect::<Option<_>>()?;
        // A name that leads out of the folder was not written by us.
        let plain = |part: Component<'_>| matches!(part, Component::Normal(_));
        let stays = |name: &String| !name.is_empty() && Path::new(name).components().all(plain);
        let state = json["state"].as_str().unwrap_or(State::Finished.name());
        files.iter().all(stays).then_some(Self {
            kind: json["sinew"].as_str()?.to_owned(),
            aside_of: json["aside_of"].as_str().map(str::to_owned),
            state: State::ALL.into_iter().find(|known| known.name() == state)?,
            files,
        })
    }

    pub(super) fn to_json(&self) -> String {
        let state = self.state.name();
        let mut json =
            serde_json::json!({ "sinew": self.kind, "state": state, "files": self.files });
        if let Some(name) = &self.aside_of {
            json["aside_of"] = name.as_str().into();
        }
        format!("{json:#}\n")
    }

    /// Names of all its files, and of the folders in which they are.
    pub(super) fn names(&self) -> Names<'_> {
        let files: HashSet<&str> = self.files.iter().map(String::as_str).collect();
        let above = |name: &'_ str| {
            name.rmatch_indices('/')
                .map(|(end, _)| end)
                .collect::<Vec<_>>()
        };
        let folders = files
            .iter()
            .flat_map(|name| above(name).into_iter().map(|end| &name[..end]))
            .collect();
        Names { files, folders }
    }
}

/// Names of a result's files and folders.
pub(super) struct Names<'a> {
    pub(super) files: HashSet<&'a str>,
    pub(super) folders: HashSet<&'a str>,
}
