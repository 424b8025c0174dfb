//! Reference solutions, against which runs are measured.
//!
//! A linear system under loads that are smooth between breakpoints is solved by its Taylor series
//! in time, to rounding; no method under test is involved.

mod error_norm;
mod peak;
mod taylor;
mod track;

pub use error_norm::ErrorNorm;
pub use taylor::Taylor;
pub(crate) use track::{LateRange, Pace, follow_at};
pub use track::{ReferenceError, Track, follow};
