//! Scene files that are written: never over another.

use std::path::{Path, PathBuf};

use sinew_scene::output::{Destination, Voice, say};

use crate::command::Failure;

/// A destination that is a stream or a new file: a scene may have been changed by hand.
pub(super) fn new_file(path: &Path, inputs: &[PathBuf]) -> Result<Destination, Failure> {
    let destination = Destination::new(path, inputs)?;
    if !destination.is_stream() && path.symlink_metadata().is_ok() {
        let path = path.to_owned();
        return Err(Failure::Exists { path });
    }
    Ok(destination)
}

/// Writes a scene and says what can be done with it.
pub(super) fn written(destination: Destination, scene: &str) -> Result<(), Failure> {
    let path = destination.path().display().to_string();
    let voice = Voice::apart_from(&destination);
    // A reader that closed its pipe is no error.
    let _ = destination.write(scene.as_bytes())?;
    if voice == Voice::StandardOutput {
        say(&format!(
            "written {path}: `sinew plan {path}` says what it builds, `sinew run {path}` runs it"
        ))?;
    }
    Ok(())
}
