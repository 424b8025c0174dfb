//! The instruments of a run: parts from its scene, poses from its table.

use std::io;

use sinew_film::{Part, PoseAt, Shape, Tool, back_of, blades_of_strokes, poses_of_table};
use sinew_scene::{Blade, Body, Scene, Subject, ToolPath, ToolShape};

use crate::tool_rows;

/// The instruments of a run, as far as they are known.
#[derive(Default)]
pub struct Instruments {
    /// Tools and blades with their motion.
    pub tools: Vec<Tool>,
    /// Things missing from a picture, each with the reason.
    pub missing: Vec<String>,
}

impl Instruments {
    /// The instruments of a scene's run whose files `read` returns by their names. The file of strokes is read where
    /// the scene says.
    #[must_use]
    pub fn of(scene: &Scene, read: &dyn Fn(&str) -> io::Result<Vec<u8>>) -> Self {
        let mut known = Self::default();
        if let Subject::Body(body) = scene.subject() {
            known.add_tools(read, body);
            known.add_blades(scene, body);
        }
        known
    }

    fn add_tools(&mut self, read: &dyn Fn(&str) -> io::Result<Vec<u8>>, body: &Body) {
        if body.tools.is_empty() {
            return;
        }
        let table = match read(tool_rows::NAME) {
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
