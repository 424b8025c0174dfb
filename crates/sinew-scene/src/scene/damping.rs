//! `[damping]`: D = alpha M + beta K.

use sinew_fem::Rayleigh;

use crate::decode::Table;
use crate::decode::value::zero_or_above;
use crate::error::SceneError;

pub(super) const KEYS: &[&str] = &["mass", "stiffness"];

pub(super) fn read(table: &Table<'_>) -> Result<Rayleigh, SceneError> {
    let rate = |key, expected| Ok(table.optional(key, expected, zero_or_above)?.unwrap_or(0.0));
    Ok(Rayleigh {
        mass: rate("mass", "a finite rate, 0 1/s or above")?,
        stiffness: rate("stiffness", "a finite time, 0 s or above")?,
    })
}
