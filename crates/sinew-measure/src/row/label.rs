//! Short names of runs.

use std::collections::BTreeMap;

use serde_json::Value;
use sinew_integrators::OptionLabel;

/// The integrator's id and its options, abbreviated as the method defines: `cnn Q=4`, `central-difference substeps=3`,
/// `cnn-stabilised chebyshev 4`.
pub(crate) fn label(integrator: &str, options: &BTreeMap<String, Value>) -> String {
    let entry = sinew_integrators::entry(integrator);
    let labelled = options.iter().map(|(key, value)| {
        let label = entry.as_ref().map(|entry| entry.option_label(key));
        (label.unwrap_or_default(), key, value)
    });
    // The kind of a method comes before its figures.
    let (kinds, others): (Vec<_>, Vec<_>) =
        labelled.partition(|(label, ..)| *label == OptionLabel::Value);
    let mut text = integrator.to_owned();
    for (label, key, value) in kinds.into_iter().chain(others) {
        text.push(' ');
        text.push_str(&option(label, key, value));
    }
    text
}

fn option(label: OptionLabel, key: &str, value: &Value) -> String {
    match label {
        OptionLabel::Value => plain(value),
        OptionLabel::Symbol(symbol) => format!("{symbol}={}", plain(value)),
        OptionLabel::Phrase(words) => {
            phrase(words, value).unwrap_or_else(|| option(OptionLabel::KeyAndValue, key, value))
        }
        OptionLabel::KeyAndValue => format!("{key}={}", plain(value)),
    }
}

/// The values of these keys of a table; none if the value is no table or lacks the first key.
fn phrase(keys: &[&str], value: &Value) -> Option<String> {
    let table = value.as_object()?;
    table.get(*keys.first()?)?;
    let values = keys.iter().filter_map(|key| table.get(*key));
    Some(values.map(plain).collect::<Vec<_>>().join(" "))
}

fn plain(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        // `Display` of f64 drops the ".0" that JSON prints.
        Value::Number(number) => number
            .as_f64()
            .map_or_else(|| number.to_string(), |x| x.to_string()),
        Value::Object(entries) => {
            let entries: Vec<String> = entries
                .iter()
                .map(|(key, value)| format!("{key}={}", plain(value)))
                .collect();
            format!("{{{}}}", entries.join(" "))
        }
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn of(integrator: &str, options: Value) -> String {
        let options = serde_json::from_value(options).unwrap();
        label(integrator, &options)
    }

    #[test]
    fn labels() {
        assert_eq!(of("rk4", json!({})), "rk4");
        assert_eq!(of("cnn", json!({ "saturation": 4.0 })), "cnn Q=4");
        assert_eq!(of("cnn", json!({ "saturation": 3.2 })), "cnn Q=3.2");
        assert_eq!(of("cnn", json!({ "saturation": "off" })), "cnn Q=off");
        assert_eq!(
            of("newmark", json!({ "gamma": 0.6, "beta": 0.3025 })),
            "newmark beta=0.3025 gamma=0.6"
        );
        assert_eq!(
            of("propagator", json!({ "degree": 8, "kind": "chebyshev" })),
            "propagator chebyshev degree=8"
        );
        assert_eq!(
            of(
                "cnn-stabilised",
                json!({ "inner": { "kind": "chebyshev", "sweeps": 4 } })
            ),
            "cnn-stabilised chebyshev 4"
        );
        assert_eq!(
            of("cnn-stabilised", json!({ "inner": { "kind": "block" } })),
            "cnn-stabilised block"
        );
    }

    #[test]
    fn an_unknown_shape_is_still_readable() {
        assert_eq!(
            of("x", json!({ "inner": { "a": 1 }, "flag": true })),
            "x flag=true inner={a=1}"
        );
    }
}
