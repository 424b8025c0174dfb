//! The ready scenes, which come with the command.

use sinew_scene::SceneSource;

/// A ready scene, with the file that it reads.
pub(crate) struct Ready {
    /// Its name.
    pub(crate) name: &'static str,
    scene: &'static str,
    /// Name and contents of the file next to it: a mesh, or the table of a tool.
    pub(crate) file: Option<(&'static str, &'static [u8])>,
}

macro_rules! scene {
    ($file:literal) => {
        include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/ready/", $file))
    };
}

macro_rules! file {
    ($file:literal) => {
        include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/ready/", $file))
    };
}

/// All ready scenes; the recommended first one comes first.
pub(crate) const READY: &[Ready] = &[
    Ready {
        name: "held-cube",
        scene: scene!("held-cube.toml"),
        file: Some(("paper-cube-mirrored.msh", file!("paper-cube-mirrored.msh"))),
    },
    Ready {
        name: "organ",
        scene: scene!("organ.toml"),
        file: Some(("organ.msh", file!("organ.msh"))),
    },
    Ready {
        name: "organ-pressed",
        scene: scene!("organ-pressed.toml"),
        file: Some(("organ.msh", file!("organ.msh"))),
    },
    Ready {
        name: "organ-fibres",
        scene: scene!("organ-fibres.toml"),
        file: Some(("organ.msh", file!("organ.msh"))),
    },
    Ready {
        name: "muscle",
        scene: scene!("muscle.toml"),
        file: Some(("muscle.msh", file!("muscle.msh"))),
    },
    Ready {
        name: "artery",
        scene: scene!("artery.toml"),
        file: Some(("artery.msh", file!("artery.msh"))),
    },
    Ready {
        name: "creep",
        scene: scene!("creep.toml"),
        file: None,
    },
    Ready {
        name: "twisted-column",
        scene: scene!("twisted-column.toml"),
        file: None,
    },
    Ready {
        name: "beam",
        scene: scene!("beam.toml"),
        file: Some(("beam.msh", file!("beam.msh"))),
    },
    Ready {
        name: "vessel",
        scene: scene!("vessel.toml"),
        file: Some(("vessel.msh", file!("vessel.msh"))),
    },
    Ready {
        name: "layers",
        scene: scene!("layers.toml"),
        file: Some(("layers.msh", file!("layers.msh"))),
    },
    Ready {
        name: "press",
        scene: scene!("press.toml"),
        file: Some(("press.csv", file!("press.csv"))),
    },
    Ready {
        name: "handle",
        scene: scene!("handle.toml"),
        file: Some(("handle.csv", file!("handle.csv"))),
    },
    Ready {
        name: "needle-push",
        scene: scene!("needle-push.toml"),
        file: Some(("needle-push.csv", file!("needle-push.csv"))),
    },
    Ready {
        name: "slit",
        scene: scene!("slit.toml"),
        file: Some(("slit.csv", file!("slit.csv"))),
    },
    Ready {
        name: "retract",
        scene: scene!("retract.toml"),
        file: Some(("retract.csv", file!("retract.csv"))),
    },
    Ready {
        name: "needle",
        scene: scene!("needle.toml"),
        file: Some(("needle.msh", file!("needle.msh"))),
    },
    Ready {
        name: "inclusion",
        scene: scene!("inclusion.toml"),
        file: None,
    },
    Ready {
        name: "incision",
        scene: scene!("incision.toml"),
        file: Some(("incision.msh", file!("incision.msh"))),
    },
    Ready {
        name: "slivers",
        scene: scene!("slivers.toml"),
        file: Some(("slivers.msh", file!("slivers.msh"))),
    },
];

/// The folder of the meshes as seen from the scenes.
const MESHES: &str = "../../meshes/";

impl Ready {
    /// The scene of this name.
    pub(crate) fn find(name: &str) -> Option<&'static Self> {
        READY.iter().find(|ready| ready.name == name)
    }

    /// The text of its scene file. The file that it reads is next to it.
    pub(crate) fn text(&self) -> String {
        self.scene.replace(MESHES, "")
    }

    /// The scene with the file that it reads, neither of which has to be on the disk.
    pub(crate) fn source(&self) -> SceneSource {
        let source = SceneSource::new(format!("{}.toml", self.name), self.text());
        match self.file {
            Some((name, content)) => source.with_file(name, content),
            None => source,
        }
    }
}
