//! One table of a scene and the values of its keys.

use std::ops::Range;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::condition::{Condition, Goes};
use super::description::{Described, Needs, Shape, TableDescription};
use super::key::Key;
use super::place::{KeyPlace, Place};
use super::presence::Presence;
use super::value::{Misfit, WITHIN, kind};
use super::values::{Inner, Kind, Values};
use crate::error::{Fault, SceneError, shortened};
use crate::formula::Formula;
use crate::nearest::nearest;
use crate::source::SceneSource;

/// A table whose keys were checked against its description. Its methods read the values.
pub(crate) struct Table<'a> {
    scene: &'a Arc<SceneSource>,
    entries: &'a DeTable<'a>,
    description: &'static TableDescription,
    place: Place,
}

impl<'a> Table<'a> {
    /// The whole document; a key that is not described is an error.
    pub(crate) fn document(
        scene: &'a Arc<SceneSource>,
        entries: &'a DeTable<'a>,
        description: &'static TableDescription,
    ) -> Result<Self, SceneError> {
        Self::new(scene, String::new(), None, entries, description).closed()
    }

    fn new(
        scene: &'a Arc<SceneSource>,
        name: String,
        header: Option<Range<usize>>,
        entries: &'a DeTable<'a>,
        description: &'static TableDescription,
    ) -> Self {
        let places = entries.iter().map(|(key, value)| {
            let place = KeyPlace {
                key: key.span(),
                value: value.span(),
            };
            (key.get_ref().clone().into_owned(), place)
        });
        Self {
            scene,
            entries,
            description,
            place: Place::new(scene, name, header, places.collect()),
        }
    }

    fn closed(self) -> Result<Self, SceneError> {
        match self.others().min_by_key(|(key, _)| key.span().start) {
            None => Ok(self),
            Some((key, _)) => Err(self.unknown(key)),
        }
    }

    /// The error for a key that is unknown here.
    pub(crate) fn unknown(&self, key: &Spanned<DeString<'_>>) -> SceneError {
        let known = self.description.all_keys();
        let nearest = nearest(key.get_ref(), known.iter().map(|key| key.name()));
        let fault = Fault::UnknownKey {
            key: key.get_ref().clone().into_owned(),
            nearest,
            known: known
                .into_iter()
                .filter(|key| self.may_be_given(*key))
                .map(Described::name)
                .collect(),
        };
        self.place.key_fault(key.get_ref(), fault)
    }

