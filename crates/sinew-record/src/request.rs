//! Record of a run: all that is needed to run it again.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sinew_scene::output::OwnedFolder;
use sinew_scene::{Scene, SceneSource};
use sinew_world::InputFile;

use crate::error::RecordRunError;

/// Its file.
pub(crate) const NAME: &str = "run.json";

/// The text of the scene.
pub(crate) const SCENE: &str = "scene.toml";

/// The log of a session that was repeated.
pub(crate) const LOG: &str = "session.log";

/// Version of the files in a folder.
const VERSION: u32 = 1;

/// Settings of a run that are not part of its scene.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Request {
    /// Largest number of threads, or "auto", instead of the scene's.
    pub threads: Option<String>,
    /// Warnings before the run, which are also written into the summary.
    pub warnings: Vec<String>,
    /// Values that were set in the scene. The scene already contains them; they are recorded for the user.
    pub values: Vec<String>,
    /// True if a run in the folder that could be continued is discarded.
    pub again: bool,
}

/// A request with the scene and its inputs, in the format of a folder.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Record {
    /// Version of the files.
    version: u32,
    /// Version of the program.
    sinew: String,
    /// The scene's path: paths in it are relative to its folder.
    pub(crate) scene: PathBuf,
    pub(crate) inputs: Vec<InputFile>,
    pub(crate) threads: Option<String>,
    pub(crate) warnings: Vec<String>,
    /// Values that the command line set in the scene.
    values: Vec<String>,
    /// The log of the repeated session, in the same folder as this file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) log: Option<String>,
}

impl Record {
    pub(crate) fn of(scene: &Scene, request: &Request) -> Result<Self, RecordRunError> {
        let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let scene_path = absolute(scene.source().path());
        // The scene itself is kept as a text.
        let others = scene.input_files().into_iter().skip(1);
        let inputs = others.map(|path| {
            let file = InputFile::of(scene.source(), path)?;
            Ok(InputFile {
                path: absolute(&file.path),
                ..file
            })
        });
        Ok(Self {
            version: VERSION,
            sinew: env!("CARGO_PKG_VERSION").to_owned(),
            scene: scene_path,
            inputs: inputs.collect::<Result<_, RecordRunError>>()?,
            threads: request.threads.clone(),
            warnings: request.warnings.clone(),
            values: request.values.clone(),
            log: None,
        })
    }

    pub(crate) fn write(&self, folder: &OwnedFolder, scene: &Scene) -> Result<(), RecordRunError> {
        let json =
            serde_json::to_string_pretty(self).map_err(|error| unusable(folder, NAME, &error))?;
        folder.write(SCENE, scene.source().text().as_bytes())?;
        Ok(folder.write(NAME, format!("{json}\n").as_bytes())?)
    }

    /// Reads the request and the scene of an earlier run in this folder, and checks that its inputs are unchanged.
    pub(crate) fn read(folder: &OwnedFolder) -> Result<(Self, Scene), RecordRunError> {
        let missing = |name| unusable(folder, name, &"it is not there");
        let json = folder.read(NAME)?.ok_or_else(|| missing(NAME))?;
        let record: Self =
            serde_json::from_slice(&json).map_err(|error| unusable(folder, NAME, &error))?;
        if record.version != VERSION {
            let reason = format!("it is of version {}, expected {VERSION}", record.version);
            return Err(unusable(folder, NAME, &reason));
        }
        if record.log.is_some() {
            let folder = folder.path().to_owned();
            return Err(RecordRunError::Replay { folder });
        }
        let text = folder.read(SCENE)?.ok_or_else(|| missing(SCENE))?;
        let text = String::from_utf8(text).map_err(|error| unusable(folder, SCENE, &error))?;
        let source = SceneSource::new(&record.scene, text);
        for input in &record.inputs {
            if InputFile::of(&source, input.path.clone())? != *input {
                let path = input.path.clone();
                return Err(RecordRunError::OtherInput { path });
            }
        }
        Ok((record, Scene::parse(source)?))
    }
}

fn unusable(
    folder: &OwnedFolder,
    name: &'static str,
    reason: &dyn std::fmt::Display,
) -> RecordRunError {
    RecordRunError::Unusable {
        folder: folder.path().to_owned(),
        name,
        reason: reason.to_string(),
    }
}
