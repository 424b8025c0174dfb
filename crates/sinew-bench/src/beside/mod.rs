//! Our methods alternating with another program on the same matrices: paired ratios of CPU time.
//!
//! Times of two programs are comparable only when both ran on the same machine in the same minute. Each lap of ours
//! therefore follows a lap of the other program, and their ratio counts, not their times. [`simulators`] have their own
//! laws and methods: each is compared with a fine run of its law.

mod export;
pub mod factor;
mod laps;
mod pilots;
pub mod simulators;
mod table;

pub use export::{ExportError, Exported, export};
pub use laps::{Beside, Pair, Rival, RivalError, Rounds, run_beside};
pub use pilots::{Target, pilots};
