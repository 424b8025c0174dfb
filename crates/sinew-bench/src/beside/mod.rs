//! Our methods in turn with another program on the same matrices: paired ratios of CPU time.
//!
//! Times of two programs compare only when both ran on the same machine in the same minute. Each
//! lap of ours therefore follows a lap of the other one, and their ratio counts, not their times.

mod export;
pub mod factor;
mod laps;
mod pilots;
mod table;

pub use export::{ExportError, Exported, export};
pub use laps::{Beside, Pair, Rival, RivalError, Rounds, run_beside};
pub use pilots::{Target, pilots};
