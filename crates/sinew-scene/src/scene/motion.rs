//! `[[move]]`: parts of the body that are moved.

use std::path::PathBuf;

use sinew_core::Ramp;

use super::selected::{Members, Selections};
use super::{fixed, ramp};
use crate::decode::value::{text, vector};
use crate::decode::{Place, Table};
use crate::error::SceneError;

/// A part of the body that is moved.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// The group whose nodes are moved.
    pub group: String,
    /// Whether x, y and z are prescribed; the other directions stay free.
    pub axes: [bool; 3],
    /// The way it goes.
    pub way: Way,
}

/// The way that a part is moved, relative to rest.
#[derive(Debug, Clone, PartialEq)]
pub enum Way {
    /// A displacement (m) times a ramp.
    Displacement([f64; 3], Ramp),
    /// At this velocity (m/s) from t = 0 on.
    Velocity([f64; 3]),
    /// Straight lines between the rows of a CSV file: its path as written, relative to the scene's folder.
    Table(PathBuf),
}

impl Way {
    /// The key that gives it.
    pub(crate) fn key(&self) -> &'static str {
        match self {
            Self::Displacement(..) => "displacement",
            Self::Velocity(_) => "velocity",
            Self::Table(_) => "table",
        }
    }
}

const KEYS: &[&str] = &[
    "group",
    "where",
    "axes",
    "displacement",
    "velocity",
    "table",
    "ramp",
];

pub(super) fn read_all(
    document: &Table<'_>,
    selections: &mut Selections,
) -> Result<(Vec<Motion>, Vec<Place>), SceneError> {
    let tables = document.tables("move", KEYS)?;
    let motions = tables.iter().map(|table| read(table, selections));
    let motions = motions.collect::<Result<_, _>>()?;
    Ok((motions, tables.into_iter().map(Table::into_place).collect()))
}

fn read(table: &Table<'_>, selections: &mut Selections) -> Result<Motion, SceneError> {
    let kind = table.exactly_one(&["displacement", "velocity", "table"])?;
    if kind != "displacement" {
        table.refuse(&["ramp"], "goes with `displacement` only")?;
    }
    Ok(Motion {
        group: selections.required(table, Members::Nodes)?,
        axes: fixed::axes_of(table)?,
        way: match kind {
            "displacement" => Way::Displacement(
                table.required("displacement", "[x, y, z] in m, all finite", vector)?,
                ramp::required(table)?,
            ),
            "velocity" => {
                Way::Velocity(table.required("velocity", "[x, y, z] in m/s, all finite", vector)?)
            }
            _ => {
                let file = "the path of a CSV file, seen from the scene";
                Way::Table(table.required("table", file, text)?.into())
            }
        },
    })
}
