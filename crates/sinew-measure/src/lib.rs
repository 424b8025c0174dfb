//! One run on a scene, measured: its error against a reference, its verdicts, its work and its cost.
//!
//! A [`Case`] is a scene with its reference solution; [`measure()`] produces one [`Row`] of a run on it,
//! [`measure_with()`] the same for an integrator that is not in the list of the workspace. [`search`] finds the
//! cheapest runs for an error without measuring them all; [`advise()`] uses it to find the method and step that a scene
//! should take; [`converge()`] estimates the error of its mesh.

pub mod advice;
mod case;
pub mod convergence;
mod cost;
mod cpu_time;
mod deformation;
mod forecast;
mod growth;
mod measure;
mod method_choice;
pub mod number;
mod one_thread;
pub mod reference;
mod row;
pub mod search;
mod timing;

pub use advice::{Advice, AdviceError, Answer, LeftOut, NotMeasured, Question, advise};
pub use case::{Case, CaseError, Span};
pub use convergence::converge;
pub use cost::Cost;
pub use cpu_time::{CostSince, process_cpu_time, thread_cpu_time};
pub use forecast::{Forecast, ForecastError};
pub use measure::{MeasureError, measure, measure_with};
pub use method_choice::{MethodChoice, MethodError};
pub use one_thread::{ThreadError, on_one_thread};
pub use row::{ACCURATE, CaseInfo, Gap, Row, RowOutcome, RowVerdict, Work, finite, mark_pareto};
pub use timing::Effort;
