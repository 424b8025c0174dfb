//! `[[probe]]`: points whose motion is recorded.

use toml::de::DeValue;

use super::region::taken;
use super::selected::{Members, Selections};
use crate::decode::value::{Misfit, text, vector};
use crate::decode::{Place, Table};
use crate::error::SceneError;

/// A node whose motion is recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct ProbePoint {
    /// Its name, which also begins the names of its columns.
    pub name: String,
    /// The node.
    pub at: ProbeAt,
}

/// The node of a probe.
#[derive(Debug, Clone, PartialEq)]
pub enum ProbeAt {
    /// The node nearest to a position in the undeformed body (m).
    Point([f64; 3]),
    /// The only node of a group.
    Group(String),
}

pub(super) fn read_all(
    document: &Table<'_>,
    selections: &mut Selections,
) -> Result<(Vec<ProbePoint>, Vec<Place>), SceneError> {
    let tables = document.tables("probe", &["name", "point", "where"])?;
    let mut probes: Vec<ProbePoint> = Vec::new();
    for table in &tables {
        let probe = read(table, selections)?;
        let same = probes.iter().position(|other| other.name == probe.name);
        if let Some(first) = same {
            return Err(taken(
                table.place(),
                "name",
                &probe.name,
                tables[first].place(),
            ));
        }
        probes.push(probe);
    }
    Ok((probes, tables.into_iter().map(Table::into_place).collect()))
}

fn read(table: &Table<'_>, selections: &mut Selections) -> Result<ProbePoint, SceneError> {
    let expected = "a name made of letters, digits, `-`, `_` and `.`";
    let name = table.required("name", expected, column_name)?;
    let at = match table.has("where") {
        true => {
            table.refuse(
                &["point"],
                "does not go with `where`, which stands in its place",
            )?;
            ProbeAt::Group(selections.required(table, Members::Nodes)?)
        }
        false => ProbeAt::Point(table.required("point", "[x, y, z] in m, all finite", vector)?),
    };
    Ok(ProbePoint { name, at })
}

/// A name that needs no quotes in a CSV file.
fn column_name(value: &DeValue<'_>) -> Result<String, Misfit> {
    let name = text(value)?;
    let plain = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.');
    if name.chars().all(plain) {
        Ok(name)
    } else {
        Err(Misfit::Value)
    }
}
