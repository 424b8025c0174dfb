//! The one door through which commands write: what a path may name, and how it is written.
//!
//! A [`Destination`] is a path that was checked before the work began; [`Destination::open`] makes
//! an [`Output`] of it. A file is written beside its own name and renamed when it is whole; devices,
//! pipes and standard output are written to as they are. Everything else is refused, and so are the
//! files that a run reads.

mod destination;
mod error;
mod folder;
mod identity;
mod place;
mod stream;
mod voice;
mod whole_file;

pub use destination::{Delivery, Destination, Output};
pub use error::OutputError;
pub use folder::OutputFolder;
pub use voice::{Voice, complain, say};

#[cfg(test)]
mod tests;
