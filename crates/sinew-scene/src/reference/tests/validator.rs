//! A validator of JSON schemas (draft 7), limited to the features that the schema of scenes uses.

use regex_lite::Regex;
use serde_json::{Map, Value};

/// True if a value meets a schema; `root` has the definitions.
pub(super) fn meets(root: &Value, schema: &Value, value: &Value) -> bool {
    let rules = match schema {
        Value::Bool(always) => return *always,
        Value::Object(rules) => rules,
        other => panic!("no schema: {other}"),
    };
    if let Some(reference) = rules.get("$ref") {
        let path = reference.as_str().unwrap().trim_start_matches('#');
        return meets(root, root.pointer(path).unwrap(), value);
    }
    rules
        .iter()
        .all(|(keyword, rule)| keeps(root, rules, (keyword, rule), value))
}

fn keeps(
    root: &Value,
    rules: &Map<String, Value>,
    (keyword, rule): (&str, &Value),
    value: &Value,
) -> bool {
    let all_of = |rule: &Value| {
        rule.as_array()
            .unwrap()
            .iter()
            .map(|s| meets(root, s, value))
            .collect::<Vec<_>>()
    };
    let bound = |keeps: fn(f64, f64) -> bool| {
        value
            .as_f64()
            .is_none_or(|v| keeps(v, rule.as_f64().unwrap()))
    };
    let size = rule.as_u64().unwrap_or_default() as usize;
    let items = value.as_array();
    let entries = value.as_object();
    let text = value.as_str();
    match keyword {
        "$schema" | "title" | "description" | "definitions" | "default" | "examples" | "then"
        | "else" => true,
        "type" => match rule.as_str().unwrap() {
            "object" => value.is_object(),
            "array" => value.is_array(),
            "string" => value.is_string(),
            "boolean" => value.is_boolean(),
            "number" => value.is_number(),
            "integer" => value.is_i64() || value.is_u64(),
            other => panic!("no type: {other}"),
        },
        "enum" => rule.as_array().unwrap().contains(value),
        "const" => rule == value,
        "minimum" => bound(|value, bound| value >= bound),
        "maximum" => bound(|value, bound| value <= bound),
        "exclusiveMinimum" => bound(|value, bound| value > bound),
        "exclusiveMaximum" => bound(|value, bound| value < bound),
        "pattern" => {
            text.is_none_or(|text| Regex::new(rule.as_str().unwrap()).unwrap().is_match(text))
        }
        "items" => items.is_none_or(|items| items.iter().all(|item| meets(root, rule, item))),
        "minItems" => items.is_none_or(|items| items.len() >= size),
        "maxItems" => items.is_none_or(|items| items.len() <= size),
        "minProperties" => entries.is_none_or(|entries| entries.len() >= size),
        "required" => entries.is_none_or(|entries| {
            rule.as_array()
                .unwrap()
                .iter()
                .all(|key| entries.contains_key(key.as_str().unwrap()))
        }),
        "properties" => entries.is_none_or(|entries| {
            let properties = rule.as_object().unwrap();
            properties.iter().all(|(key, schema)| {
                entries
                    .get(key)
                    .is_none_or(|value| meets(root, schema, value))
            })
        }),
        "additionalProperties" => entries.is_none_or(|entries| {
            let known = rules["properties"].as_object().unwrap();
            rule == &Value::Bool(false) && entries.keys().all(|key| known.contains_key(key))
        }),
        "propertyNames" => entries.is_none_or(|entries| {
            entries
                .keys()
                .all(|key| meets(root, rule, &Value::String(key.clone())))
        }),
        "allOf" => all_of(rule).into_iter().all(|meets| meets),
        "anyOf" => all_of(rule).into_iter().any(|meets| meets),
        "oneOf" => all_of(rule).into_iter().filter(|meets| *meets).count() == 1,
        "not" => !meets(root, rule, value),
        "if" => {
            let branch = if meets(root, rule, value) {
                "then"
            } else {
                "else"
            };
            rules
                .get(branch)
                .is_none_or(|schema| meets(root, schema, value))
        }
        other => panic!("unknown keyword: {other}"),
    }
}
