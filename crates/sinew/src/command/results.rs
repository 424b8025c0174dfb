//! Results that a command reads: those of a folder, or of a scene that is run for it.

use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::Failure;
use super::interruption::Interruption;
use super::run::run_for_reader;

/// The results of a run.
pub(super) enum Results {
    /// Results in a folder of the user.
    Kept(PathBuf),
    /// Results in a temporary folder, which is deleted with this value.
    Passing(TempDir),
}

impl Results {
    /// The results in a folder, or those of a scene, which is run.
    pub(super) fn of(path: &Path, interruption: &Interruption) -> Result<Self, Failure> {
        if !names_scene(path) {
            return Ok(Self::Kept(path.to_owned()));
        }
        let folder = tempfile::Builder::new().prefix("sinew-results-").tempdir();
        let folder = folder.map_err(Failure::TemporaryFolder)?;
        run_for_reader(path, folder.path(), interruption.clone())?;
        Ok(Self::Passing(folder))
    }

    pub(super) fn folder(&self) -> &Path {
        match self {
            Self::Kept(path) => path,
            Self::Passing(folder) => folder.path(),
        }
    }
}

/// True for a path that names a scene and no folder.
pub(super) fn names_scene(path: &Path) -> bool {
    let is_scene = path
        .extension()
        .is_some_and(|extension| extension == "toml");
    !path.is_dir() && (path.is_file() || is_scene)
}
