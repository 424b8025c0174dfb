//! Warnings about effects of tools that a user may not expect.

use sinew_core::{Inputs, System};
use sinew_tools::Motion;

use super::{Warning, WarningKind};
use crate::number::{length, short};
use crate::scene::Subject;
use crate::simulation::Simulation;
use crate::simulation::model::BodyModel;
use crate::simulation::tool::{ROUNDING, inside, nodes_of};

pub(super) fn warnings(simulation: &Simulation, built: &BodyModel) -> Vec<Warning> {
    let Some(tools) = &built.tools else {
        return Vec::new();
    };
    let mut warnings = Vec::new();
    for (index, tool) in tools.tools().iter().enumerate() {
        let name = &tool.name;
        if simulation.scene().is_cut_by(index) {
            // It touches nothing.
            continue;
        }
        let start = inside(tools, index, built, simulation.initial_state());
        warnings.extend(start.map(|(node, depth)| {
            let what = format!(
                "tool `{name}` begins inside the body: the first step pushes node {node} out of it by {} m",
                short(depth)
            );
            Warning::new(WarningKind::ToolInside, what, "").with(&[("depth_m", depth)])
        }));
        warnings.extend(unmet(simulation, built, index));
        if !tool.triangles.is_empty() {
            let half_width = tool.shape.smallest_half_width();
            let what = format!(
                "tool `{name}` has a radius or half a thickness of {} m, below the longest edge of the surface within its reach: it meets triangles as well as \
                 nodes, and how deep it gets depends on the mesh",
                short(half_width)
            );
            let warning = Warning::new(
                WarningKind::SmallTool,
                what,
                "refine the mesh where it presses",
            );
            warnings.push(warning.with(&[("radius_m", half_width)]));
        }
        let way = highest_speed(&tool.motion) * simulation.dt();
        let size = built.model.extent().unwrap_or(f64::INFINITY);
        if way > size {
            let what = format!(
                "tool `{name}` goes {} m in a step, farther than the body is large, {} m",
                short(way),
                short(size)
            );
            let warning = Warning::new(WarningKind::FastTool, what, "is its velocity in m/s?");
            warnings.push(warning.with(&[("way_m", way), ("body_m", size)]));
        }
    }
    warnings
}

/// Number of instants at which nodes without contact are checked against a tool.
const LOOKS: u32 = 64;

/// A warning about nodes that are fixed or moved, and through which a tool passes.
fn unmet(simulation: &Simulation, built: &BodyModel, index: usize) -> Option<Warning> {
    let Subject::Body(body) = simulation.scene().subject() else {
        return None;
    };
    let (_, nodes) = nodes_of(&body.tools[index], built).ok()?;
    let tool = &built.tools.as_ref()?.tools()[index];
    let size = built.model.extent().unwrap_or(0.0);
    let mut u = vec![[0.0; 3]; built.mesh.points.len()];
    for look in 0..=LOOKS {
        let t = simulation.settings().duration * f64::from(look) / f64::from(LOOKS);
        let pose = tool.motion.at(t, Inputs::none());
        let still = &simulation.initial_state().u;
        built.model.displacements_at(t, still, &mut u).ok()?;
        let is_inside = |node: &&u32| {
            let (point, u) = (built.mesh.points[**node as usize], u[**node as usize]);
            let at = std::array::from_fn(|axis| point[axis] + u[axis]);
            tool.shape.distance(&pose, at) < -ROUNDING * size
        };
        if let Some(node) = nodes.iter().find(is_inside) {
            let what = format!(
                "tool `{}` passes through node {} at t = {} s, which is fixed or has a prescribed motion: tools touch free nodes only",
                tool.name,
                built.mesh.node_tags[*node as usize],
                short(t)
            );
            let warning = Warning::new(
                WarningKind::UnmetNodes,
                what,
                "keep the tool away from fixed nodes",
            );
            return Some(warning.with(&[("t_s", t)]));
        }
    }
    None
}

/// The highest speed (m/s) of a tool's origin.
fn highest_speed(motion: &Motion) -> f64 {
    match motion {
        Motion::Held(_) => 0.0,
        Motion::Steered(own, _) => highest_speed(own),
        Motion::Steady { velocity, .. } => length(*velocity),
        Motion::Table(table) => {
            let speeds = table.rows().windows(2).map(|rows| {
                let way =
                    std::array::from_fn(|axis| rows[1].position[axis] - rows[0].position[axis]);
                length(way) / (rows[1].t - rows[0].t)
            });
            speeds.fold(0.0, f64::max)
        }
    }
}
