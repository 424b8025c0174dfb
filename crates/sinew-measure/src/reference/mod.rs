//! Reference solutions, against which runs are measured.
//!
//! A linear system under loads that are smooth between breakpoints is solved by its Taylor series
//! in time, to rounding; no method under test is involved.

mod peak;
mod taylor;
mod track;

pub use taylor::Taylor;
pub(crate) use track::LateRange;
pub use track::{ErrorNorm, ReferenceError, Track, follow, largest};
