//! Facts about tools that pages receive.

use sinew_core::Inputs;
use sinew_scene::{BodyModel, Simulation};
use sinew_tools::{Convex, Part, Tool};

use crate::new_tool::AddedTool;
use crate::protocol::{PartFacts, ToolFacts};

/// The tools of a scene at the beginning, of which pages added the last ones.
pub(crate) fn tools_of(
    body: &BodyModel,
    simulation: &Simulation,
    added: &[AddedTool],
) -> Vec<ToolFacts> {
    let Some(tools) = &body.tools else {
        return Vec::new();
    };
    let state = simulation.initial_state();
    let own = tools.tools().len().saturating_sub(added.len());
    let facts = tools.tools().iter().enumerate().map(|(index, tool)| {
        let kind = index.checked_sub(own).and_then(|index| added.get(index));
        let pose = tools.pose(state, Inputs::none(), index);
        let ([x, y, z], [a, b, c]) = (pose.position(), pose.rotation_vector());
        let Tool { name, shape, .. } = tool;
        ToolFacts {
            name: name.clone(),
            parts: shape.parts().iter().map(part_facts).collect(),
            start: [x, y, z, a, b, c],
            added: kind.map(|tool| tool.kind),
        }
    });
    facts.collect()
}

fn part_facts(part: &Part) -> PartFacts {
    let (kind, sizes) = match part.convex {
        Convex::Sphere { radius, .. } => ("sphere", vec![radius]),
        Convex::Capsule { radius, length, .. } => ("capsule", vec![radius, length]),
        Convex::Plane => ("plane", Vec::new()),
        Convex::Cuboid { size, .. } => ("box", size.to_vec()),
    };
    PartFacts {
        kind,
        sizes,
        position: part.pose.position(),
        rotation: part.pose.rotation_vector(),
    }
}
