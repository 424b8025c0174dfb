//! Errors in space and time as JSON.

use serde_json::{Value, json};
use sinew_measure::convergence::{
    Caveat, Convergence, LevelPrediction, Prediction, Quantity, TimeCheck, When,
};

use super::words::{subject, unit};

pub(super) fn object(prediction: &Prediction, found: &Convergence) -> Value {
    let levels = found.levels.iter().map(|level| {
        json!({
            "nodes": level.nodes,
            "tetrahedra": level.tets,
            "free_dofs": level.dofs,
            "dt_s": level.dt,
            "steps": level.steps,
            "sweeps": level.work.sweeps,
            "solves": level.work.solves,
            "reference_sweeps": level.reference_sweeps,
            "diverged_at_s": level.diverged_at,
        })
    });
    json!({
        "predicted": predicted(prediction),
        "errors_in_time_by": match found.time_check {
            TimeCheck::Reference => "reference",
            TimeCheck::HalfStep => "half-step",
        },
        "meshes": levels.collect::<Vec<_>>(),
        "quantities": found.quantities.iter().map(quantity).collect::<Vec<_>>(),
        "caveats": found.caveats.iter().map(caveat).collect::<Vec<_>>(),
    })
}

fn predicted(prediction: &Prediction) -> Value {
    let level = |level: &LevelPrediction| {
        json!({
            "nodes": level.nodes,
            "tetrahedra": level.tets,
            "free_dofs": level.dofs,
            "blocks": level.blocks,
            "steps": level.steps,
            "sweeps": level.sweeps,
            "bytes": level.bytes,
        })
    };
    json!({
        "seconds": prediction.seconds,
        "meshes": prediction.levels.iter().map(level).collect::<Vec<_>>(),
    })
}

fn quantity(quantity: &Quantity) -> Value {
    let estimate = &quantity.estimate;
    json!({
        "quantity": subject(quantity),
        "when": match quantity.when {
            When::Run => "run",
            When::Rest => "rest",
        },
        "size": quantity.size,
        "unit": unit(&quantity.subject),
        "errors_in_time": quantity.errors_in_time,
        "left_in_time": quantity.left_in_time,
        "differences": estimate.differences,
        "observed_order": estimate.observed_order,
        "order": estimate.order,
        "error_in_space": estimate.error,
        "error_in_space_of_finest": estimate.error_of_finest,
    })
}

fn caveat(caveat: &Caveat) -> Value {
    json!({ "kind": caveat.id(), "what": caveat.to_string() })
}
