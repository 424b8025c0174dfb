//! `body` of `[[tool]]`: tools that are dynamic bodies.

use std::ops::Bound;

use sinew_tools::ToolBody;

use crate::decode::{Key, Needs, Number, Or, Table, TableDescription, Vector};
use crate::error::SceneError;

pub(super) const BODIES: TableDescription = TableDescription {
    name: "tool-body",
    meaning: "A tool as a rigid body on a spring and a damper to its path. Its own origin is its centre of mass. It begins on its path, with the velocity of the path.",
    keys: &[&MASS, &INERTIA, &COUPLING, &ROTATIONAL_COUPLING, &DAMPING],
    needs: Needs::Any,
    examples: &[
        "{ mass = 0.05, inertia = [2e-6, 2e-6, 2e-6], coupling = 400.0, rotational_coupling = 0.5, damping = 0.8 }",
    ],
};

const MASS: Key<Number> = Key::required(
    "mass",
    "The mass.",
    Number::between(
        "a mass from 1e-15 kg to 1e15 kg",
        Bound::Included(1e-15),
        Bound::Included(1e15),
    ),
)
.unit("kg");

const INERTIA: Key<Vector> = Key::required(
    "inertia",
    "Moments of inertia about its own axes through its own origin; of no body is one larger than the sum of the other two.",
    Vector {
        expected: "[x, y, z] in kg m^2, all from 1e-30 to 1e15 and none larger than the sum of the other two, as it is for every body",
        of: Number::between(
            "a moment of inertia from 1e-30 kg m^2 to 1e15 kg m^2",
            Bound::Included(1e-30),
            Bound::Included(1e15),
        ),
        fits: |inertia| ToolBody::has(*inertia),
    },
)
.unit("kg m^2");

const COUPLING: Key<Number> = Key::required(
    "coupling",
    "Stiffness of the spring between its own origin and the path; 0 lets it fly.",
    Number::between(
        "a stiffness from 0 N/m to 1e15 N/m",
        Bound::Included(0.0),
        Bound::Included(1e15),
    ),
)
.unit("N/m");

const ROTATIONAL_COUPLING: Key<Number> = Key::required(
    "rotational_coupling",
    "Stiffness of the spring between its rotation and that of the path, which knows angles below half a turn alone; 0 lets it turn.",
    Number::between(
        "a stiffness from 0 N m/rad to 1e15 N m/rad",
        Bound::Included(0.0),
        Bound::Included(1e15),
    ),
)
.unit("N m/rad");

const DAMPING: Key<Number, Or<f64>> = Key::or(
    "damping",
    "Damping of both springs, as a share of what just keeps the tool by itself from swinging.",
    Number::between(
        "a share from 0 to 1e6",
        Bound::Included(0.0),
        Bound::Included(1e6),
    ),
    1.0,
);

pub(super) fn read(table: &Table<'_>) -> Result<ToolBody, SceneError> {
    Ok(ToolBody {
        mass: table.read(&MASS)?,
        inertia: table.read(&INERTIA)?,
        coupling: table.read(&COUPLING)?,
        rotational_coupling: table.read(&ROTATIONAL_COUPLING)?,
        damping: table.read(&DAMPING)?,
    })
}
