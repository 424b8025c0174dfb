//! Failures of contact with tools in a run.

use sinew_core::State;
use sinew_tools::{ToolReport, Tools};

use super::model::BodyModel;
use super::tool::ROUNDING;
use crate::number::short;

/// The largest residual at which an iteration for contacts counts as converged. If contacts on one triangle are nearly
/// equal a residual of a thousandth remains; forces and balances are valid to that accuracy.
const CONVERGED: f64 = 1e-2;

/// Depth, over the body's size, below which penetration at coupled contacts is not reported.
const LEFT_BY_ITERATION: f64 = 1e-6;

/// Sentences about tools of a body of this size (m), up to a state. A tool that cuts touches nothing.
pub(super) fn sentences(
    tools: &Tools,
    size: f64,
    state: &State,
    cuts: impl Fn(usize) -> bool,
) -> Vec<String> {
    let mut said = Vec::new();
    for (index, tool) in tools.tools().iter().enumerate() {
        let name = &tool.name;
        let ToolReport {
            depth,
            needed_passes,
            largest_residual,
            seized,
            rival,
            impulse,
            angular_impulse,
            ..
        } = tools.report(state, index);
        let unsaid = match tools.links(index) {
            true => LEFT_BY_ITERATION,
            false => ROUNDING,
        };
        if depth > unsaid * size {
            said.push(format!(
                "tool `{name}` left a node up to {} m in it: it is fixed in that direction, or lies between two surfaces of the tool",
                short(depth)
            ));
        }
        if needed_passes > 0.0 {
            said.push(format!(
                "tool `{name}` was so fast for its size that triangles may have got round it: a step would have needed {needed_passes} passes; take shorter steps"
            ));
        }
        if largest_residual > CONVERGED {
            said.push(format!(
                "the contacts of tool `{name}` are unconverged: the last sweep of a step still changed a displacement by {} of the largest",
                short(largest_residual)
            ));
        }
        if let Some(rival) = rival {
            said.push(format!(
                "tool `{name}` did not grasp a node because tool `{}` already holds it",
                tools.tools()[rival].name
            ));
        }
        let has_pushed = impulse
            .iter()
            .chain(&angular_impulse)
            .any(|part| *part != 0.0);
        if tool.grasp.is_none() && !cuts(index) && !has_pushed && depth == 0.0 {
            said.push(format!(
                "tool `{name}` pushed no node: it never met the body, or lay between its nodes"
            ));
        }
        if let Some(grasp) = tool.grasp
            && grasp.from <= state.t()
            && seized == 0
        {
            said.push(format!(
                "tool `{name}` grasped nothing from {} s to {} s: it pushed no node",
                short(grasp.from),
                short(grasp.to)
            ));
        }
    }
    let residual = tools.lips_report(state).largest_residual;
    if residual > CONVERGED {
        said.push(format!(
            "contact of the cut faces did not converge: the last sweep of a step still changed a displacement by {} of the largest",
            short(residual)
        ));
    }
    said
}

/// Share of a body's volume by which its cut faces may overlap without a warning.
const OVERLAP: f64 = 1e-6;

/// A sentence about the volume in which cut faces overlap in a state; `None` if it is negligible.
pub(super) fn of_lips(body: &BodyModel, state: &State) -> Option<String> {
    let cut = &body.cut.as_ref()?.cut;
    let mut places = vec![[0.0; 3]; cut.mesh.points.len()];
    body.model
        .displacements_at(state.t(), &state.u, &mut places)
        .ok()?;
    for (place, rest) in places.iter_mut().zip(&cut.mesh.points) {
        *place = [0, 1, 2].map(|axis| place[axis] + rest[axis]);
    }
    let overlap = cut.overlap_of_lips(&places);
    let whole: f64 = (0..cut.mesh.tets.len())
        .map(|tet| cut.mesh.volume(tet))
        .sum();
    (overlap > OVERLAP * whole).then(|| {
        format!(
            "faces of the cut overlap by {} m3 in the end, {} of the body's volume",
            short(overlap),
            short(overlap / whole)
        )
    })
}
