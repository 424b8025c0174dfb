//! `cargo xtask reference`.

use sinew_scene::output::{Destination, say};

use crate::failure::Failure;
use crate::repository::root;

/// Writes the reference and the JSON schema of scenes, as `sinew scene-reference` prints them, into `docs`.
pub(crate) fn run() -> Result<(), Failure> {
    let files = [
        ("docs/scene-reference.md", sinew_scene::scene_reference()),
        ("docs/scene.schema.json", sinew_scene::scene_schema()),
    ];
    for (path, text) in files {
        let destination = Destination::new(root().join(path), &[])?;
        let _ = destination.write(text.as_bytes())?;
        say(path)?;
    }
    Ok(())
}
