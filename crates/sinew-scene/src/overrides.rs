//! Values that a command line sets in a scene.

use toml_edit::{ArrayOfTables, DocumentMut, InlineTable, Item, Table, TableLike, Value};

use crate::decode::{Shape, TableDescription};
use crate::error::OverrideError;
use crate::nearest::nearest;
use crate::scene::DOCUMENT;
use crate::source::SceneSource;

/// Begins a text that removes a value.
const REMOVES: char = '~';

impl SceneSource {
    /// The scene with other values: `KEY=VALUE` each, the parts of a key separated by dots, tables of a list by their
    /// numbers from 1 on. A value is TOML; a text that is not TOML is a string. A key that its table does not have is
    /// added to it, and so is a missing table, at the end of its list if it is one of a list; `~KEY` removes a value, or a table of a list.
    /// The rest of the text is unchanged.
    ///
    /// ```
    /// use sinew_scene::SceneSource;
    ///
    /// let scene = SceneSource::new("a.toml", "[[region]] # liver\nyoungs_modulus = 3500.0\n[run]\ndt = 0.01\n");
    /// let stiffer = scene.with_values(&["region.1.youngs_modulus=4e3", "run.integrator=newmark"])?;
    /// assert_eq!(
    ///     stiffer.text(),
    ///     "[[region]] # liver\nyoungs_modulus = 4e3\n[run]\ndt = 0.01\nintegrator = \"newmark\"\n"
    /// );
    /// # Ok::<(), sinew_scene::OverrideError>(())
    /// ```
    ///
    /// # Errors
    /// [`OverrideError`] for the first that cannot be set. The validity of a value is checked when the scene is read.
    pub fn with_values<T: AsRef<str>>(&self, values: &[T]) -> Result<Self, OverrideError> {
        if values.is_empty() {
            return Ok(self.clone());
        }
        let mut document: DocumentMut =
            self.text().parse().map_err(|error: toml_edit::TomlError| {
                let end = error.span().map_or(0, |span| span.start);
                let before = self.text().as_bytes().iter().take(end);
                OverrideError::Syntax {
                    line: 1 + before.filter(|byte| **byte == b'\n').count(),
                    message: error.message().to_owned(),
                }
            })?;
        for text in values {
            let text = text.as_ref();
            let form = || OverrideError::Form {
                text: text.to_owned(),
            };
            if let Some(path) = text.strip_prefix(REMOVES).map(str::trim) {
                let parts: Vec<&str> = path.split('.').collect();
                if parts.iter().any(|part| part.is_empty()) {
                    return Err(form());
                }
                remove(document.as_table_mut(), path, &parts)?;
                continue;
            }
            let (path, value) = text.split_once('=').ok_or_else(form)?;
            let (path, value) = (path.trim(), value.trim());
            if path.split('.').any(str::is_empty) || value.is_empty() {
                return Err(form());
            }
            let value = value.parse().unwrap_or_else(|_| Value::from(value));
            let parts: Vec<&str> = path.split('.').collect();
            let within = Some(&DOCUMENT);
            set((document.as_table_mut(), within), path, &parts, value)?;
        }
        Ok(self.with_text(document.to_string()))
    }
}

/// Removes the value at the remaining parts of a path within this table.
fn remove(table: &mut dyn TableLike, path: &str, parts: &[&str]) -> Result<(), OverrideError> {
    let [part, rest @ ..] = parts else {
        return Err(OverrideError::Form {
            text: format!("{REMOVES}{path}"),
        });
    };
    let names: Vec<String> = table.iter().map(|(name, _)| name.to_owned()).collect();
    let missing = || OverrideError::Missing {
        path: path.to_owned(),
        missing: (*part).to_owned(),
        nearest: nearest(part, names.iter().map(String::as_str)).map(str::to_owned),
    };
    let item = table.get_mut(part).ok_or_else(missing)?;
    let kind = |part: &str, item: &Item, expected| OverrideError::Kind {
        path: path.to_owned(),
        part: part.to_owned(),
        found: kind_of(item),
        expected,
    };
    match (item, rest) {
        (Item::Value(_), []) => {
            table.remove(part);
            Ok(())
        }
        (other, []) => Err(kind(part, other, "a value")),
        (Item::ArrayOfTables(tables), [number, rest @ ..]) => {
            let place = number
                .parse::<usize>()
                .ok()
                .and_then(|it| it.checked_sub(1));
            let count = tables.len();
            let place = place.filter(|place| *place < count);
            let place = place.ok_or_else(|| OverrideError::Number {
                path: path.to_owned(),
                list: (*part).to_owned(),
                count,
            })?;
            if let Some(found) = tables.get_mut(place).filter(|_| !rest.is_empty()) {
                return remove(found, path, rest);
            }
            tables.remove(place);
            Ok(())
        }
        (Item::Table(table), rest) => remove(table, path, rest),
        (Item::Value(Value::InlineTable(table)), rest) => remove(table, path, rest),
        (other, _) => Err(kind(part, other, "a table")),
    }
}

