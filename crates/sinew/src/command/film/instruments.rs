//! The tools of a run: parts from its scene, poses from its table.

use std::path::{Path, PathBuf};

use serde_json::Value;
use sinew_film::{Part, PoseAt, Shape, Tool, back_of, blades_of_strokes, poses_of_table};
use sinew_scene::{Blade, Body, Scene, SceneSource, Subject, ToolPath, ToolShape};

use super::run_files::read_within;

/// The title of a run and its instruments, as far as they are known.
pub(super) struct Known {
    pub(super) title: Option<String>,
    pub(super) tools: Vec<Tool>,
    /// Things missing from the picture, each with the reason.
    pub(super) missing: Vec<String>,
}

/// The title and the tools that the scene of a run folder describes.
pub(super) fn known_of(folder: &Path) -> Known {
    let scene = match scene_of(folder) {
        Ok(scene) => scene,
        Err(reason) => {
            return Known {
                title: None,
                tools: Vec::new(),
                missing: vec![format!("tools are not shown: {reason}")],
            };
        }
    };
    let mut known = Known {
        title: Some(scene.title_or_path().into_owned()),
        tools: Vec::new(),
        missing: Vec::new(),
    };
    if let Subject::Body(body) = scene.subject() {
        known.add_tools(folder, body);
        known.add_blades(&scene, body);
    }
    known
}

impl Known {
    fn add_tools(&mut self, folder: &Path, body: &Body) {
        if body.tools.is_empty() {
            return;
        }
        let table = match read_within(folder, "tools.csv") {
            Ok(table) => String::from_utf8_lossy(&table).into_owned(),
            Err(reason) => {
                self.missing
                    .push(format!("tools are not shown: tools.csv: {reason}"));
                return;
            }
        };
        for tool in &body.tools {
            let rotation = match &tool.path {
                ToolPath::Hold(start) | ToolPath::Velocity(start, _) => start.rotation,
                // One that turns has columns of its rotation.
                ToolPath::Table(_) => [0.0; 3],
            };
            let Some(poses) = poses_of_table(&table, &tool.name, rotation) else {
                let name = &tool.name;
                self.missing.push(format!(
                    "tool \"{name}\" is not shown: tools.csv has not its places"
                ));
                continue;
            };
            let parts = tool.parts.iter().map(|part| Part {
                shape: shape(&part.shape, &poses),
                at: part.at,
                rotation: part.rotation,
            });
            let parts = parts.collect();
            self.tools.push(Tool::new(parts, poses));
        }
    }

    fn add_blades(&mut self, scene: &Scene, body: &Body) {
        let Some(Blade::Table(written)) = body.cutting.as_ref().map(|cutting| &cutting.blade)
        else {
            return;
        };
        let path = scene.source().resolve(written);
        let text = std::fs::read_to_string(&path);
        match text.map(|text| blades_of_strokes(&text)) {
            Ok(Some(blades)) => self.tools.extend(blades),
            Ok(None) => {
                let path = path.display();
                self.missing.push(format!(
                    "the blade is not shown: {path} is no table of strokes"
                ));
            }
            Err(reason) => {
                let path = path.display();
                self.missing
                    .push(format!("the blade is not shown: {path}: {reason}"));
            }
        }
    }
}

/// The scene of a run folder. Its files may be absent: only its text is needed.
fn scene_of(folder: &Path) -> Result<Scene, String> {
    let read = |name: &str| {
        let bytes = read_within(folder, name).map_err(|reason| format!("{name}: {reason}"))?;
        String::from_utf8(bytes).map_err(|reason| format!("{name}: {reason}"))
    };
    let record = read("run.json")?;
    let record: Value =
        serde_json::from_str(&record).map_err(|reason| format!("run.json: {reason}"))?;
    let path = record["scene"]
        .as_str()
        .map_or_else(|| folder.join("scene.toml"), PathBuf::from);
    let source = SceneSource::new(path, read("scene.toml")?);
    Scene::parse(source).map_err(|error| format!("scene.toml: {error}"))
}

fn shape(shape: &ToolShape, poses: &[PoseAt]) -> Shape {
    match *shape {
        ToolShape::Sphere { radius } => Shape::Sphere { radius },
        ToolShape::Capsule { radius, length } => Shape::Capsule { radius, length },
        ToolShape::Plane => Shape::Plane,
        ToolShape::Box { size } => Shape::Box { size },
        ToolShape::Blade { length } => Shape::Blade {
            length,
            back: back_of(poses),
        },
    }
}
