//! A plan as JSON.

use serde_json::{Map, Value, json};
use sinew_scene::{Simulation, Warning};

/// A plan as one JSON object: its sections as they are printed, its numbers, and its warnings with theirs.
pub(super) fn as_json(simulation: &Simulation) -> Value {
    let plan = simulation.plan();
    let sections = plan.sections.iter().map(|section| {
        let (heading, lines) = (section.heading, &section.lines);
        json!({ "heading": heading, "lines": lines })
    });
    json!({
        "title": plan.title,
        "sections": sections.collect::<Vec<_>>(),
        "dt_s": simulation.dt(),
        "steps": simulation.run().steps,
        "matrix_bytes": plan.matrix_bytes,
        "warnings": plan.warnings.iter().map(warning).collect::<Vec<_>>(),
    })
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
