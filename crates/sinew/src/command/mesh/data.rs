//! Data of a mesh as text and as JSON.

use serde_json::{Value, json};
use sinew_mesh::info::DataInfo;

/// A line for each of the data.
pub(super) fn lines(data: &[DataInfo]) -> impl Iterator<Item = String> {
    data.iter().map(|data| {
        let width = match data.components {
            1 => String::new(),
            components => format!(", {components} numbers each"),
        };
        let step = match data.step {
            0 => String::new(),
            step => format!(", time step {step}"),
        };
        format!(
            "data     `{}` ({}{width}{step}): {}",
            data.name, data.of, data.range
        )
    })
}

/// The data as the summary of a mesh lists them.
pub(super) fn as_json(data: &[DataInfo]) -> Value {
    let finite = |x: f64| x.is_finite().then_some(x);
    let data = data.iter().map(|data| {
        json!({
            "of": data.of,
            "name": data.name,
            "step": data.step,
            "components": data.components,
            "least": finite(data.range.least),
            "greatest": finite(data.range.greatest),
            "is_whole": data.range.is_whole,
            "different": data.range.different,
            "missing": data.range.missing,
        })
    });
    data.collect()
}
