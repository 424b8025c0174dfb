//! `[[load]]`: forces on the body.

use sinew_fem::{LoadKind, LoadSpec, On};

use super::keys::GRAVITY;
use super::ramp;
use super::region::taken;
use super::selected::{Members, Selections};
use crate::decode::value::{Misfit, finite, text, vector};
use crate::decode::{Place, Table};
use crate::error::SceneError;

const KEYS: &[&str] = &[
    "name", "group", "where", "traction", "pressure", "force", "ramp",
];

/// The tables `[[load]]`, in the order of the file.
pub(super) struct LoadTables {
    /// The loads.
    pub(super) specs: Vec<LoadSpec>,
    /// The name of each, if it has one.
    pub(super) names: Vec<Option<String>>,
    /// The place of each in the text.
    pub(super) places: Vec<Place>,
}

pub(super) fn read_all(
    document: &Table<'_>,
    selections: &mut Selections,
) -> Result<LoadTables, SceneError> {
    let tables = document.tables("load", KEYS)?;
    let specs = tables.iter().map(|table| read(table, selections));
    let specs = specs.collect::<Result<_, _>>()?;
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
    Ok(LoadTables {
        specs,
        names,
        places,
    })
}

fn name(value: &toml::de::DeValue<'_>) -> Result<String, Misfit> {
    match text(value)? {
        name if name == GRAVITY => Err(Misfit::Value),
        name => Ok(name),
    }
}

fn read(table: &Table<'_>, selections: &mut Selections) -> Result<LoadSpec, SceneError> {
    let kind = match table.exactly_one(&["traction", "pressure", "force"])? {
        "traction" => {
            LoadKind::Traction(table.required("traction", "[x, y, z] in Pa, all finite", vector)?)
        }
        "force" => {
            LoadKind::Force(table.required("force", "[x, y, z] in N, all finite", vector)?)
        }
        _ => LoadKind::Pressure(table.required("pressure", "a finite number of Pa", finite)?),
    };
    let members = match kind {
        LoadKind::Force(_) => Members::Nodes,
        LoadKind::Traction(_) | LoadKind::Pressure(_) => Members::Triangles,
    };
    Ok(LoadSpec {
        on: On::Group(selections.required(table, members)?),
        kind,
        ramp: ramp::read(table)?,
    })
}
