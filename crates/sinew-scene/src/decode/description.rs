//! Tables and keys as data, from which the reference and the schema are written.

use std::ops::Bound;

use super::condition::Condition;

/// The description of a table.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TableDescription {
    /// Its name among the definitions of the schema.
    pub(crate) name: &'static str,
    /// Its purpose, in sentences.
    pub(crate) meaning: &'static str,
    /// Its keys, in the order in which messages list them.
    pub(crate) keys: &'static [&'static dyn Described],
    /// The number of its keys that must be given, in addition to the required ones.
    pub(crate) needs: Needs,
    /// Tables as a user writes them, in which every key occurs at least once.
    pub(crate) examples: &'static [&'static str],
}

impl TableDescription {
    /// The keys, with those that replace another ([`Described::parts`]).
    pub(crate) fn all_keys(&self) -> Vec<&'static dyn Described> {
        let keys = self.keys.iter();
        let keys = keys.flat_map(|key| key.parts().map_or_else(|| vec![*key], |parts| parts.keys));
        keys.collect()
    }

    /// The examples, with those of keys that replace another.
    pub(crate) fn all_examples(&self) -> Vec<&'static str> {
        let parts = self.keys.iter().filter_map(|key| key.parts());
        let more = parts.flat_map(|parts| parts.examples);
        self.examples.iter().copied().chain(more).collect()
    }
}

/// Keys that are known at run time only, which replace one key.
#[derive(Debug)]
pub(crate) struct Parts {
    /// The keys.
    pub(crate) keys: Vec<&'static dyn Described>,
    /// Examples of the whole table that give them.
    pub(crate) examples: Vec<&'static str>,
}

/// The number of keys that must be given in a table.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Needs {
    /// Any number.
    Any,
    /// At least one.
    Some,
    /// Exactly one of these, and any of the others.
    OneOf(&'static [&'static str]),
}

/// A key that describes itself.
pub(crate) trait Described: Sync {
    /// Its name.
    fn name(&self) -> &'static str;

    /// The conditions under which it may be given.
    fn conditions(&self) -> &'static [Condition];

    /// Its whole description.
    fn describe(&self) -> KeyDescription;

    /// The keys that replace it; `None` for an ordinary key.
    fn parts(&self) -> Option<Parts> {
        None
    }
}

impl std::fmt::Debug for dyn Described {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// The description of a key.
#[derive(Debug, Clone)]
pub(crate) struct KeyDescription {
    /// Its name.
    pub(crate) name: &'static str,
    /// Its meaning, in sentences.
    pub(crate) meaning: String,
    /// Its unit; empty if it has none.
    pub(crate) unit: &'static str,
    /// Description of the values that fit.
    pub(crate) expected: String,
    /// The values that fit, as data.
    pub(crate) shape: Shape,
    /// Behaviour if it is not given.
    pub(crate) otherwise: Stated,
    /// The conditions under which it may be given; a required key must be given if they are met.
    pub(crate) conditions: &'static [Condition],
}

/// Behaviour if a key is not given.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Stated {
    /// It must be given.
    Required,
    /// It must be given if another key is one of these words.
    RequiredWith(&'static str, Vec<&'static str>),
    /// The behaviour, as a description.
    InWords(&'static str),
    /// This value, in TOML.
    Default(String),
}

/// The values that a key takes, each checked without other keys.
#[derive(Debug, Clone)]
pub(crate) enum Shape {
    /// A finite number between two bounds.
    Number(Bound<f64>, Bound<f64>),
    /// A whole number from the first to the second.
    Whole(u64, Option<u64>),
    /// true or false.
    Flag,
    /// A string.
    Text {
        /// A regular expression for it.
        pattern: Option<&'static str>,
        /// The one string that does not fit.
        except: Option<&'static str>,
    },
    /// One of these strings.
    Words(Vec<&'static str>),
    /// A list.
    List {
        /// Each item.
        of: Box<Shape>,
        /// The least number of items.
        least: usize,
        /// The largest number of items.
        most: Option<usize>,
    },
    /// A table.
    Table(&'static TableDescription),
    /// A list of tables.
    Tables(&'static TableDescription),
    /// One of several.
    Either(Vec<Shape>),
}
