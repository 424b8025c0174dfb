//! Error of single precision.

use sinew_core::System;

/// Error (relative) of a run in single precision for any body: rounding in recurrences of some hundred
/// sweeps.
pub const LEAST_F32_ROUNDING: f64 = 5e-5;

/// Error over the rounding of a stiffness entry. A body resists slow motions by shear, and entries are as large as its
/// stiffness against compression: their rounding moves frequencies by its share of the smaller stiffness. On cubes of 5
/// to 20 cells with nu from .3 to .499, 4 to 10 were measured after an undamped second, and up to 31 if polynomials of
/// 20 sweeps are summed.
const PER_ENTRY: f64 = 25.0;

/// The error (relative) of displacements to be expected after some periods in single precision; the smallest value for
/// a system that does not know its materials.
pub(crate) fn f32_rounding(system: &dyn System) -> f64 {
    let contrast = system.stiffness_contrast().unwrap_or(1.0);
    let rounding = 0.5 * f64::from(f32::EPSILON);
    LEAST_F32_ROUNDING.max(PER_ENTRY * contrast * rounding)
}
