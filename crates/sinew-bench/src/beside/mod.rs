//! Our methods in turn with another program on the same matrices: paired ratios of CPU time.
//!
//! Times of two programs compare only when both ran on the same machine in the same minute. Each
//! lap of ours therefore follows a lap of the other one, and their ratio counts, not their times.
//! [`simulators`] have laws and methods of their own: each is held against a fine run of its law.

mod export;
pub mod factor;
mod laps;
mod pilots;
pub mod simulators;
mod table;

pub use export::{ExportError, Exported, export};
pub use laps::{Beside, Pair, Rival, RivalError, Rounds, run_beside};
pub use pilots::{Target, pilots};
