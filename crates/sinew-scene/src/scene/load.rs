//! `[[load]]`: forces on the body.

use std::path::PathBuf;

use sinew_core::Ramp;
use sinew_fem::{LoadKind, LoadSpec, On};

use super::ramp::{self, RAMP};
use super::region::taken;
use super::selected::{GROUP, Members, Selections, WHERE};
use crate::decode::{
    Condition, Flag, Inner, Key, Needs, Number, Optional, Place, Table, TableDescription, Text,
    Usual, Vector,
};
use crate::error::{Fault, SceneError};
use crate::keys::GRAVITY;

pub(super) const LOAD: TableDescription = TableDescription {
    name: "load",
    meaning: "A force on a part of the body.",
    keys: &[
        &NAME,
        &GROUP,
        &WHERE,
        &TRACTION,
        &PRESSURE,
        &FOLLOW,
        &FORCE,
        &RAMP_OF_LOAD,
    ],
    needs: Needs::OneOf(&[TRACTION.name, PRESSURE.name, FORCE.name]),
    examples: &[
        "[[load]]\nname = \"press\"\ngroup = \"top\"\ntraction = [0.0, 0.0, -500.0]\nramp = { kind = \"sin2\", rise = 0.2 }\n",
        "[[load]]\ngroup = \"top\"\npressure = 2000.0\nfollow = false\n",
        "[[load]]\nwhere = { sphere = { center = [0.1, 0.1, 0.2], radius = 0.02 } }\nforce = [0.0, 0.0, -1.5]\n",
    ],
};

const NAME: Key<Text, Optional> = Key::optional(
    "name",
    "A unique name, by which `[[initial]]` can call the load.",
    Text {
        except: Some(GRAVITY),
        ..Text::any("a name other than \"gravity\"")
    },
    "the load has no name",
);

const TRACTION: Key<Vector> = Key::required(
    "traction",
    "Force on each square metre of a surface.",
    Vector::finite("[x, y, z] in Pa, all finite"),
)
.unit("Pa");

const PRESSURE: Key<Number> = Key::required(
    "pressure",
    "Force on each square metre of a surface against its outward normal: it pushes where it is above 0.",
    Number::finite("a finite number of Pa"),
)
.unit("Pa");

const FOLLOW: Key<Flag, Optional> = Key::optional(
    "follow",
    "Whether the pressure follows the surface as it deforms: against the normal and on the area that it has then. On linear regions, whose \
     shape is that at rest, it never does.",
    Flag,
    "it follows on regions of large deformation",
)
.only(&[Condition::with(PRESSURE.name, "goes with `pressure` only")]);

const FORCE: Key<Vector> = Key::required(
    "force",
    "Total force, in equal parts on the nodes of the part that are not fixed.",
    Vector::finite("[x, y, z] in N, all finite"),
)
.unit("N");

pub(super) const RAMP_OF_LOAD: Key<Inner, Usual> = Key::usual(
    "ramp",
    "Factor of the load over time.",
    Inner::one("a table such as { kind = \"sin2\", rise = 0.2 }", &RAMP),
    "{ kind = \"step\" }",
);

/// The tables `[[load]]`, in the order of the file.
pub(super) struct LoadTables {
    /// The loads.
    pub(super) specs: Vec<LoadSpec>,
    /// The CSV file of the factor of each, if it is in one.
    pub(super) files: Vec<Option<PathBuf>>,
    /// The name of each, if it has one.
    pub(super) names: Vec<Option<String>>,
    /// The place of each in the text.
    pub(super) places: Vec<Place>,
}

/// Reads all loads of a body; `is_large` is true if some region has large deformation.
pub(super) fn read_all(
    tables: Vec<Table<'_>>,
    is_large: bool,
    selections: &mut Selections,
) -> Result<LoadTables, SceneError> {
    let (mut specs, mut files) = (Vec::new(), Vec::new());
    for table in &tables {
        let (spec, file) = read(table, is_large, selections)?;
        specs.push(spec);
        files.push(file);
    }
    let mut names: Vec<Option<String>> = Vec::new();
    for table in &tables {
        let name = table.read(&NAME)?;
        let same = name
            .as_ref()
            .and_then(|_| names.iter().position(|other| *other == name));
        if let (Some(first), Some(name)) = (same, &name) {
            return Err(taken(table.place(), NAME.name, name, tables[first].place()));
        }
        names.push(name);
    }
    let places = tables.into_iter().map(Table::into_place).collect();
    Ok(LoadTables {
        specs,
        files,
        names,
        places,
    })
}

fn read(
    table: &Table<'_>,
    is_large: bool,
    selections: &mut Selections,
) -> Result<(LoadSpec, Option<PathBuf>), SceneError> {
    let kind = match table.exactly_one()? {
        key if key == TRACTION.name => LoadKind::Traction(table.read(&TRACTION)?),
        key if key == FORCE.name => LoadKind::Force(table.read(&FORCE)?),
        _ => pressure(table, is_large)?,
    };
    table.check_conditions()?;
    let members = match kind {
        LoadKind::Force(_) => Members::Nodes,
        LoadKind::Traction(_) | LoadKind::Pressure(_) | LoadKind::FollowingPressure(_) => {
            Members::Triangles
        }
    };
    let group = selections.one_of(table, (&GROUP, &WHERE), members)?;
    let ramp = table.table(&RAMP_OF_LOAD)?;
    let factor = match &ramp {
        Some(ramp) => ramp::read(ramp)?,
        None => Ramp::Step.into(),
    };
    let spec = LoadSpec::new(On::Group(group), kind).with_ramp(factor.ramp);
    Ok((spec, factor.file))
}

fn pressure(table: &Table<'_>, is_large: bool) -> Result<LoadKind, SceneError> {
    let (pressure, follow) = (table.read(&PRESSURE)?, table.read(&FOLLOW)?);
    if follow == Some(true) && !is_large {
        let reason = "needs a region of large deformation, such as `model = \"neo-hookean\"`";
        let fault = Fault::Misplaced {
            key: FOLLOW.name,
            reason: reason.into(),
        };
        return Err(table.place().key_fault(FOLLOW.name, fault));
    }
    Ok(match is_large && follow.unwrap_or(true) {
        true => LoadKind::FollowingPressure(pressure),
        false => LoadKind::Pressure(pressure),
    })
}
