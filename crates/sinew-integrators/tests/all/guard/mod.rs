//! The guard.

mod saturation;
mod sound_runs;
