//! `[oscillator]`: one mass on a spring and a dashpot, instead of a body.

use crate::decode::{Key, Needs, Number, Or, Table, TableDescription};
use crate::error::SceneError;

/// One mass on a spring and a dashpot: m u'' + d u' + k u = f from u(0), u'(0).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oscillator {
    /// m (kg).
    pub mass: f64,
    /// k (N/m).
    pub stiffness: f64,
    /// d (N s/m).
    pub damping: f64,
    /// u(0) (m).
    pub displacement: f64,
    /// u'(0) (m/s).
    pub velocity: f64,
    /// f (N) from t = 0 on.
    pub force: f64,
}

pub(super) const OSCILLATOR: TableDescription = TableDescription {
    name: "oscillator",
    meaning: "One mass on a spring and a dashpot, in place of a body: m u'' + d u' + k u = f. Its exact motion is known, \
              so it shows what a method does.",
    keys: &[
        &MASS,
        &STIFFNESS,
        &DAMPING,
        &DISPLACEMENT,
        &VELOCITY,
        &FORCE,
    ],
    needs: Needs::Any,
    examples: &[
        "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\ndisplacement = 0.01\nvelocity = -5.0\nforce = 0.5\n",
    ],
};

const MASS: Key<Number> = Key::required(
    "mass",
    "The mass m.",
    Number::above_zero("a finite mass above 0 kg"),
)
.unit("kg");

const STIFFNESS: Key<Number> = Key::required(
    "stiffness",
    "The stiffness k of the spring.",
    Number::above_zero("a finite stiffness above 0 N/m"),
)
.unit("N/m");

const DAMPING: Key<Number> = Key::required(
    "damping",
    "The damping d of the dashpot.",
    Number::zero_or_above("a finite damping, 0 N s/m or above"),
)
.unit("N s/m");

const DISPLACEMENT: Key<Number, Or<f64>> = Key::or(
    "displacement",
    "The displacement u at t = 0.",
    Number::finite("a finite length in m"),
    0.0,
)
.unit("m");

const VELOCITY: Key<Number> = Key::required(
    "velocity",
    "The velocity u' at t = 0.",
    Number::finite("a finite velocity in m/s"),
)
.unit("m/s");

const FORCE: Key<Number, Or<f64>> = Key::or(
    "force",
    "The force f, which acts from t = 0 on.",
    Number::finite("a finite force in N"),
    0.0,
)
.unit("N");

impl Oscillator {
    pub(super) fn read(table: &Table<'_>) -> Result<Self, SceneError> {
        let displacement = table.read(&DISPLACEMENT)?;
        let force = table.read(&FORCE)?;
        Ok(Self {
            mass: table.read(&MASS)?,
            stiffness: table.read(&STIFFNESS)?,
            damping: table.read(&DAMPING)?,
            displacement,
            velocity: table.read(&VELOCITY)?,
            force,
        })
    }
}
