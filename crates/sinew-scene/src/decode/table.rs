//! One table of a scene and the values its keys hold.

use std::ops::Range;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::place::{KeyPlace, Place};
use super::value::{Misfit, kind, text};
use crate::error::{Fault, SceneError, shortened};
use crate::nearest::nearest;
use crate::source::SceneSource;

type Keys = &'static [&'static str];

/// A table whose keys were checked. Its methods read the values.
pub(crate) struct Table<'a> {
    scene: &'a Arc<SceneSource>,
    entries: &'a DeTable<'a>,
    keys: Keys,
    place: Place,
}

impl<'a> Table<'a> {
    /// The whole document; a key that is not in `keys` is an error.
    pub(crate) fn document(
        scene: &'a Arc<SceneSource>,
        entries: &'a DeTable<'a>,
        keys: Keys,
    ) -> Result<Self, SceneError> {
        Self::new(scene, String::new(), None, entries, keys).closed()
    }

    fn new(
        scene: &'a Arc<SceneSource>,
        name: String,
        header: Option<Range<usize>>,
        entries: &'a DeTable<'a>,
        keys: Keys,
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
            keys,
            place: Place::new(scene, name, header, places.collect()),
        }
    }

    fn closed(self) -> Result<Self, SceneError> {
        match self.others().min_by_key(|(key, _)| key.span().start) {
            None => Ok(self),
            Some((key, _)) => Err(self.unknown(key)),
        }
    }

    /// The error for a key that means nothing here.
    pub(crate) fn unknown(&self, key: &Spanned<DeString<'_>>) -> SceneError {
        let fault = Fault::UnknownKey {
            key: key.get_ref().clone().into_owned(),
            nearest: nearest(key.get_ref(), self.keys.iter().copied()),
            known: self.keys,
        };
        self.place.key_fault(key.get_ref(), fault)
    }

    /// The entries whose keys are not among the known ones.
    pub(crate) fn others(
        &self,
    ) -> impl Iterator<Item = (&'a Spanned<DeString<'a>>, &'a Spanned<DeValue<'a>>)> {
        let keys = self.keys;
        self.entries
            .iter()
            .filter(move |(key, _)| !keys.contains(&key.get_ref().as_ref()))
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

    /// The value of a key, if the key is given.
    pub(crate) fn optional<T>(
        &self,
        key: &'static str,
        expected: &str,
        read: impl FnOnce(&DeValue<'_>) -> Result<T, Misfit>,
    ) -> Result<Option<T>, SceneError> {
        debug_assert!(
            self.keys.contains(&key),
            "{key} would be refused as unknown"
        );
        let Some(value) = self.entries.get(key) else {
            return Ok(None);
        };
        read(value.get_ref())
            .map(Some)
            .map_err(|misfit| self.misfit(key, value, expected.to_owned(), misfit))
    }

    /// The value of a key that must be given.
    pub(crate) fn required<T>(
        &self,
        key: &'static str,
        expected: &str,
        read: impl FnOnce(&DeValue<'_>) -> Result<T, Misfit>,
    ) -> Result<T, SceneError> {
        self.optional(key, expected, read)?
            .ok_or_else(|| self.missing(key, expected))
    }

    /// The meaning of a key whose value is one of a few words, if the key is given.
    pub(crate) fn optional_choice<T: Copy>(
        &self,
        key: &'static str,
        choices: &[(&'static str, T)],
    ) -> Result<Option<T>, SceneError> {
        self.optional(key, &any_of(choices), |value| {
            let word = text(value)?;
            let choice = choices.iter().find(|(name, _)| *name == word);
            choice.map(|(_, value)| *value).ok_or(Misfit::Value)
        })
    }

    /// The meaning of a key whose value is one of a few words.
    pub(crate) fn choice<T: Copy>(
        &self,
        key: &'static str,
        choices: &[(&'static str, T)],
    ) -> Result<T, SceneError> {
        self.optional_choice(key, choices)?
            .ok_or_else(|| self.missing(key, &any_of(choices)))
    }

    /// The only key among `of` that is given; none or several are an error.
    pub(crate) fn exactly_one(&self, of: Keys) -> Result<&'static str, SceneError> {
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

    /// Returns an error if one of `keys` is given, for `reason`.
    pub(crate) fn refuse(&self, keys: Keys, reason: &str) -> Result<(), SceneError> {
        match keys.iter().copied().find(|key| self.has(key)) {
            None => Ok(()),
            Some(key) => {
                let reason = reason.to_owned();
                Err(self.place.key_fault(key, Fault::Misplaced { key, reason }))
            }
        }
    }

    /// A table inside this one, if it is given.
    pub(crate) fn table(
        &self,
        key: &'static str,
        keys: Keys,
    ) -> Result<Option<Table<'a>>, SceneError> {
        self.open_table(key, keys)?.map(Table::closed).transpose()
    }

    /// A table inside this one that may have other keys than `keys`.
    pub(crate) fn open_table(
        &self,
        key: &'static str,
        keys: Keys,
    ) -> Result<Option<Table<'a>>, SceneError> {
        let Some(value) = self.entries.get(key) else {
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
        Ok(Some(Self::new(self.scene, name, header, entries, keys)))
    }

    /// The tables of a list such as `[[load]]`, in the order of the file.
    pub(crate) fn tables(
        &self,
        key: &'static str,
        keys: Keys,
    ) -> Result<Vec<Table<'a>>, SceneError> {
        let Some(value) = self.entries.get(key) else {
            return Ok(Vec::new());
        };
        let expected = format!("a list of tables, each under its own [[{key}]]");
        let items = match value.get_ref() {
            DeValue::Array(items) => items,
            DeValue::Table(_) => {
                let reason = format!("is one table: write [[{key}]], as there may be several");
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
            let name = format!("[[{key}]] {}", index + 1);
            Self::new(self.scene, name, Some(item.span()), entries, keys).closed()
        };
        items.iter().enumerate().map(table).collect()
    }

    /// The error for a key that is missing.
    pub(crate) fn missing(&self, key: &'static str, expected: &str) -> SceneError {
        self.place.fault(Fault::Missing {
            key,
            expected: expected.to_owned(),
        })
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
            Misfit::Value => Fault::Value {
                key: key.to_owned(),
                found,
                expected,
            },
            Misfit::Type => Fault::Type {
                key: key.to_owned(),
                found,
                expected,
                kind: kind(value.get_ref()),
            },
        };
        self.place.value_fault(key, fault)
    }

    /// A value as the user wrote it, on one line and shortened.
    fn written(&self, value: &Spanned<DeValue<'_>>) -> String {
        let text = self.scene.text().get(value.span()).unwrap_or_default();
        shortened(&text.split_whitespace().collect::<Vec<_>>().join(" "))
    }
}

/// The span of a table: its header or braces, or its key where dotted keys make the table.
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

fn any_of<T>(choices: &[(&'static str, T)]) -> String {
    let names: Vec<String> = choices
        .iter()
        .map(|(name, _)| format!("\"{name}\""))
        .collect();
    match names.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => names.concat(),
    }
}
