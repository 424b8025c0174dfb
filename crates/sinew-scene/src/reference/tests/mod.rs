//! Comparison of the reference and the schema with the behaviour of the decoder.

mod misfits;
mod options;
mod spots;
mod validator;

use std::collections::BTreeSet;
use std::fs;
use std::ops::Bound;
use std::path::{Path, PathBuf};

use serde_json::Value as Json;
use toml::{Table, Value};

use super::sections::{self, tables_in};
use super::{examples, scene_schema, schema};
use crate::decode::{KeyDescription, Needs, Shape, Stated, TableDescription};
use crate::keys::AT_THE_TOP;
use crate::scene::DOCUMENT;
use crate::{OutputSettings, RunSettings, Scene, SceneSource, Subject};
use spots::Spot;

/// Everything that is decoded of a scene, or the error.
fn decoded(scene: &Table) -> Result<(String, Subject, RunSettings, OutputSettings), String> {
    let text = toml::to_string(scene).unwrap();
    let scene = Scene::parse(SceneSource::new("scene.toml", text)).map_err(|e| e.to_string())?;
    Ok((
        scene.title().to_owned(),
        scene.subject().clone(),
        scene.settings().clone(),
        *scene.output(),
    ))
}

/// The schema, made once for a test.
struct Schema(Json);

impl Schema {
    fn new() -> Self {
        Self(schema::of(&DOCUMENT))
    }

    fn takes(&self, scene: &Table) -> bool {
        let scene = serde_json::to_value(scene).unwrap();
        validator::meets(&self.0, &self.0, &scene)
    }

    /// Checks that decoder and schema refuse a scene, the decoder with a message that names the key.
    #[track_caller]
    fn assert_refused(&self, scene: &Table, key: &str) {
        let text = toml::to_string(scene).unwrap();
        let message = decoded(scene).err();
        let message = message.unwrap_or_else(|| panic!("{key} is not refused in\n{text}"));
        assert!(message.contains(key), "{key}: {message}");
        assert!(!self.takes(scene), "the schema takes {key} in\n{text}");
    }
}

#[test]
fn every_example_is_a_scene_for_decoder_and_schema() {
    let schema = Schema::new();
    let spots = spots::all();
    assert!(spots.len() > 60);
    for spot in &spots {
        let text = toml::to_string(&spot.scene).unwrap();
        decoded(&spot.scene).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert!(schema.takes(&spot.scene), "the schema refuses\n{text}");
    }
    let shown: BTreeSet<&str> = spots.iter().map(|spot| spot.table.name).collect();
    for section in sections::below(&DOCUMENT) {
        assert!(shown.contains(section.table.name), "{}", section.table.name);
    }
}

#[test]
fn every_key_has_a_sentence_and_an_example() {
    for spot in spots::all() {
        for key in spot
            .keys()
            .filter(|key| !key.conditions.iter().any(is_never))
        {
            let of = format!("{} of {}", key.name, spot.table.name);
            assert!(key.meaning.ends_with('.'), "{of}: {}", key.meaning);
            let is_table = !tables_in(&key.shape).is_empty() && spot.path.is_empty();
            assert!(
                is_table || examples::of(spot.table, key.name).is_some(),
                "{of}"
            );
            assert!(key.expected.contains(key.unit), "{of}: {}", key.expected);
        }
    }
}

fn is_never(condition: &crate::decode::Condition) -> bool {
    matches!(condition.goes, crate::decode::Goes::Never)
}

#[test]
fn a_default_is_what_the_decoder_takes_in_its_place() {
    let mut compared = BTreeSet::new();
    let mut stated = BTreeSet::new();
    for spot in spots::all() {
        for key in spot.keys() {
            let Stated::Default(default) = &key.otherwise else {
                continue;
            };
            stated.insert((spot.table.name, key.name));
            let explicit = spot.with(key.name, spots::value(default));
            // With the default, others that are given may have no place.
            let given = |key: &KeyDescription| explicit.entries().contains_key(key.name);
            if explicit.keys().filter(given).all(|key| explicit.lets(&key)) {
                let absent = explicit.without(key.name);
                assert_eq!(
                    decoded(&explicit.scene),
                    decoded(&absent.scene),
                    "{}",
                    key.name
                );
                assert!(decoded(&absent.scene).is_ok());
                compared.insert((spot.table.name, key.name));
            }
        }
    }
    assert_eq!(compared, stated);
    assert!(compared.len() > 10);
}

#[test]
fn a_value_outside_the_range_is_refused_by_decoder_and_schema() {
    let schema = Schema::new();
    let mut tried = BTreeSet::new();
    for spot in spots::all() {
        for key in spot.keys() {
            if spot.entries().contains_key(key.name) {
                for misfit in misfits::of(&key.shape) {
                    let wrong = spot.with(key.name, misfit);
                    schema.assert_refused(&wrong.scene, key.name);
                }
                tried.insert((spot.table.name, key.name));
            }
        }
    }
    assert!(tried.len() > 60, "{tried:?}");
}

