//! The JSON schema of scenes, in draft 7, which editors of TOML read.

use std::ops::Bound;

use serde_json::{Map, Value, json};
use sinew_integrators::{OptionDefault, OptionHelp, OptionKind};

use super::examples;
use super::options::{self, SharedOption};
use super::sections::{self, is_refused};
use crate::decode::{
    Condition, Described, Goes, KeyDescription, Needs, Shape, Stated, TableDescription,
};
use crate::scene::{INTEGRATOR, RUN};

/// The schema of a document.
pub(super) fn of(document: &'static TableDescription) -> Value {
    let mut schema = table(document);
    let definitions = sections::below(document).into_iter().map(|section| {
        let description = section.table;
        let mut schema = table(description);
        if description.name == RUN.name {
            add_options(&mut schema, description);
        }
        (description.name.to_owned(), Value::Object(schema))
    });
    let definitions: Map<String, Value> = definitions.collect();
    schema.insert(
        "$schema".to_owned(),
        json!("http://json-schema.org/draft-07/schema#"),
    );
    schema.insert("title".to_owned(), json!("A scene of sinew"));
    schema.insert("definitions".to_owned(), Value::Object(definitions));
    Value::Object(schema)
}

/// The schema of a table.
fn table(table: &TableDescription) -> Map<String, Value> {
    let keys = table.all_keys().into_iter();
    let keys = keys.filter(|key| !is_refused(*key));
    let keys: Vec<KeyDescription> = keys.map(Described::describe).collect();
    let one_of = match table.needs {
        Needs::OneOf(keys) => keys,
        Needs::Any | Needs::Some => &[],
    };
    let properties: Map<String, Value> = keys
        .iter()
        .map(|key| (key.name.to_owned(), property(key, table)))
        .collect();
    let is_required =
        |key: &&KeyDescription| key.otherwise == Stated::Required && !one_of.contains(&key.name);
    let required: Vec<&str> = keys
        .iter()
        .filter(|key| is_required(key) && key.conditions.is_empty())
        .map(|key| key.name)
        .collect();
    let mut rules: Vec<Value> = Vec::new();
    for key in &keys {
        let conditions = key.conditions.iter().filter_map(holds);
        let mut conditions: Vec<Value> = conditions.collect();
        // Conditions with different reasons may have the same words.
        conditions.dedup();
        let refused = json!({ "properties": { key.name: false } });
        rules.extend(
            conditions
                .iter()
                .map(|holds| json!({ "if": holds, "else": refused })),
        );
        if let Stated::RequiredWith(other, words) = &key.otherwise {
            rules.push(json!({ "if": is(other, words), "then": { "required": [key.name] } }));
        }
        if is_required(&key) && !key.conditions.is_empty() {
            rules
                .push(json!({ "if": { "allOf": conditions }, "then": { "required": [key.name] } }));
        }
    }
    let mut schema = Map::new();
    let mut set = |key: &str, value: Value| schema.insert(key.to_owned(), value);
    set("type", json!("object"));
    set("description", json!(table.meaning));
    set("properties", Value::Object(properties));
    set("additionalProperties", json!(false));
    if !required.is_empty() {
        set("required", json!(required));
    }
    if let Needs::Some = table.needs {
        set("minProperties", json!(1));
    }
    if !one_of.is_empty() {
        let choices: Vec<Value> = one_of
            .iter()
            .map(|key| json!({ "required": [key] }))
            .collect();
        set("oneOf", json!(choices));
    }
    if !rules.is_empty() {
        set("allOf", json!(rules));
    }
    schema
}

/// The schema that a table meets if a condition is met; `None` if it never is.
fn holds(condition: &Condition) -> Option<Value> {
    match condition.goes {
        Goes::With(other) => Some(json!({ "required": [other] })),
        Goes::Without(other) => Some(json!({ "not": { "required": [other] } })),
        Goes::If(..) | Goes::Among(..) => condition
            .goes
            .words()
            .map(|(other, words)| is(other, words)),
        Goes::Never => None,
    }
}

/// The schema that a table meets whose key is one of these words.
fn is(key: &str, words: &[&str]) -> Value {
    match words {
        [word] => json!({ "properties": { key: { "const": word } }, "required": [key] }),
        _ => json!({ "properties": { key: { "enum": words } }, "required": [key] }),
    }
}

/// The schema of a key's value.
fn property(key: &KeyDescription, table: &TableDescription) -> Value {
    let mut schema = shape(&key.shape);
    let unit = match key.unit {
        "" => String::new(),
        unit => format!(" Unit: {unit}."),
    };
    let described = format!("{}{unit} Expected: {}.", key.meaning, key.expected);
    schema.insert("description".to_owned(), json!(described));
    if let Stated::Default(text) = &key.otherwise {
        schema.extend(json_of(text).map(|value| ("default".to_owned(), value)));
    }
    let example = examples::of(table, key.name).and_then(|text| json_of(&text));
    schema.extend(example.map(|value| ("examples".to_owned(), json!([value]))));
    Value::Object(schema)
}

/// A value in TOML as JSON.
fn json_of(text: &str) -> Option<Value> {
    let table: toml::Table = format!("value = {text}").parse().ok()?;
    serde_json::to_value(table.get("value")?).ok()
}

