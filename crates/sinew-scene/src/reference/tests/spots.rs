//! Whole scenes around the examples of the reference.

use toml::{Table, Value};

use crate::decode::{Described, Goes, KeyDescription, TableDescription};
use crate::reference::examples;
use crate::reference::sections::tables_in;
use crate::scene::DOCUMENT;

/// An example of a table, in a whole scene.
#[derive(Debug, Clone)]
pub(super) struct Spot {
    pub(super) scene: Table,
    /// The keys that lead to the table; of a list of tables it is the first.
    pub(super) path: Vec<&'static str>,
    pub(super) table: &'static TableDescription,
}

impl Spot {
    /// The table itself.
    pub(super) fn entries(&self) -> &Table {
        self.path
            .iter()
            .fold(&self.scene, |table, key| match &table[*key] {
                Value::Array(tables) => tables[0].as_table().unwrap(),
                value => value.as_table().unwrap(),
            })
    }

    fn entries_mut(&mut self) -> &mut Table {
        self.path.iter().fold(&mut self.scene, |table, key| {
            match table.get_mut(*key).unwrap() {
                Value::Array(tables) => tables[0].as_table_mut().unwrap(),
                value => value.as_table_mut().unwrap(),
            }
        })
    }

    /// The scene with another value of a key.
    pub(super) fn with(&self, key: &str, value: Value) -> Self {
        let mut changed = self.clone();
        changed.entries_mut().insert(key.to_owned(), value);
        changed
    }

    /// The scene without a key.
    pub(super) fn without(&self, key: &str) -> Self {
        let mut changed = self.clone();
        changed.entries_mut().remove(key).unwrap();
        changed
    }

    /// The descriptions of the table's keys.
    pub(super) fn keys(&self) -> impl Iterator<Item = KeyDescription> + use<> {
        self.table.all_keys().into_iter().map(Described::describe)
    }

    /// True if a key's conditions are met by the other keys that are given.
    pub(super) fn lets(&self, key: &KeyDescription) -> bool {
        let entries = self.entries();
        key.conditions.iter().all(|condition| match condition.goes {
            Goes::With(other) => entries.contains_key(other),
            Goes::Without(other) => !entries.contains_key(other),
            Goes::If(..) | Goes::Among(..) => {
                let (other, words) = condition.goes.words().unwrap();
                let word = entries.get(other).and_then(Value::as_str);
                word.is_some_and(|word| words.contains(&word))
            }
            Goes::Never => false,
        })
    }
}

/// The value of an example of a key.
pub(super) fn value(text: &str) -> Value {
    let table: Table = format!("value = {text}").parse().unwrap();
    table["value"].clone()
}

/// Every example of every table, each in a whole scene.
pub(super) fn all() -> Vec<Spot> {
    let mut spots = vec![Spot {
        scene: body(),
        path: Vec::new(),
        table: &DOCUMENT,
    }];
    for key in DOCUMENT.keys {
        for (table, _) in tables_in(&key.describe().shape) {
            for example in table.all_examples() {
                let own: Table = example.parse().unwrap();
                let mut scene = body();
                if own.contains_key("oscillator") {
                    scene.retain(|key, _| key == "title" || key == "run");
                }
                scene.extend(own);
                let path = vec![key.name()];
                push_with_inner(&mut spots, Spot { scene, path, table });
            }
        }
    }
    spots
}

/// The first examples of the keys that every body has.
fn body() -> Table {
    let first = |table: &TableDescription| table.examples[0].parse::<Table>().unwrap();
    let mut body = first(&DOCUMENT);
    for key in DOCUMENT.keys {
        for (table, _) in tables_in(&key.describe().shape) {
            if ["mesh", "region", "run"].contains(&table.name) {
                body.extend(first(table));
            }
        }
    }
    body
}

/// Adds a scene, and for each inner table of it scenes with all examples of that.
fn push_with_inner(spots: &mut Vec<Spot>, spot: Spot) {
    for key in spot.keys() {
        let is_table = spot.entries().get(key.name).is_some_and(Value::is_table);
        for (table, _) in tables_in(&key.shape).into_iter().filter(|_| is_table) {
            for example in table.all_examples() {
                let example: Table = examples::toml(example).parse().unwrap();
                let mut inner = spot.with(key.name, example["table"].clone());
                inner.path.push(key.name);
                inner.table = table;
                push_with_inner(spots, inner);
            }
        }
    }
    spots.push(spot);
}