#[test]
fn bounds_are_those_that_messages_name() {
    let mut seen = BTreeSet::new();
    for key in spots::all().iter().flat_map(Spot::keys) {
        let Shape::Number(low, high) = key.shape else {
            continue;
        };
        let words = match low {
            Bound::Unbounded => vec![String::new()],
            Bound::Excluded(low) => vec![format!("above {low}")],
            Bound::Included(low) => vec![
                format!("from {low}"),
                format!("from {low:e} "),
                format!(", {low}"),
            ],
        };
        let says = |words: &[String]| words.iter().any(|words| key.expected.contains(words));
        assert!(says(&words), "{}: {}, {low:?}", key.name, key.expected);
        let words = match high {
            Bound::Unbounded => vec![String::new()],
            Bound::Excluded(high) => vec![format!("below {high}")],
            Bound::Included(high) => vec![
                format!("to {high}"),
                format!("to {high:e}"),
                format!("to 1/{}", high.recip()),
            ],
        };
        assert!(says(&words), "{}: {}, {high:?}", key.name, key.expected);
        if low == Bound::Unbounded {
            let says_bound = ["above", "below", "from"];
            let says_bound = says_bound.iter().any(|word| key.expected.contains(word));
            assert!(!says_bound, "{}: {}", key.name, key.expected);
        }
        seen.insert(key.name);
    }
    assert!(seen.len() > 20);
}

#[test]
fn what_is_required_is_asked_for_by_decoder_and_schema() {
    let schema = Schema::new();
    for spot in spots::all() {
        for key in spot.keys() {
            let is_given = spot.entries().contains_key(key.name);
            if is_given && key.otherwise == Stated::Required {
                schema.assert_refused(&spot.without(key.name).scene, key.name);
            }
        }
        let is_empty = !matches!(spot.table.needs, Needs::Any);
        if let (true, Some((last, outer))) = (is_empty, spot.path.split_last()) {
            let around = Spot {
                path: outer.to_vec(),
                ..spot.clone()
            };
            if spot.path.len() > 1 {
                let emptied = around.with(last, Value::Table(Table::new()));
                assert!(decoded(&emptied.scene).is_err() && !schema.takes(&emptied.scene));
            }
        }
    }
}

#[test]
fn keys_that_do_not_go_together_are_refused_by_decoder_and_schema() {
    let schema = Schema::new();
    let mut tried = BTreeSet::new();
    for spot in spots::all() {
        for key in spot.keys() {
            let is_given = spot.entries().contains_key(key.name);
            let is_second =
                matches!(spot.table.needs, Needs::OneOf(keys) if keys.contains(&key.name));
            if is_given || (spot.lets(&key) && !is_second) {
                continue;
            }
            let example = examples::of(spot.table, key.name);
            let example =
                example.unwrap_or_else(|| "{ normal = [0, 0, 1], angle = 20 }".to_owned());
            if !spot.path.is_empty() {
                let wrong = spot.with(key.name, spots::value(&example));
                schema.assert_refused(&wrong.scene, "");
                tried.insert((spot.table.name, key.name));
            }
        }
    }
    for key in [
        "group",
        "poissons_ratio",
        "springs",
        "ramp",
        "times",
        "origin",
        "order",
        "point",
        "face",
    ] {
        assert!(tried.iter().any(|(_, tried)| *tried == key), "{key}");
    }
    let oscillator = spots::all()
        .into_iter()
        .find(|spot| spot.table.name == "oscillator");
    let document = Spot {
        path: Vec::new(),
        table: &DOCUMENT,
        ..oscillator.unwrap()
    };
    for key in document.keys().filter(|key| !key.conditions.is_empty()) {
        let value = match &key.shape {
            Shape::Tables(table) => table.examples[0].parse::<Table>().unwrap()[key.name].clone(),
            Shape::Table(table) => table.examples[0].parse::<Table>().unwrap()[key.name].clone(),
            _ => spots::value(&examples::of(&DOCUMENT, key.name).unwrap()),
        };
        schema.assert_refused(&document.with(key.name, value).scene, key.name);
    }
}

#[test]
fn unknown_keys_are_refused_by_decoder_and_schema_in_every_table() {
    let schema = Schema::new();
    for spot in spots::all() {
        let wrong = spot.with("no-such-key", 1.into());
        schema.assert_refused(&wrong.scene, "no-such-key");
    }
}

#[test]
fn no_two_tables_share_a_name_in_the_schema() {
    let mut known: Vec<&'static TableDescription> = Vec::new();
    let mut next = vec![&DOCUMENT];
    while let Some(table) = next.pop() {
        let same = known.iter().find(|other| other.name == table.name);
        if let Some(same) = same {
            let names = |table: &TableDescription| format!("{:?} {}", table.keys, table.meaning);
            assert_eq!(names(same), names(table));
            continue;
        }
        known.push(table);
        let inner = table
            .keys
            .iter()
            .flat_map(|key| tables_in(&key.describe().shape));
        next.extend(inner.map(|(table, _)| table));
    }
}

#[test]
fn the_keys_at_the_top_are_those_of_a_scene_that_are_no_tables() {
    let is_value = |shape: &Shape| !matches!(shape, Shape::Table(_) | Shape::Tables(_));
    let keys = DOCUMENT.keys.iter().map(|key| key.describe());
    let values: Vec<&str> = keys
        .filter(|key| is_value(&key.shape))
        .map(|key| key.name)
        .collect();
    assert_eq!(values, AT_THE_TOP);
}

fn scenes(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            scenes(&path, found);
        } else if path.extension().is_some_and(|end| end == "toml") {
            found.push(path);
        }
    }
}

#[test]
fn the_schema_takes_every_scene_of_the_project() {
    let mut found = Vec::new();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    scenes(&folder, &mut found);
    assert!(found.len() > 20);
    let schema = Schema(scene_schema().parse().unwrap());
    for path in found {
        let scene: Table = fs::read_to_string(&path).unwrap().parse().unwrap();
        assert!(schema.takes(&scene), "{}", path.display());
    }
}
