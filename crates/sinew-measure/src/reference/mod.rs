//! Reference solutions, against which runs are measured.
//!
//! A linear system under loads that are smooth between breakpoints is solved by its Taylor series
//! in time, to rounding. Where that costs too much, Faber series of its exponential solve it in a
//! twentieth of the products, and the Taylor series checks parts. No method under test is involved.

mod error_norm;
mod expansion;
mod faber;
mod peak;
mod spot_checks;
mod taylor;
mod track;

pub use error_norm::ErrorNorm;
pub(crate) use expansion::Expansion;
pub use taylor::Taylor;
pub(crate) use track::{Course, LateRange, Pace, TOLD_APART, follow_by};
pub use track::{ReferenceError, ReferenceMethod, Track, follow, follow_affordably};
