//! Output of the commands: checks of paths, and safe writing.
//!
//! A [`Destination`] is a path that is checked before the work begins; [`Destination::open`] turns it into an
//! [`Output`]. A file is written under a temporary name and renamed when it is complete; devices, pipes and standard
//! output are written to directly. Everything else is refused, and so are the files that the run reads.

mod destination;
mod error;
mod folder;
mod growing_file;
mod identity;
mod lines;
mod lock_holder;
mod manifest;
mod owned_files;
mod owned_folder;
mod stream;
mod target;
mod voice;
mod whole_file;

pub use destination::{Delivery, Destination, Output};
pub use error::OutputError;
pub use folder::OutputFolder;
pub use growing_file::GrowingFile;
pub use lines::{WIDTH, hanging};
pub use owned_folder::{OwnedFolder, Replaced, Tenant};
pub use voice::{Voice, complain, say};

#[cfg(test)]
mod tests;
