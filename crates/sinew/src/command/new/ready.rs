//! The ready scenes: a list of them, and files.

use std::path::Path;

use sinew_scene::Scene;
use sinew_scene::output::{Destination, say};

use super::scene_file::written;
use crate::command::Failure;
use crate::command::own_file::{Force, holds};
use crate::command::pace::{in_words, pace_of};
use crate::command::ready::{READY, Ready};

/// Prints names and titles.
pub(super) fn list() -> Result<(), Failure> {
    for ready in READY {
        let scene = Scene::parse(ready.source())?;
        say(&format!("{:<14} {}", ready.name, scene.title()))?;
    }
    Ok(say(
        "`sinew new --ready NAME` writes one, with what it reads; `sinew new --list --pace` measures for a second each how fast they are on this computer",
    )?)
}

/// Prints names, measured paces and titles, each as soon as it is measured.
pub(super) fn list_with_paces() -> Result<(), Failure> {
    for ready in READY {
        let scene = Scene::parse(ready.source())?;
        let title = scene.title().to_owned();
        let pace = in_words(pace_of(scene, &[], &|| false)?);
        say(&format!("{:<14} {pace:<34} {title}", ready.name))?;
    }
    Ok(say(
        "paces are simulated time over time, measured for a second each beside all else that this computer does now",
    )?)
}

/// Writes a scene to `out`, with the file that it reads next to it.
pub(super) fn write(name: &str, out: &Path, force: Force) -> Result<(), Failure> {
    let Some(ready) = Ready::find(name) else {
        return Err(Failure::NotReady {
            name: name.to_owned(),
            known: READY.iter().map(|ready| ready.name).collect(),
        });
    };
    let scene = ready.text();
    let destination = Destination::new(out, &[])?;
    force.check(&destination, || holds(out, scene.as_bytes()))?;
    if let Some((name, bytes)) = ready.file {
        let beside = out.with_file_name(name);
        // One that is there already may be used by other scenes, and stays.
        if !holds(&beside, bytes) {
            // A reader that closed its pipe is no error.
            let _ = force.write(Destination::new(&beside, &[])?, bytes)?;
        }
    }
    written(destination, &scene, force)
}
