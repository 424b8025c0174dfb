//! The top of a scene: its tables and the keys before them.

use super::cutting::CUTTING;
use super::damping::DAMPING;
use super::fixed::FIXED;
use super::initial::INITIAL;
use super::load::LOAD;
use super::mesh::MESH;
use super::motion::MOVE;
use super::oscillator::OSCILLATOR;
use super::output::OUTPUT;
use super::probe::PROBE;
use super::region::REGION;
use super::run::RUN;
use super::tool::TOOL;
use crate::decode::{Condition, Inner, Key, Needs, Optional, TableDescription, Text, Vector};
use crate::keys::GRAVITY;

/// The whole scene.
pub(crate) const DOCUMENT: TableDescription = TableDescription {
    name: "scene",
    meaning: "A scene is a TOML file. `title` and `gravity` stand at its top, before the first table; the tables may follow in any \
              order. All values are in SI units, angles in degrees.",
    keys: &[
        &TITLE,
        &MESH_TABLE,
        &OSCILLATOR_TABLE,
        &REGIONS,
        &DAMPING_TABLE,
        &SUPPORTS,
        &MOTIONS,
        &TOOLS,
        &CUTTING_TABLE,
        &LOADS,
        &GRAVITY_VECTOR,
        &INITIAL_STATES,
        &RUN_TABLE,
        &PROBES,
        &OUTPUT_TABLE,
    ],
    needs: Needs::OneOf(&[MESH_TABLE.name, OSCILLATOR_TABLE.name]),
    examples: &["title = \"A cube under its own weight\"\ngravity = [0.0, 0.0, -9.81]\n"],
};

/// Condition of the keys of a body: not for an oscillator.
const OF_A_BODY: &[Condition] = &[Condition::without(
    OSCILLATOR_TABLE.name,
    "does not go with [oscillator]",
)];

pub(super) const TITLE: Key<Text, Optional> = Key::optional(
    "title",
    "A title for plans and reports.",
    Text::any("a title in quotes"),
    "no title",
);

pub(super) const MESH_TABLE: Key<Inner> = Key::required(
    "mesh",
    "The shape of the body.",
    Inner::one("a table [mesh]", &MESH),
);

pub(super) const OSCILLATOR_TABLE: Key<Inner> = Key::required(
    "oscillator",
    "One mass on a spring, in place of a body.",
    Inner::one("a table [oscillator]", &OSCILLATOR),
);

pub(super) const REGIONS: Key<Inner> = Key::required(
    "region",
    "Materials and the parts of the body that are made of them.",
    Inner::several("a table [[region]] for each material", &REGION),
)
.only(OF_A_BODY);

pub(super) const DAMPING_TABLE: Key<Inner, Optional> = Key::optional(
    "damping",
    "Damping in proportion to mass and stiffness.",
    Inner::one("a table [damping]", &DAMPING),
    "no damping",
)
.only(OF_A_BODY);

pub(super) const SUPPORTS: Key<Inner, Optional> = Key::optional(
    "fixed",
    "Fixed parts.",
    Inner::several("tables [[fixed]]", &FIXED),
    "nothing is fixed",
)
.only(OF_A_BODY);

pub(super) const MOTIONS: Key<Inner, Optional> = Key::optional(
    "move",
    "Parts whose motion is given.",
    Inner::several("tables [[move]]", &MOVE),
    "nothing is moved",
)
.only(OF_A_BODY);

pub(super) const TOOLS: Key<Inner, Optional> = Key::optional(
    "tool",
    "Rigid tools that press on the body.",
    Inner::several("tables [[tool]]", &TOOL),
    "nothing touches the body",
)
.only(OF_A_BODY);

pub(super) const CUTTING_TABLE: Key<Inner, Optional> = Key::optional(
    "cutting",
    "What cuts the body.",
    Inner::one("a table [cutting]", &CUTTING),
    "the body stays whole",
)
.only(OF_A_BODY);

pub(super) const LOADS: Key<Inner, Optional> = Key::optional(
    "load",
    "Forces on parts of the body.",
    Inner::several("tables [[load]]", &LOAD),
    "no forces",
)
.only(OF_A_BODY);

pub(super) const GRAVITY_VECTOR: Key<Vector, Optional> = Key::optional(
    GRAVITY,
    "Acceleration by gravity, from t = 0 on.",
    Vector::finite("[x, y, z] in m/s2, all finite"),
    "no gravity",
)
.unit("m/s2")
.only(OF_A_BODY);

pub(super) const INITIAL_STATES: Key<Inner, Optional> = Key::optional(
    "initial",
    "Displacements and velocities at t = 0.",
    Inner::several("tables [[initial]]", &INITIAL),
    "the body begins at rest",
)
.only(OF_A_BODY);

pub(super) const RUN_TABLE: Key<Inner> = Key::required(
    "run",
    "Duration, method and steps.",
    Inner::one("a table [run]", &RUN),
);

pub(super) const PROBES: Key<Inner, Optional> = Key::optional(
    "probe",
    "Points whose motion is written down.",
    Inner::several("tables [[probe]]", &PROBE),
    "no probes",
)
.only(OF_A_BODY);

pub(super) const OUTPUT_TABLE: Key<Inner, Optional> = Key::optional(
    "output",
    "What a run writes into its folder.",
    Inner::one("a table [output]", &OUTPUT),
    "the defaults of its keys",
);
