//! Every required figure of the library: closed forms, figures in print, independent computations. Each has a tolerance
//! and a source, is computed in each run, and passes or fails.
//!
//! A subject is a file under `subjects` with a list of checks, each a function that computes one or more figures.
//! [`VerifyPlan`] computes them. The bench builds on the same bodies ([`bodies`], [`tissue`]), reference elements
//! ([`Tet10`]), verdicts and tables ([`ruled`]).

pub mod bodies;
mod check;
mod closed_forms;
mod error;
mod inputs;
mod kinds;
mod machine;
pub mod modes;
mod motion;
mod page;
pub mod places;
mod pressed;
mod progress;
mod quadrature;
mod quasi_static;
mod reference;
mod results;
pub mod ruled;
mod run;
mod sources;
mod staggered_energy;
mod subject;
mod subjects;
mod text;
pub mod tissue;
mod uniform;
mod vector;
mod verdict;
mod write;

pub use check::{Asked, Source};
pub use error::LabError;
pub use machine::{Machine, machine, revision};
pub use progress::Progress;
pub use reference::tet10::{HeldTet10, Tet10, Tissue};
pub use results::{SCHEMA, Verification, VerifiedRow, VerifiedSubject};
pub use run::{UnknownSubject, VerifyPlan};
pub use subject::Quoted;
pub use verdict::MarkVerdict;
pub use write::{WriteVerificationError, WrittenVerification};
