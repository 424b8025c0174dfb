//! Cases x integrators x steps: error, cost and stability verdicts, as JSON, tables, SVG and HTML.
//!
//! A [`Case`] is a scene with its reference solution; [`measure()`] makes one row of a run on it;
//! [`Bench`] goes through all combinations; [`report`] shows the [`results`]; [`beside`] sets our
//! costs against another program's.

mod bench;
pub mod beside;
mod case;
mod cpu_time;
mod machine;
mod measure;
pub mod peers;
pub mod reference;
pub mod report;
pub mod reproduce;
pub mod results;

pub use bench::{Bench, BenchError, Progress, default_steps};
pub use case::{Case, CaseError};
pub use machine::{machine, revision};
pub use measure::{Effort, Method, measure};
