//! The section about tools.

use crate::number::{count, short, vector};
use crate::scene::{Body, StartsInside, Tool, ToolPart, ToolPath, ToolShape, ToolStart};
use crate::simulation::BodyModel;

/// A line for each tool: its kind, its motion and the nodes that it touches.
pub(super) fn lines(body: &Body, built: &BodyModel) -> Vec<String> {
    let known = built.tools.iter().flat_map(|tools| tools.tools());
    let tools = body.tools.iter().zip(known);
    tools
        .enumerate()
        .map(|(index, (tool, known))| {
            if body.is_cut_by(index) {
                let (shape, way) = (shape(&tool.parts), way(&tool.path));
                return format!(
                    "`{}`: {shape} {way}; it cuts, and touches nothing",
                    tool.name
                );
            }
            let on = match &tool.touches {
                None => "the surface".to_owned(),
                Some(group) => format!("`{group}`"),
            };
            format!(
                "`{}`: {} {}; touches {on}, {}{}",
                tool.name,
                shape(&tool.parts),
                way(&tool.path),
                count(known.cells.len(), "node"),
                rest(tool)
            )
        })
        .collect()
}

fn shape(parts: &[ToolPart]) -> String {
    let of = |part: &ToolPart| match part.shape {
        ToolShape::Sphere { radius } => format!("sphere of radius {} m", short(radius)),
        ToolShape::Capsule { radius, length } => format!(
            "capsule of radius {} m and length {} m",
            short(radius),
            short(length)
        ),
        ToolShape::Plane => "plane".to_owned(),
        ToolShape::Box { size } => format!("box of {} m", vector(size)),
        ToolShape::Blade { length } => format!("blade of {} m", short(length)),
    };
    parts.iter().map(of).collect::<Vec<_>>().join(" and ")
}

fn way(path: &ToolPath) -> String {
    let from = |start: &ToolStart| vector(start.position);
    match path {
        ToolPath::Hold(start) => format!("fixed at {} m", from(start)),
        ToolPath::Velocity(start, velocity) => {
            format!("from {} m at {} m/s", from(start), vector(*velocity))
        }
        ToolPath::Table(path) => format!("by {}", path.display()),
    }
}

/// Rare properties of a tool.
fn rest(tool: &Tool) -> String {
    let mut text = String::new();
    if tool.friction > 0.0 {
        text.push_str(&format!(", friction {}", short(tool.friction)));
    }
    if let Some(grasp) = tool.grasp {
        text.push_str(&format!(", grasps from {} s to {} s", grasp.from, grasp.to));
    }
    if let Some(body) = tool.body {
        text.push_str(&format!(
            ", a body of {} kg on springs of {} N/m and {} N m/rad",
            short(body.mass),
            short(body.coupling),
            short(body.rotational_coupling)
        ));
    }
    if tool.starts_inside == StartsInside::Push {
        text.push_str(", pushes out what is inside at t = 0");
    }
    text
}
