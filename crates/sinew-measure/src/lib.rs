//! One run on a scene, measured: its error against a reference, its verdicts, its work and its cost.
//!
//! A [`Case`] is a scene with its reference solution; [`measure()`] makes one [`Row`] of a run on it.
//! [`search`] finds the cheapest runs for an error without measuring them all; [`advise()`] answers
//! with it which method and step a scene should take.

pub mod advice;
mod case;
mod cpu_time;
mod measure;
pub mod number;
mod one_thread;
pub mod reference;
mod row;
pub mod search;

pub use advice::{Advice, AdviceError, Answer, Question, advise};
pub use case::{Case, CaseError, Span};
pub use cpu_time::thread_cpu_time;
pub use measure::{Effort, Method, measure};
pub use one_thread::{ThreadError, on_one_thread};
pub use row::{ACCURATE, CaseInfo, Gap, Outcome, Row, Verdict, Work, finite, mark_pareto};
