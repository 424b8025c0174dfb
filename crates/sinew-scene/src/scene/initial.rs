//! `[[initial]]`: displacement and velocity at t = 0.

use super::field::Field;
use super::group_name::GroupName;
use super::selected::{self, Members, Selections, Where};
use crate::decode::{
    Condition, Key, List, Needs, Optional, Or, Place, Table, TableDescription, Text, Vector,
};
use crate::error::{Fault, SceneError};
use crate::formula::Formula;

/// A part of the state at t = 0. If several parts set the same node, the last one counts.
#[derive(Debug, Clone, PartialEq)]
pub enum Initial {
    /// Displacements (m) of the nodes of a group.
    Displacement {
        /// The group; `None` means the whole body.
        group: Option<String>,
        /// Displacement (m) along x, y and z, as formulas of the position at rest.
        value: [Formula; 3],
    },
    /// Velocities (m/s) of the nodes of a group.
    Velocity {
        /// The group; `None` means the whole body.
        group: Option<String>,
        /// Velocity (m/s) along x, y and z, as formulas of the position at rest.
        value: [Formula; 3],
    },
    /// u_i = strain_i (x_i - origin_i) for all nodes of a group.
    Stretch {
        /// The group; `None` means the whole body.
        group: Option<String>,
        /// Strain along x, y, z.
        strain: [f64; 3],
        /// The point that does not move (m).
        origin: [f64; 3],
    },
    /// The displacement of the whole body at rest under loads at their full value.
    Static {
        /// Names of the loads; `gravity` is one if the scene has gravity.
        loads: Vec<String>,
    },
}

impl Initial {
    /// The key that gives it.
    pub(crate) fn key(&self) -> &'static str {
        match self {
            Self::Displacement { .. } => DISPLACEMENT.name,
            Self::Velocity { .. } => VELOCITY.name,
            Self::Stretch { .. } => STRETCH.name,
            Self::Static { .. } => STATIC.name,
        }
    }
}

pub(super) const INITIAL: TableDescription = TableDescription {
    name: "initial",
    meaning: "The state at t = 0, which is at rest without it. Where several tables set the same node, the last one counts.",
    keys: &[
        &GROUP,
        &WHERE,
        &DISPLACEMENT,
        &VELOCITY,
        &STRETCH,
        &ORIGIN,
        &STATIC,
    ],
    needs: Needs::OneOf(&[DISPLACEMENT.name, VELOCITY.name, STRETCH.name, STATIC.name]),
    examples: &[
        "[[initial]]\nstatic = [\"gravity\"]\n",
        "[[initial]]\ngroup = \"top\"\nvelocity = [0.0, 0.0, -0.1]\n",
        "[[initial]]\nwhere = { above = { z = 0.199 } }\ndisplacement = [0.0, 0.0, -0.001]\n",
        "[[initial]]\nvelocity = [\"40 * z * (y - 0.01)\", \"-40 * z * (x - 0.01)\", 0]\n",
        "[[initial]]\nstretch = [0.05, 0.0, 0.0]\norigin = [0.1, 0.1, 0.0]\n",
    ],
};

const NOT_STATIC: Condition = Condition::without(
    "static",
    "does not go with `static`, which moves the whole body",
);

const GROUP: Key<GroupName, Optional> =
    selected::OPTIONAL_GROUP.only(&[selected::NOT_WHERE, NOT_STATIC]);

const WHERE: Key<Where, Optional> = selected::WHERE.only(&[NOT_STATIC]);

const DISPLACEMENT: Key<Field> = Key::required(
    "displacement",
    "Displacement of the nodes of the part: a number along each axis, or a formula of the place x, y, z (m), such as `\"0.5 * z\"`. \
     Formulas have `+ - * / ^`, brackets, `pi`, `sin`, `cos`, `exp`, `sqrt` and `abs`.",
    Field("[x, y, z] in m, each a finite number or a formula of x, y, z in quotes, such as \"0.5 * z\""),
)
.unit("m");

const VELOCITY: Key<Field> = Key::required(
    "velocity",
    "Velocity of the nodes of the part: numbers or formulas, as for `displacement`.",
    Field("[x, y, z] in m/s, each a finite number or a formula of x, y, z in quotes, such as \"0.5 * z\""),
)
.unit("m/s");

const STRETCH: Key<Vector> = Key::required(
    "stretch",
    "Strains along x, y and z: each node is displaced by them times its distance from `origin`.",
    Vector::finite("strains [x, y, z], all finite"),
);

const ORIGIN: Key<Vector, Or<[f64; 3]>> = Key::or(
    "origin",
    "The point that a stretch leaves where it is.",
    Vector::finite("[x, y, z] in m, all finite"),
    [0.0; 3],
)
.unit("m")
.only(&[Condition::with(STRETCH.name, "goes with `stretch` only")]);

const STATIC: Key<List<Text>> = Key::required(
    "static",
    "Names of loads, or `gravity`: the body begins at rest under them, at their full value.",
    List {
        expected: "a list of names of loads",
        of: Text::any("the name of a load"),
        least: 1,
    },
);

/// Reads all parts; a static state may name the `known` loads.
pub(super) fn read_all(
    tables: Vec<Table<'_>>,
    known: &[String],
    selections: &mut Selections,
) -> Result<(Vec<Initial>, Vec<Place>), SceneError> {
    let initial = tables.iter().map(|table| read(table, known, selections));
    let initial = initial.collect::<Result<_, _>>()?;
    Ok((initial, tables.into_iter().map(Table::into_place).collect()))
}

fn read(
    table: &Table<'_>,
    known: &[String],
    selections: &mut Selections,
) -> Result<Initial, SceneError> {
    let kind = table.exactly_one()?;
    table.check_conditions()?;
    let group = selections.at_most_one_of(table, (&GROUP, &WHERE), Members::Nodes)?;
    Ok(match kind {
        key if key == DISPLACEMENT.name => Initial::Displacement {
            group,
            value: table.read(&DISPLACEMENT)?,
        },
        key if key == VELOCITY.name => Initial::Velocity {
            group,
            value: table.read(&VELOCITY)?,
        },
        key if key == STRETCH.name => Initial::Stretch {
            group,
            strain: table.read(&STRETCH)?,
            origin: table.read(&ORIGIN)?,
        },
        _ => static_state(table, known)?,
    })
}

fn static_state(table: &Table<'_>, known: &[String]) -> Result<Initial, SceneError> {
    let loads = table.read(&STATIC)?;
    let unknown = loads.iter().find(|name| !known.contains(name));
    if let Some(name) = unknown {
        let fault = Fault::UnknownLoad {
            name: name.clone(),
            known: known.to_vec(),
        };
        return Err(table.place().value_fault(STATIC.name, fault));
    }
    Ok(Initial::Static { loads })
}
