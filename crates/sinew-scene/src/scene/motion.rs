//! `[[move]]`: parts of the body that are moved.

use std::path::PathBuf;

use sinew_core::Ramp;

use super::fixed::AXES;
use super::ramp::{self, RAMP};
use super::selected::{GROUP, Members, Selections, WHERE};
use crate::decode::{Condition, Inner, Key, Needs, Place, Table, TableDescription, Text, Vector};
use crate::error::SceneError;

/// A part of the body that is moved.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// The group whose nodes are moved.
    pub group: String,
    /// True for each of x, y and z that is prescribed; the other directions stay free.
    pub axes: [bool; 3],
    /// The prescribed motion.
    pub way: Way,
    /// The CSV file of the factor of a displacement, as written, if it is in one. `way` has the factor after the scene
    /// is built.
    pub ramp_file: Option<PathBuf>,
}

/// The motion of a part, relative to rest.
#[derive(Debug, Clone, PartialEq)]
pub enum Way {
    /// A displacement (m) times a ramp.
    Displacement([f64; 3], Ramp),
    /// A motion at this velocity (m/s) from t = 0 on.
    Velocity([f64; 3]),
    /// Straight lines between the rows of a CSV file: its path as written, relative to the scene's folder.
    Table(PathBuf),
}

impl Way {
    /// The key that gives it.
    pub(crate) fn key(&self) -> &'static str {
        match self {
            Self::Displacement(..) => DISPLACEMENT.name,
            Self::Velocity(_) => VELOCITY.name,
            Self::Table(_) => TABLE.name,
        }
    }
}

pub(super) const MOVE: TableDescription = TableDescription {
    name: "move",
    meaning: "A part of the body whose motion is given, such as the tissue that a tool holds. The force that it takes is \
              among the reactions of a run.",
    keys: &[
        &GROUP,
        &WHERE,
        &AXES,
        &DISPLACEMENT,
        &VELOCITY,
        &TABLE,
        &RAMP_OF_MOTION,
    ],
    needs: Needs::OneOf(&[DISPLACEMENT.name, VELOCITY.name, TABLE.name]),
    examples: &[
        "[[move]]\ngroup = \"top\"\naxes = \"z\"\ndisplacement = [0.0, 0.0, -0.01]\nramp = { kind = \"sin2\", rise = 0.2 }\n",
        "[[move]]\nwhere = { above = { z = 0.199 } }\nvelocity = [0.01, 0.0, 0.0]\n",
        "[[move]]\ngroup = \"top\"\ntable = \"tool.csv\"\n",
    ],
};

const DISPLACEMENT: Key<Vector> = Key::required(
    "displacement",
    "Displacement from the place at rest, times the ramp.",
    Vector::finite("[x, y, z] in m, all finite"),
)
.unit("m");

const VELOCITY: Key<Vector> = Key::required(
    "velocity",
    "Velocity from t = 0 on.",
    Vector::finite("[x, y, z] in m/s, all finite"),
)
.unit("m/s");

pub(super) const TABLE: Key<Text> = Key::required(
    "table",
    "CSV file with the columns `t_s`, `x_m`, `y_m`, `z_m`: displacements from the place at rest over time, with straight \
     lines between the rows. Its path is relative to the scene's folder.",
    Text::any("the path of a CSV file, seen from the scene"),
);

pub(super) const RAMP_OF_MOTION: Key<Inner> = Key::required(
    "ramp",
    "Factor of the displacement over time.",
    Inner::one("a table such as { kind = \"sin2\", rise = 0.2 }", &RAMP),
)
.only(&[Condition::with(
    DISPLACEMENT.name,
    "goes with `displacement` only",
)]);

pub(super) fn read_all(
    tables: Vec<Table<'_>>,
    selections: &mut Selections,
) -> Result<(Vec<Motion>, Vec<Place>), SceneError> {
    let motions = tables.iter().map(|table| read(table, selections));
    let motions = motions.collect::<Result<_, _>>()?;
    Ok((motions, tables.into_iter().map(Table::into_place).collect()))
}

fn read(table: &Table<'_>, selections: &mut Selections) -> Result<Motion, SceneError> {
    let way = table.exactly_one()?;
    table.check_conditions()?;
    let (group, axes) = (
        selections.one_of(table, (&GROUP, &WHERE), Members::Nodes)?,
        table.read(&AXES)?,
    );
    let (way, ramp_file) = match way {
        key if key == DISPLACEMENT.name => {
            let displacement = table.read(&DISPLACEMENT)?;
            let factor = ramp::read(&table.table(&RAMP_OF_MOTION)?)?;
            (Way::Displacement(displacement, factor.ramp), factor.file)
        }
        key if key == VELOCITY.name => (Way::Velocity(table.read(&VELOCITY)?), None),
        _ => (Way::Table(table.read(&TABLE)?.into()), None),
    };
    Ok(Motion {
        group,
        axes,
        way,
        ramp_file,
    })
}
