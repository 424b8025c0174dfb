//! Every figure that the library is held to: closed forms, figures in print, independent computations. Each is asked for with
//! a tolerance and a source, computed anew, and passes or fails.
//!
//! A subject is a file under `subjects` with a list of checks, each a function that computes one or more figures.

pub(crate) mod bodies;
mod check;
pub mod closed_forms;
mod error;
mod inputs;
mod kinds;
pub(crate) mod modes;
mod motion;
mod page;
pub(crate) mod places;
mod pressed;
mod quadrature;
mod quasi_static;
pub(crate) mod reference;
mod results;
mod run;
mod sources;
mod staggered_energy;
mod subject;
mod subjects;
mod text;
mod vector;
mod write;

pub use check::{Asked, Source};
pub use error::VerifyError;
pub use results::{SCHEMA, Verification, VerifiedRow, VerifiedSubject};
pub use run::{UnknownSubject, VerifyPlan};
pub use subject::Quoted;
pub use write::{WriteVerificationError, WrittenVerification};
