//! `[[load]]`: what acts on the body.

use sinew_fem::{LoadKind, LoadSpec};

use super::region::taken;
use super::{GRAVITY, ramp};
use crate::decode::value::{Misfit, finite, text, vector};
use crate::decode::{Place, Table};
use crate::error::SceneError;

const KEYS: &[&str] = &["name", "group", "traction", "pressure", "force", "ramp"];

/// Loads, the names they were given, and where they stand.
pub(super) type Loads = (Vec<LoadSpec>, Vec<Option<String>>, Vec<Place>);

pub(super) fn read_all(document: &Table<'_>) -> Result<Loads, SceneError> {
    let tables = document.tables("load", KEYS)?;
    let loads = tables.iter().map(read).collect::<Result<_, _>>()?;
    let mut names: Vec<Option<String>> = Vec::new();
    for table in &tables {
        let name = table.optional("name", "a name other than \"gravity\"", name)?;
        let same = name
            .as_ref()
            .and_then(|_| names.iter().position(|other| *other == name));
        if let (Some(first), Some(name)) = (same, &name) {
            return Err(taken(table.place(), "name", name, tables[first].place()));
        }
        names.push(name);
    }
    let places = tables.into_iter().map(Table::into_place).collect();
    Ok((loads, names, places))
}

fn name(value: &toml::de::DeValue<'_>) -> Result<String, Misfit> {
    match text(value)? {
        name if name == GRAVITY => Err(Misfit::Value),
        name => Ok(name),
    }
}

fn read(table: &Table<'_>) -> Result<LoadSpec, SceneError> {
    let kind = match table.exactly_one(&["traction", "pressure", "force"])? {
        "traction" => {
            LoadKind::Traction(table.required("traction", "[x, y, z] in Pa, all finite", vector)?)
        }
        "force" => {
            LoadKind::Force(table.required("force", "[x, y, z] in N, all finite", vector)?)
        }
        _ => LoadKind::Pressure(table.required("pressure", "a finite number of Pa", finite)?),
    };
    Ok(LoadSpec {
        group: table.required("group", "the name of a group", text)?,
        kind,
        ramp: ramp::read(table)?,
    })
}
