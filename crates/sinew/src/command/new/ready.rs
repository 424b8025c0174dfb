//! The ready scenes, which come with the command.

use std::path::Path;

use sinew_scene::output::say;
use sinew_scene::{Scene, SceneSource};

use super::scene_file::{new_file, written};
use crate::command::Failure;

/// A ready scene, with its mesh.
struct Ready {
    name: &'static str,
    scene: &'static str,
    /// File name and contents of its mesh.
    mesh: Option<(&'static str, &'static [u8])>,
}

macro_rules! scene {
    ($file:literal) => {
        include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/ready/", $file))
    };
}

macro_rules! mesh {
    ($file:literal) => {
        include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/ready/", $file))
    };
}

/// All of them, the one to begin with first.
const READY: &[Ready] = &[
    Ready {
        name: "held-cube",
        scene: scene!("held-cube.toml"),
        mesh: Some(("paper-cube-mirrored.msh", mesh!("paper-cube-mirrored.msh"))),
    },
    Ready {
        name: "organ",
        scene: scene!("organ.toml"),
        mesh: Some(("organ.msh", mesh!("organ.msh"))),
    },
    Ready {
        name: "organ-pressed",
        scene: scene!("organ-pressed.toml"),
        mesh: Some(("organ.msh", mesh!("organ.msh"))),
    },
    Ready {
        name: "organ-fibres",
        scene: scene!("organ-fibres.toml"),
        mesh: Some(("organ.msh", mesh!("organ.msh"))),
    },
    Ready {
        name: "muscle",
        scene: scene!("muscle.toml"),
        mesh: Some(("muscle.msh", mesh!("muscle.msh"))),
    },
    Ready {
        name: "creep",
        scene: scene!("creep.toml"),
        mesh: None,
    },
    Ready {
        name: "twisted-column",
        scene: scene!("twisted-column.toml"),
        mesh: None,
    },
    Ready {
        name: "beam",
        scene: scene!("beam.toml"),
        mesh: Some(("beam.msh", mesh!("beam.msh"))),
    },
    Ready {
        name: "vessel",
        scene: scene!("vessel.toml"),
        mesh: Some(("vessel.msh", mesh!("vessel.msh"))),
    },
    Ready {
        name: "layers",
        scene: scene!("layers.toml"),
        mesh: Some(("layers.msh", mesh!("layers.msh"))),
    },
    Ready {
        name: "needle",
        scene: scene!("needle.toml"),
        mesh: Some(("needle.msh", mesh!("needle.msh"))),
    },
    Ready {
        name: "inclusion",
        scene: scene!("inclusion.toml"),
        mesh: None,
    },
    Ready {
        name: "incision",
        scene: scene!("incision.toml"),
        mesh: Some(("incision.msh", mesh!("incision.msh"))),
    },
    Ready {
        name: "slivers",
        scene: scene!("slivers.toml"),
        mesh: Some(("slivers.msh", mesh!("slivers.msh"))),
    },
];

/// The folder of the meshes as seen from the scenes.
const MESHES: &str = "../../meshes/";

/// Prints names and titles.
pub(super) fn list() -> Result<(), Failure> {
    for Ready { name, scene, .. } in READY {
        let scene = Scene::parse(SceneSource::new(*name, *scene))?;
        say(&format!("{name:<12} {}", scene.title()))?;
    }
    Ok(say("`sinew new --ready NAME` writes one, with its mesh")?)
}

/// Writes a scene to `out`, and its mesh beside it.
pub(super) fn write(name: &str, out: &Path) -> Result<(), Failure> {
    let ready = READY.iter().find(|ready| ready.name == name);
    let Some(Ready { scene, mesh, .. }) = ready else {
        return Err(Failure::NotReady {
            name: name.to_owned(),
            known: READY.iter().map(|ready| ready.name).collect(),
        });
    };
    let destination = new_file(out, &[])?;
    if let Some((file, bytes)) = mesh {
        let beside = out.with_file_name(file);
        // One that is there already may be used by other scenes, and stays.
        if std::fs::read(&beside).ok().as_deref() != Some(*bytes) {
            // A reader that closed its pipe is no error.
            let _ = new_file(&beside, &[])?.write(bytes)?;
        }
    }
    written(destination, &scene.replace(MESHES, ""))
}