/// The schema of values.
fn shape(shape: &Shape) -> Map<String, Value> {
    let schema = match shape {
        Shape::Number(low, high) => return number(*low, *high),
        Shape::Whole(least, most) => {
            let mut schema = json!({ "type": "integer", "minimum": least });
            if let Some(most) = most {
                schema["maximum"] = json!(most);
            }
            schema
        }
        Shape::Flag => json!({ "type": "boolean" }),
        Shape::Text { pattern, except } => {
            let mut schema = json!({ "type": "string" });
            if let Some(pattern) = pattern {
                schema["pattern"] = json!(pattern);
            }
            if let Some(except) = except {
                schema["not"] = json!({ "const": except });
            }
            schema
        }
        Shape::Words(words) => json!({ "type": "string", "enum": words }),
        Shape::List { of, least, most } => {
            let mut schema =
                json!({ "type": "array", "items": self::shape(of), "minItems": least });
            if let Some(most) = most {
                schema["maxItems"] = json!(most);
            }
            schema
        }
        // Next to `$ref` nothing else counts in draft 7.
        Shape::Table(table) => json!({ "allOf": [reference(table)] }),
        Shape::Tables(table) => json!({ "type": "array", "items": reference(table) }),
        Shape::Either(shapes) => {
            let shapes: Vec<Value> = shapes.iter().map(|each| self::shape(each).into()).collect();
            json!({ "anyOf": shapes })
        }
    };
    match schema {
        Value::Object(schema) => schema,
        _ => Map::new(),
    }
}

fn reference(table: &TableDescription) -> Value {
    json!({ "$ref": format!("#/definitions/{}", table.name) })
}

fn number(low: Bound<f64>, high: Bound<f64>) -> Map<String, Value> {
    let low = match low {
        Bound::Included(low) => Some(("minimum", low)),
        Bound::Excluded(low) => Some(("exclusiveMinimum", low)),
        Bound::Unbounded => None,
    };
    let high = match high {
        Bound::Included(high) => Some(("maximum", high)),
        Bound::Excluded(high) => Some(("exclusiveMaximum", high)),
        Bound::Unbounded => None,
    };
    let bounds = [low, high].into_iter().flatten();
    let bounds = bounds.map(|(key, bound)| (key.to_owned(), json!(bound)));
    std::iter::once(("type".to_owned(), json!("number")))
        .chain(bounds)
        .collect()
}

/// Adds the integrators and their options to the schema of `[run]`: all of them as properties, so that editors know
/// them, and for each integrator those that it takes.
fn add_options(schema: &mut Map<String, Value>, run: &TableDescription) {
    let shared = options::shared();
    let Some(properties) = schema.get_mut("properties") else {
        return;
    };
    properties[INTEGRATOR.name]["enum"] = json!(sinew_integrators::ids());
    let mut described: Map<String, Value> = Map::new();
    for SharedOption {
        option,
        integrators,
    } in &shared
    {
        let line = format!("{}: {}.", integrators.join(", "), option.help);
        let words = match described.get(option.key) {
            Some(known) => format!(
                "{} {line}",
                known["description"].as_str().unwrap_or_default()
            ),
            None => format!("Option of {line}"),
        };
        described.insert(option.key.to_owned(), json!({ "description": words }));
    }
    if let Value::Object(properties) = properties {
        properties.extend(described);
    }
    let own: Vec<&str> = run.all_keys().iter().map(|key| key.name()).collect();
    let mut rules: Vec<Value> = Vec::new();
    for entry in sinew_integrators::entries() {
        let all = entry.all_options();
        let names: Vec<&str> = own
            .iter()
            .copied()
            .chain(all.iter().map(|o| o.key))
            .collect();
        let properties: Map<String, Value> = all
            .iter()
            .map(|option| (option.key.to_owned(), option_schema(option)))
            .collect();
        rules.push(json!({
            "if": { "properties": { INTEGRATOR.name: { "const": entry.id } }, "required": [INTEGRATOR.name] },
            "then": { "properties": properties, "propertyNames": { "enum": names } },
        }));
    }
    schema.insert("allOf".to_owned(), json!(rules));
}

/// The schema of an option.
fn option_schema(option: &OptionHelp) -> Value {
    let mut schema = kind(&option.kind);
    let described = format!("{}. Expected: {}.", option.help, option.expected);
    schema.insert("description".to_owned(), json!(described));
    if let OptionDefault::Value(text) = option.default {
        schema.extend(json_of(text).map(|value| ("default".to_owned(), value)));
    }
    Value::Object(schema)
}

fn kind(of: &OptionKind) -> Map<String, Value> {
    match options::shape(of) {
        Ok(known) => shape(&known),
        Err(keys) => {
            let first: Vec<&str> = keys.iter().take(1).map(|(key, _)| *key).collect();
            let properties = keys.iter().map(|(key, values)| {
                let values = Value::Object(kind(values));
                ((*key).to_owned(), values)
            });
            let properties: Map<String, Value> = properties.collect();
            [
                ("type", json!("object")),
                ("properties", Value::Object(properties)),
                ("required", json!(first)),
                ("additionalProperties", json!(false)),
            ]
            .map(|(key, value)| (key.to_owned(), value))
            .into_iter()
            .collect()
        }
    }
}
