//! Scene files that are written.

use sinew_scene::output::{Destination, Voice, say};

use crate::command::Failure;
use crate::command::own_file::Force;

/// Writes a scene and prints the commands that can use it.
pub(super) fn written(destination: Destination, scene: &str, force: Force) -> Result<(), Failure> {
    let path = destination.path().display().to_string();
    let voice = Voice::apart_from(&destination);
    // A reader that closed its pipe is no error.
    let _ = force.write(destination, scene.as_bytes())?;
    if voice == Voice::StandardOutput {
        say(&format!(
            "written {path}: `sinew plan {path}` says what it builds, `sinew run {path}` runs it"
        ))?;
    }
    Ok(())
}
