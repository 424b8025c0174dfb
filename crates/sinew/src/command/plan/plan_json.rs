//! A plan as JSON.

use serde_json::{Map, Value, json};
use sinew_core::StableStep;
use sinew_scene::{Plan, Simulation, Warning};

use super::cost::Cost;
use super::cost_json;

/// A plan as one JSON object: its printed sections, its numbers, and its warnings with their numbers. Absent numbers
/// are left out.
pub(super) fn as_json(simulation: &Simulation, plan: &Plan, cost: &Cost) -> Value {
    let sections = plan.sections.iter().map(|section| {
        let (heading, lines) = (section.heading, &section.lines);
        json!({ "heading": heading, "lines": lines })
    });
    let body = simulation.model().body().map(|body| {
        let report = body.model.report();
        json!({
            "nodes": report.nodes,
            "tetrahedra": report.tets,
            "edges": report.edges,
            "volume_m3": report.volume,
            "mass_kg": report.mass,
        })
    });
    let mut object = json!({
        "title": plan.title,
        "integrator": simulation.settings().integrator,
        "duration_s": simulation.settings().duration,
        "free_dofs": simulation.system().dofs(),
        "sections": sections.collect::<Vec<_>>(),
        "dt_s": simulation.dt(),
        "steps": simulation.run().steps,
        "matrix_bytes": plan.matrix_bytes,
        "warnings": plan.warnings.iter().map(warning).collect::<Vec<_>>(),
        "cost": cost_json::as_json(cost),
        "stable_step_s": match plan.stable_step {
            StableStep::Any => json!("any"),
            StableStep::UpTo(limit) => json!(limit),
            StableStep::Unknown => json!("unknown"),
        },
    });
    if let Some(object) = object.as_object_mut() {
        object.extend(body.map(|body| ("body".to_owned(), body)));
        let step = plan.critical_step;
        object.extend(
            step.is_finite()
                .then(|| ("critical_step_s".to_owned(), json!(step))),
        );
    }
    object
}

fn warning(warning: &Warning) -> Value {
    let numbers = warning.numbers.iter();
    let numbers = numbers.map(|(name, value)| ((*name).to_owned(), json!(value)));
    json!({
        "kind": warning.kind.id(),
        "what": warning.what,
        "mend": warning.mend,
        "numbers": numbers.collect::<Map<String, Value>>(),
    })
}