/// Sets the value at the remaining parts of a path within this table, whose description may be known.
fn set(
    (table, description): (&mut dyn TableLike, Option<&'static TableDescription>),
    path: &str,
    parts: &[&str],
    mut value: Value,
) -> Result<(), OverrideError> {
    let kind = |part: &str, item: &Item, expected| OverrideError::Kind {
        path: path.to_owned(),
        part: part.to_owned(),
        found: kind_of(item),
        expected,
    };
    let (part, rest) = match parts {
        [] => return Ok(()),
        [key] => {
            match table.get(key) {
                None => {}
                Some(Item::Value(old)) => *value.decor_mut() = old.decor().clone(),
                Some(other) => return Err(kind(key, other, "a value")),
            }
            table.insert(key, Item::Value(value));
            return Ok(());
        }
        [part, rest @ ..] => (*part, rest),
    };
    let described = description.and_then(|within| tables_of(within, part));
    if !table.contains_key(part) {
        let new = match described {
            Some(Inner { is_list: true, .. }) => Some(Item::ArrayOfTables(ArrayOfTables::new())),
            Some(Inner { .. }) if is_top(description) => Some(Item::Table(Table::new())),
            Some(Inner { .. }) => Some(Item::Value(InlineTable::new().into())),
            None => None,
        };
        let Some(new) = new else {
            let known = description.map_or_else(Vec::new, TableDescription::all_keys);
            let names: Vec<String> = table.iter().map(|(name, _)| name.to_owned()).collect();
            let known = known.iter().map(|key| key.name());
            let nearest = nearest(part, names.iter().map(String::as_str).chain(known));
            return Err(OverrideError::Missing {
                path: path.to_owned(),
                missing: part.to_owned(),
                nearest: nearest.map(str::to_owned),
            });
        };
        table.insert(part, new);
    }
    let inner = described.map(|inner| inner.of);
    match table.get_mut(part) {
        Some(Item::ArrayOfTables(tables)) => {
            let count = tables.len();
            let number = rest.first().and_then(|number| number.parse::<usize>().ok());
            if number == Some(count + 1) && rest.len() > 1 {
                tables.push(Table::new());
            }
            let found = number.and_then(|number| tables.get_mut(number.checked_sub(1)?));
            let found = found.ok_or_else(|| OverrideError::Number {
                path: path.to_owned(),
                list: part.to_owned(),
                count,
            })?;
            match &rest[1..] {
                [] => Err(OverrideError::Kind {
                    path: path.to_owned(),
                    part: rest.join("."),
                    found: "a table",
                    expected: "a value",
                }),
                rest => set((found, inner), path, rest, value),
            }
        }
        Some(Item::Table(table)) => set((table, inner), path, rest, value),
        Some(Item::Value(Value::InlineTable(table))) => set((table, inner), path, rest, value),
        Some(other) => Err(kind(part, other, "a table")),
        None => Ok(()),
    }
}

/// A table, or the tables of a list, as the value of a key.
#[derive(Clone, Copy)]
struct Inner {
    of: &'static TableDescription,
    is_list: bool,
}

/// The table or list of tables that is the value of a key of a described table, if any.
fn tables_of(within: &'static TableDescription, part: &str) -> Option<Inner> {
    fn of_shape(shape: &Shape) -> Option<Inner> {
        match shape {
            Shape::Table(of) => Some(Inner { of, is_list: false }),
            Shape::Tables(of) => Some(Inner { of, is_list: true }),
            Shape::Either(shapes) => shapes.iter().find_map(of_shape),
            _ => None,
        }
    }
    let keys = within.all_keys();
    let key = keys.iter().find(|key| key.name() == part)?;
    of_shape(&key.describe().shape)
}

/// True if a table is the whole scene.
fn is_top(description: Option<&'static TableDescription>) -> bool {
    description.is_some_and(|description| description.name == DOCUMENT.name)
}

fn kind_of(item: &Item) -> &'static str {
    match item {
        Item::None => "nothing",
        Item::Value(_) => "a value",
        Item::Table(_) => "a table",
        Item::ArrayOfTables(_) => "a list of tables",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "title = \"a\"  # the title\n[mesh]\ncube = { cells = 4, edge = 0.1 }\n[[region]]\ndensity = 1\n\
                         [[region]]\ndensity = 2 # kg/m3\n[run]\nintegrator = \"newmark\"\ndt = 0.1\n";

    fn with(values: &[&str]) -> Result<String, String> {
        let scene = SceneSource::new("a.toml", SCENE).with_values(values);
        scene
            .map(|scene| scene.text().to_owned())
            .map_err(|error| error.to_string())
    }

    #[test]
    fn values_change_and_all_else_stays() {
        assert_eq!(with(&[]).unwrap(), SCENE);
        let cases = [
            ("title=b", "title = \"a\"", "title = \"b\""),
            ("region.2.density=3.5", "density = 2", "density = 3.5"),
            ("mesh.cube.cells = 8", "cells = 4", "cells = 8"),
            ("run.dt=auto", "dt = 0.1", "dt = \"auto\""),
            ("run.dt=[1, 2]", "dt = 0.1", "dt = [1, 2]"),
            (
                "run.tolerance=0.01",
                "dt = 0.1\n",
                "dt = 0.1\ntolerance = 0.01\n",
            ),
            (
                "output.fields.frames=5",
                "dt = 0.1\n",
                "dt = 0.1\n\n[output]\nfields = { frames = 5 }\n",
            ),
            (
                "damping.mass=1",
                "dt = 0.1\n",
                "dt = 0.1\n\n[damping]\nmass = 1\n",
            ),
            (
                "load.1.group=top",
                "dt = 0.1\n",
                "dt = 0.1\n\n[[load]]\ngroup = \"top\"\n",
            ),
            (
                "region.3.density=1",
                "density = 2 # kg/m3\n",
                "density = 2 # kg/m3\n\n[[region]]\ndensity = 1\n",
            ),
            (
                "gravity=[0, 0, -9.81]",
                "[mesh]",
                "gravity = [0, 0, -9.81]\n[mesh]",
            ),
            ("~run.dt", "dt = 0.1\n", ""),
            ("~region.2", "[[region]]\ndensity = 2 # kg/m3\n", ""),
            ("~region.2.density", "density = 2 # kg/m3\n", ""),
            ("~mesh.cube.edge", "cells = 4, edge = 0.1 ", "cells = 4"),
        ];
        for (value, from, to) in cases {
            assert_eq!(with(&[value]).unwrap(), SCENE.replace(from, to), "{value}");
        }
    }

    #[test]
    fn what_cannot_be_set_is_said() {
        let cases = [
            ("dt", "expected KEY=VALUE"),
            ("run..dt=1", "expected KEY=VALUE"),
            ("run.dt=", "expected KEY=VALUE"),
            ("~run.integratr", "did you mean `integrator`?"),
            ("~run", "`run` is a table, expected a value"),
            ("~region.3.density", "the scene has 2 of `region`"),
            ("~", "expected KEY=VALUE"),
            ("~run..dt", "expected KEY=VALUE"),
            ("~run.dt.x", "`dt` is a value, expected a table"),
            ("rum.dt=1", "the scene has no `rum`; did you mean `run`?"),
            (
                "region.density=1",
                "the scene has 2 of `region`, counted from 1",
            ),
            ("region.4.density=1", "the scene has 2 of `region`"),
            ("load.2.group=top", "the scene has 0 of `load`"),
            (
                "dampin.mass=1",
                "the scene has no `dampin`; did you mean `damping`?",
            ),
            ("region.0.density=1", "the scene has 2 of `region`"),
            ("title.a=1", "`title` is a value, expected a table"),
            ("run=1", "`run` is a table, expected a value"),
            ("region.1=1", "`1` is a table, expected a value"),
            ("region=1", "`region` is a list of tables, expected a value"),
        ];
        for (value, expected) in cases {
            let error = with(&[value]).unwrap_err();
            assert!(error.contains(expected), "{value}: {error}");
        }
    }

    #[test]
    fn a_scene_that_is_not_toml_is_told_by_its_line() {
        let broken = SceneSource::new("a.toml", "[run]\ndt = 1\ndt = 2\n");
        let error = broken.with_values(&["run.dt=3"]).unwrap_err().to_string();
        assert_eq!(error, "the scene is not TOML in line 3: duplicate key");
    }
}
