//! Reference solutions, against which runs are measured.
//!
//! A linear system under loads that are smooth between breakpoints is solved by its Taylor series
//! in time, to rounding; no method under test is involved.

mod taylor;
pub(crate) mod track;

pub use taylor::Taylor;
pub use track::{ReferenceError, Track, follow};
