//! `[[probe]]`: points whose motion is recorded.

use toml::de::DeValue;

use super::region::taken;
use crate::decode::value::{Misfit, text, vector};
use crate::decode::{Place, Table};
use crate::error::SceneError;

/// A point whose motion is recorded, as that of the nearest node.
#[derive(Debug, Clone, PartialEq)]
pub struct ProbePoint {
    /// Its name, which also begins the names of its columns.
    pub name: String,
    /// Its position in the undeformed body (m).
    pub point: [f64; 3],
}

pub(super) fn read_all(document: &Table<'_>) -> Result<(Vec<ProbePoint>, Vec<Place>), SceneError> {
    let tables = document.tables("probe", &["name", "point"])?;
    let mut probes: Vec<ProbePoint> = Vec::new();
    for table in &tables {
        let probe = read(table)?;
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

fn read(table: &Table<'_>) -> Result<ProbePoint, SceneError> {
    let expected = "a name made of letters, digits, `-`, `_` and `.`";
    Ok(ProbePoint {
        name: table.required("name", expected, column_name)?,
        point: table.required("point", "[x, y, z] in m, all finite", vector)?,
    })
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
