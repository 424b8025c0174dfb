//! Reference solutions, against which runs are measured.
//!
//! A linear system under loads that are smooth between breakpoints is solved by its Taylor series in time, to rounding.
//! If that costs too much, Faber series of its exponential solve it in a twentieth of the products, and the Taylor
//! series checks parts. No method under test is involved. Force laws are solved by a method of order 4 with halved
//! steps and extrapolation, and by one of order 2 as a check.

mod error_norm;
mod expansion;
mod extrapolated;
mod faber;
mod follow;
mod peak;
mod spot_checks;
mod taylor;
mod track;

pub use error_norm::ErrorNorm;
pub(crate) use expansion::Expansion;
pub(crate) use extrapolated::cost_of_extrapolation;
pub(crate) use follow::{Course, Pace, follow_by};
pub use follow::{follow, follow_affordably};
pub use taylor::Taylor;
pub(crate) use track::{LateRange, TOLD_APART};
pub use track::{ReferenceError, ReferenceMethod, Track};

use sinew_core::LinearOperators;

/// Largest angular frequency (rad/s) of the loads' factors, 0 if none is a sine.
fn fastest_turn(operators: &LinearOperators) -> f64 {
    let rates = operators.loads().iter();
    let rates = rates.filter_map(|load| load.ramp.angular_frequency());
    rates.fold(0.0, f64::max)
}
