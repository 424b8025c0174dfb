//! Predicted cost of a scene, as JSON.

use serde_json::{Value, json};

use super::cost::Cost;

/// Memory, files and time; unknown values are left out, with the reason.
pub(super) fn as_json(cost: &Cost) -> Value {
    let mut object = json!({});
    let Some(fields) = object.as_object_mut() else {
        return object;
    };
    if let Some(footprint) = cost.footprint {
        let memory = json!({
            "nodes": footprint.nodes,
            "tetrahedra": footprint.tets,
            "blocks": footprint.blocks,
            "matrix_bytes": footprint.matrix_bytes,
            "bytes": footprint.bytes,
        });
        fields.insert("memory".to_owned(), memory);
    }
    if let Some(bytes) = cost.factor {
        fields.insert("factor_bytes".to_owned(), json!(bytes));
    }
    let folder = json!({
        "frames": cost.folder.frames,
        "frame_bytes": cost.folder.frame_bytes,
        "field_bytes": cost.folder.field_bytes(),
        "compressed": cost.folder.is_compressed,
        "table_bytes": cost.folder.table_bytes,
    });
    fields.insert("files_of_run_out".to_owned(), folder);
    let (name, value) = match &cost.forecast {
        Ok(forecast) => (
            "time",
            json!({
                "steps": forecast.steps,
                "sweeps": forecast.sweeps(),
                "sweeps_per_step": forecast.sweeps_per_step,
                "solves_per_step": forecast.solves_per_step,
                "setup_s": forecast.setup_s,
                "step_s": forecast.step_s,
                "cpu_s_per_s": forecast.cpu_s_per_s(),
                "run_s": forecast.run_s(),
                "steps_seen": forecast.seen,
            }),
        ),
        Err(reason) => ("time_unknown", json!(reason)),
    };
    fields.insert(name.to_owned(), value);
    object
}
