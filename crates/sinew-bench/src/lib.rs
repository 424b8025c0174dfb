//! Cases x integrators x steps: error, cost and stability verdicts, as JSON, tables, SVG and HTML.
//!
//! [`Bench`] goes through all combinations, measuring each as [`sinew_measure`] does; [`report`] shows
//! the [`results`]; [`mod@beside`] compares our costs with another program's.

mod bench;
pub mod beside;
pub mod hands;
pub mod hard;
pub mod kernels;
mod machine;
mod median;
pub mod nonlinear;
pub mod peers;
mod planned;
mod pressed;
pub mod report;
pub mod reproduce;
pub mod results;
pub mod scale;
mod tissue;
pub mod verify;

pub use sinew_scene::output;

pub use bench::{Bench, BenchError, Progress, default_steps, scene_files};
pub use machine::{machine, revision};
