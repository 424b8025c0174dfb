//! `[oscillator]`: one mass on a spring and a dashpot, in place of a body.

use crate::decode::Table;
use crate::decode::value::{above_zero, finite, zero_or_above};
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

pub(super) const KEYS: &[&str] = &[
    "mass",
    "stiffness",
    "damping",
    "displacement",
    "velocity",
    "force",
];

impl Oscillator {
    pub(super) fn read(table: &Table<'_>) -> Result<Self, SceneError> {
        let displacement = table.optional("displacement", "a finite length in m", finite)?;
        let force = table.optional("force", "a finite force in N", finite)?;
        Ok(Self {
            mass: table.required("mass", "a finite mass above 0 kg", above_zero)?,
            stiffness: table.required("stiffness", "a finite stiffness above 0 N/m", above_zero)?,
            damping: table.required(
                "damping",
                "a finite damping, 0 N s/m or above",
                zero_or_above,
            )?,
            displacement: displacement.unwrap_or(0.0),
            velocity: table.required("velocity", "a finite velocity in m/s", finite)?,
            force: force.unwrap_or(0.0),
        })
    }
}
