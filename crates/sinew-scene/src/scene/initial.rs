//! `[[initial]]`: displacement and velocity at t = 0.

use super::keys::GRAVITY;
use super::selected::{Members, Selections};
use crate::decode::value::{Misfit, list, text, vector};
use crate::decode::{Place, Table};
use crate::error::{Fault, SceneError};

/// A part of the state at t = 0. Where several parts set the same node, the last one counts.
#[derive(Debug, Clone, PartialEq)]
pub enum Initial {
    /// The same displacement (m) for all nodes of a group.
    Displacement {
        /// The group; `None` stands for the whole body.
        group: Option<String>,
        /// Displacement (m).
        value: [f64; 3],
    },
    /// The same velocity (m/s) for all nodes of a group.
    Velocity {
        /// The group; `None` stands for the whole body.
        group: Option<String>,
        /// Velocity (m/s).
        value: [f64; 3],
    },
    /// u_i = strain_i (x_i - origin_i) for all nodes of a group.
    Stretch {
        /// The group; `None` stands for the whole body.
        group: Option<String>,
        /// Strain along x, y, z.
        strain: [f64; 3],
        /// The point that does not move (m).
        origin: [f64; 3],
    },
    /// The displacement of the whole body at rest under loads at their full value.
    Static {
        /// Names of the loads; `gravity` is one where the scene has gravity.
        loads: Vec<String>,
    },
}

const KEYS: &[&str] = &[
    "group",
    "where",
    "displacement",
    "velocity",
    "stretch",
    "origin",
    "static",
];

/// Reads all parts; a static state may name the loads in `load_names`, and gravity.
pub(super) fn read_all(
    document: &Table<'_>,
    load_names: &[Option<String>],
    selections: &mut Selections,
) -> Result<(Vec<Initial>, Vec<Place>), SceneError> {
    let tables = document.tables("initial", KEYS)?;
    let mut known: Vec<String> = load_names.iter().flatten().cloned().collect();
    if document.has(GRAVITY) {
        known.push(GRAVITY.into());
    }
    let initial = tables.iter().map(|table| read(table, &known, selections));
    let initial = initial.collect::<Result<_, _>>()?;
    Ok((initial, tables.into_iter().map(Table::into_place).collect()))
}

fn read(
    table: &Table<'_>,
    known: &[String],
    selections: &mut Selections,
) -> Result<Initial, SceneError> {
    let kind = table.exactly_one(&["displacement", "velocity", "stretch", "static"])?;
    if kind != "stretch" {
        table.refuse(&["origin"], "goes with `stretch` only")?;
    }
    if kind == "static" {
        table.refuse(
            &["group", "where"],
            "does not go with `static`, which moves the whole body",
        )?;
    }
    let group = selections.optional(table, Members::Nodes)?;
    Ok(match kind {
        "displacement" => Initial::Displacement {
            group,
            value: table.required("displacement", "[x, y, z] in m, all finite", vector)?,
        },
        "velocity" => Initial::Velocity {
            group,
            value: table.required("velocity", "[x, y, z] in m/s, all finite", vector)?,
        },
        "stretch" => Initial::Stretch {
            group,
            strain: table.required("stretch", "strains [x, y, z], all finite", vector)?,
            origin: table
                .optional("origin", "[x, y, z] in m, all finite", vector)?
                .unwrap_or_default(),
        },
        _ => static_state(table, known)?,
    })
}

fn static_state(table: &Table<'_>, known: &[String]) -> Result<Initial, SceneError> {
    let names = |value: &toml::de::DeValue<'_>| match list(value, text)? {
        names if names.is_empty() => Err(Misfit::Value),
        names => Ok(names),
    };
    let loads = table.required("static", "a list of names of loads", names)?;
    let unknown = loads.iter().find(|name| !known.contains(name));
    if let Some(name) = unknown {
        let fault = Fault::UnknownLoad {
            name: name.clone(),
            known: known.to_vec(),
        };
        return Err(table.place().value_fault("static", fault));
    }
    Ok(Initial::Static { loads })
}
