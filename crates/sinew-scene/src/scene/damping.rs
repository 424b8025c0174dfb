//! `[damping]`: D = alpha M + beta K.

use sinew_fem::Rayleigh;

use crate::decode::{Key, Needs, Number, Or, Table, TableDescription};
use crate::error::SceneError;

pub(super) const DAMPING: TableDescription = TableDescription {
    name: "damping",
    meaning: "Damping of the whole body in proportion to its mass and its stiffness: D = `mass` M + `stiffness` K, as \
              Rayleigh has it; in large deformation `stiffness` damps the rate of Green's strain by the stiffness at rest, so that turns \
              are not damped. Springs may have dashpots besides, see `damping_ratio`.",
    keys: &[&MASS, &STIFFNESS],
    needs: Needs::Any,
    examples: &["[damping]\nmass = 80.0\nstiffness = 1e-4\n"],
};

const MASS: Key<Number, Or<f64>> = Key::or(
    "mass",
    "Factor of the mass matrix. Slow and fast motions lose their speed at the same rate.",
    Number::zero_or_above("a finite rate, 0 1/s or above"),
    0.0,
)
.unit("1/s");

const STIFFNESS: Key<Number, Or<f64>> = Key::or(
    "stiffness",
    "Factor of the stiffness matrix. The faster a motion, the more it is damped; explicit methods then need shorter steps.",
    Number::zero_or_above("a finite time, 0 s or above"),
    0.0,
)
.unit("s");

pub(super) fn read(table: &Table<'_>) -> Result<Rayleigh, SceneError> {
    Ok(Rayleigh {
        mass: table.read(&MASS)?,
        stiffness: table.read(&STIFFNESS)?,
    })
}
