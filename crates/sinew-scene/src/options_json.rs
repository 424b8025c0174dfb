//! Options of integrators as JSON.

use std::collections::BTreeMap;

use serde_json::{Number, Value};
use sinew_core::{OptionValue, Options};

/// Options as the entries of an object: numbers, strings, and objects for tables.
#[must_use]
pub fn options_json(options: &Options) -> BTreeMap<String, Value> {
    let entries = options.iter();
    entries
        .map(|(key, value)| (key.to_owned(), json(value)))
        .collect()
}

fn json(value: &OptionValue) -> Value {
    match value {
        OptionValue::Number(number) => Number::from_f64(*number).map_or(Value::Null, Value::Number),
        OptionValue::Text(text) => Value::String(text.clone()),
        OptionValue::Table(entries) => {
            let entries = entries.iter();
            Value::Object(
                entries
                    .map(|(key, value)| (key.clone(), json(value)))
                    .collect(),
            )
        }
    }
}