    /// The names of the keys that are described.
    fn known(&self) -> impl Iterator<Item = &'static str> + use<> {
        let keys = self.description.all_keys();
        keys.into_iter().map(Described::name)
    }

    /// The entries whose keys are not described.
    pub(crate) fn others(
        &self,
    ) -> impl Iterator<Item = (&'a Spanned<DeString<'a>>, &'a Spanned<DeValue<'a>>)> {
        let known: Vec<&'static str> = self.known().collect();
        self.entries
            .iter()
            .filter(move |(key, _)| !known.contains(&key.get_ref().as_ref()))
    }

    /// The table's place in the text.
    pub(crate) fn place(&self) -> &Place {
        &self.place
    }

    /// Turns the table into its place in the text.
    pub(crate) fn into_place(self) -> Place {
        self.place
    }

    pub(crate) fn has(&self, key: &str) -> bool {
        self.entries.contains_key(key)
    }

    /// The value of a key, or the one for its absence.
    pub(crate) fn read<V: Values, P: Presence<V::Read>>(
        &self,
        key: &Key<V, P>,
    ) -> Result<P::Read, SceneError> {
        let expected = || key.values.expected();
        let given = match self.given(key.name) {
            None => None,
            Some(value) => {
                let read = key.values.read(value.get_ref());
                Some(read.map_err(|misfit| self.misfit(key.name, value, expected(), misfit))?)
            }
        };
        key.presence
            .settle(given, || self.missing(key.name, expected()))
    }

    /// The table of a key, or the one for its absence.
    pub(crate) fn table<P: Presence<Table<'a>>>(
        &self,
        key: &Key<Inner, P>,
    ) -> Result<P::Read, SceneError> {
        let open = self.inner(key.name, key.values.table)?;
        let table = open.map(Table::closed).transpose()?;
        key.presence
            .settle(table, || self.missing(key.name, key.values.expected()))
    }

    /// The table of a key, which may have keys that are not described.
    pub(crate) fn open_table<P: Presence<Table<'a>>>(
        &self,
        key: &Key<Inner, P>,
    ) -> Result<P::Read, SceneError> {
        let table = self.inner(key.name, key.values.table)?;
        key.presence
            .settle(table, || self.missing(key.name, key.values.expected()))
    }

    /// The table of a key of any kind, if its value is one.
    pub(crate) fn table_of(
        &self,
        key: &'static str,
        description: &'static TableDescription,
    ) -> Result<Option<Table<'a>>, SceneError> {
        let table = self.inner(key, description)?;
        table.map(Table::closed).transpose()
    }

    /// The tables of a list such as `[[load]]`, in the order of the file.
    pub(crate) fn tables<P: Presence<()>>(
        &self,
        key: &Key<Inner, P>,
    ) -> Result<Vec<Table<'a>>, SceneError> {
        let tables = match self.given(key.name) {
            None => Vec::new(),
            Some(value) => self.items(key.name, value, key.values.table)?,
        };
        let given = (!tables.is_empty()).then_some(());
        let missing = || self.missing(key.name, key.values.expected());
        let _ = key.presence.settle(given, missing)?;
        Ok(tables)
    }

    /// The tables of the list that is the value of a key of any kind.
    pub(crate) fn tables_of(
        &self,
        key: &'static str,
        description: &'static TableDescription,
    ) -> Result<Vec<Table<'a>>, SceneError> {
        match self.given(key) {
            Some(value) => self.items(key, value, description),
            None => Ok(Vec::new()),
        }
    }

    /// The table of a key, or the tables of its list; none if it is left out.
    pub(crate) fn table_or_list<P>(
        &self,
        key: &Key<Inner, P>,
    ) -> Result<Vec<Table<'a>>, SceneError> {
        match self.given(key.name) {
            Some(value) if matches!(value.get_ref(), DeValue::Array(_)) => {
                self.items(key.name, value, key.values.table)
            }
            Some(value) if !matches!(value.get_ref(), DeValue::Table(_)) => {
                let expected = "a table, or a list of tables".into();
                Err(self.misfit(key.name, value, expected, Misfit::Type))
            }
            _ => Ok(self
                .table_of(key.name, key.values.table)?
                .into_iter()
                .collect()),
        }
    }

    fn items(
        &self,
        key: &'static str,
        value: &'a Spanned<DeValue<'a>>,
        description: &'static TableDescription,
    ) -> Result<Vec<Table<'a>>, SceneError> {
        let (name, expected, several) = match self.place.name() {
            "" => {
                let own = format!("[[{key}]]");
                let expected = format!("a list of tables, each under its own {own}");
                (own.clone(), expected, own)
            }
            outer => (
                format!("{outer} {key}"),
                "a list of tables".to_owned(),
                "a list of tables".to_owned(),
            ),
        };
        let items = match value.get_ref() {
            DeValue::Array(items) => items,
            DeValue::Table(_) => {
                let reason = format!("is one table: write {several}, as there may be several");
                return Err(self
                    .place
                    .value_fault(key, Fault::Misplaced { key, reason }));
            }
            _ => return Err(self.misfit(key, value, expected, Misfit::Type)),
        };
        let table = |(index, item): (usize, &'a Spanned<DeValue<'a>>)| {
            let DeValue::Table(entries) = item.get_ref() else {
                return Err(self.misfit(key, item, expected.clone(), Misfit::Type));
            };
            let name = format!("{name} {}", index + 1);
            Self::new(self.scene, name, Some(item.span()), entries, description).closed()
        };
        items.iter().enumerate().map(table).collect()
    }

    fn inner(
        &self,
        key: &'static str,
        description: &'static TableDescription,
    ) -> Result<Option<Table<'a>>, SceneError> {
        let Some(value) = self.given(key) else {
            return Ok(None);
        };
        let name = match self.place.name() {
            "" => format!("[{key}]"),
            outer => format!("{outer} {key}"),
        };
        let DeValue::Table(entries) = value.get_ref() else {
            return Err(self.misfit(key, value, "a table".into(), Misfit::Type));
        };
        let header = header_or_key(value, self.entries, key);
        Ok(Some(Self::new(
            self.scene,
            name,
            header,
            entries,
            description,
        )))
    }

    /// The value of a key that the table's description has.
    fn given(&self, key: &'static str) -> Option<&'a Spanned<DeValue<'a>>> {
        debug_assert!(
            self.known().any(|known| known == key),
            "{key} would be refused as unknown"
        );
        self.entries.get(key)
    }

    /// The only given key of those of which exactly one is needed; none or several are an error.
    pub(crate) fn exactly_one(&self) -> Result<&'static str, SceneError> {
        let of = match self.description.needs {
            Needs::OneOf(keys) => keys,
            Needs::Any | Needs::Some => &[],
        };
        let found: Vec<&'static str> = of.iter().copied().filter(|key| self.has(key)).collect();
        match found[..] {
            [key] => Ok(key),
            [] => Err(self.place.fault(Fault::NotExactlyOne { of, found })),
            [_, second, ..] => {
                let fault = Fault::NotExactlyOne { of, found };
                Err(self.place.key_fault(second, fault))
            }
        }
    }

    /// Returns an error for the first key that is given but not allowed together with the others.
    pub(crate) fn check_conditions(&self) -> Result<(), SceneError> {
        for key in self.description.all_keys() {
            let key_is_given = self.has(key.name());
            let broken = key
                .conditions()
                .iter()
                .find(|condition| !self.meets(condition));
            if let (true, Some(condition)) = (key_is_given, broken) {
                let error = self.unknown_word(condition);
                return Err(error.unwrap_or_else(|| self.misplaced(key.name(), condition)));
            }
        }
        Ok(())
    }

    fn meets(&self, condition: &Condition) -> bool {
        match condition.goes {
            Goes::With(other) => self.has(other),
            Goes::Without(other) => !self.has(other),
            Goes::If(..) | Goes::Among(..) => {
                condition.goes.words().is_some_and(|(other, words)| {
                    let word = self.word(other);
                    word.is_some_and(|word| words.contains(&word))
                })
            }
            Goes::Never => false,
        }
    }

    /// The error for the word of another key on which a condition depends, if the word itself is unknown.
    fn unknown_word(&self, condition: &Condition) -> Option<SceneError> {
        let (other, _) = condition.goes.words()?;
        let value = self.entries.get(other)?;
        let keys = self.description.all_keys();
        let described = keys.into_iter().find(|key| key.name() == other)?.describe();
        let Shape::Words(words) = described.shape else {
            return None;
        };
        let misfit = match value.get_ref().as_str() {
            Some(word) if words.contains(&word) => return None,
            Some(_) => Misfit::Value,
            None => Misfit::Type,
        };
        Some(self.misfit(other, value, described.expected, misfit))
    }

    /// The text of a key; `None` if its value is not a text.
    fn word(&self, key: &str) -> Option<&str> {
        self.entries.get(key)?.get_ref().as_str()
    }

    /// True for a key that may be given: it is allowed with the words of other keys, and so are the keys that it
    /// depends on.
    fn may_be_given(&self, key: &dyn Described) -> bool {
        self.may_be_given_after(key, &mut Vec::new())
    }

    /// The same, for keys that depend on each other: those in `seen` are not checked again.
    fn may_be_given_after(&self, key: &dyn Described, seen: &mut Vec<&'static str>) -> bool {
        seen.push(key.name());
        let mut is_possible = |other: &str| {
            let keys = self.description.all_keys();
            let other = keys.into_iter().find(|key| key.name() == other);
            let other = other.filter(|other| !seen.contains(&other.name()));
            other.is_none_or(|other| self.may_be_given_after(other, seen))
        };
        key.conditions()
            .iter()
            .all(|condition| match condition.goes {
                Goes::With(other) => is_possible(other),
                Goes::If(other, _) | Goes::Among(other, _) => {
                    is_possible(other) && (self.word(other).is_none() || self.meets(condition))
                }
                Goes::Without(_) | Goes::Never => true,
            })
    }

    fn misplaced(&self, key: &'static str, condition: &Condition) -> SceneError {
        let reason = condition.reason.to_owned();
        let error = self.place.key_fault(key, Fault::Misplaced { key, reason });
        match condition.help {
            Some(help) => error.with_help(help),
            None => error,
        }
    }

    /// The error for a key that is missing.
    pub(crate) fn missing(&self, key: &'static str, expected: String) -> SceneError {
        self.place.fault(Fault::Missing { key, expected })
    }

    /// The error for a value that does not fit.
    pub(crate) fn misfit(
        &self,
        key: &str,
        value: &Spanned<DeValue<'_>>,
        expected: String,
        misfit: Misfit,
    ) -> SceneError {
        let found = self.written(value);
        let fault = match misfit {
            Misfit::Formula => return self.no_formula(key, value),
            Misfit::Value => Fault::Value {
                key: key.to_owned(),
                found,
                expected,
            },
            Misfit::TooLarge => Fault::Value {
                key: key.to_owned(),
                found,
                expected: WITHIN.to_owned(),
            },
            Misfit::Type => Fault::Type {
                key: key.to_owned(),
                found,
                expected,
                kind: kind(value.get_ref()),
            },
        };
        self.place.error(Some(value.span()), fault)
    }

    /// The error for a list with a text that is not a formula, at the first character that does not fit.
    fn no_formula(&self, key: &str, value: &Spanned<DeValue<'_>>) -> SceneError {
        let mut items = value.get_ref().as_array().into_iter().flatten();
        let wrong = items.find_map(|item| {
            let text = item.get_ref().as_str()?;
            Some((item.span(), text, Formula::parse(text).err()?))
        });
        let Some((span, text, error)) = wrong else {
            return self.misfit(key, value, "formulas".to_owned(), Misfit::Value);
        };
        let wrong = text.char_indices().nth(error.at - 1);
        let (before, length) = wrong.map_or((text.len(), 1), |(before, c)| (before, c.len_utf8()));
        // Behind the quotation mark, unless the text is written with escapes.
        let from = span.start + 1;
        let source = self.scene.text().get(from..).unwrap_or_default();
        let span = match source.starts_with(text) {
            true => from + before..from + before + length,
            false => span,
        };
        let fault = Fault::Formula {
            key: key.to_owned(),
            text: text.to_owned(),
            error,
        };
        self.place.error(Some(span), fault)
    }

    /// The error for a value of a key that fits on its own, but not together with the others.
    pub(crate) fn value_misfit(&self, key: &'static str, expected: &str) -> SceneError {
        match self.given(key) {
            Some(value) => self.misfit(key, value, expected.to_owned(), Misfit::Value),
            None => self.missing(key, expected.to_owned()),
        }
    }

    /// A value as the user wrote it, on one line and shortened.
    fn written(&self, value: &Spanned<DeValue<'_>>) -> String {
        let text = self.scene.text().get(value.span()).unwrap_or_default();
        shortened(&text.split_whitespace().collect::<Vec<_>>().join(" "))
    }
}

/// The span of a table: its header or braces, or its key if dotted keys make the table.
fn header_or_key(
    value: &Spanned<DeValue<'_>>,
    entries: &DeTable<'_>,
    key: &str,
) -> Option<Range<usize>> {
    let span = value.span();
    if !span.is_empty() {
        return Some(span);
    }
    entries.get_key_value(key).map(|(key, _)| key.span())
}
