//! Bodies of one material.

use sinew_fem::{Fixed, Law, Problem, Region};

/// Density of soft tissue (kg/m^3).
pub(crate) const DENSITY: f64 = 1060.0;

pub(crate) fn linear(youngs_modulus: f64, poissons_ratio: f64) -> Law {
    Law::linear(youngs_modulus, poissons_ratio)
}

/// A free body without loads.
pub(crate) fn body(law: Law) -> Problem {
    Problem::of([Region::new(law, DENSITY)])
}

/// A group fixed along these axes.
pub(crate) fn held(group: &str, axes: [bool; 3]) -> Fixed {
    Fixed::at(group).along(axes)
}
