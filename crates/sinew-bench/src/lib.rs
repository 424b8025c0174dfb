//! Cases x integrators x steps: error, cost and stability verdicts, as JSON, tables, SVG and HTML.
//!
//! [`Bench`] measures all combinations by [`sinew_measure`]; [`report`] shows
//! the [`results`]; [`mod@beside`] compares our costs with another program's.

mod bench;
pub mod beside;
pub mod hands;
pub mod hard;
pub mod kernels;
mod median;
pub mod nonlinear;
pub mod peers;
mod plain_table;
mod planned;
mod pressed;
pub mod report;
pub mod reproduce;
pub mod results;
pub mod scale;
mod timed;

pub use timed::TimedRunError;

pub use bench::{Bench, BenchError, default_steps, scene_files};
