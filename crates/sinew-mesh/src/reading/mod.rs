//! The parts that readers of all formats share: a position in the bytes, numbers as text, indices by tag, errors and remarks with their places.

#![deny(
    clippy::indexing_slicing,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic
)]

pub(crate) mod cursor;
mod error;
pub(crate) mod fault;
pub(crate) mod number;
pub(crate) mod remarks;
pub(crate) mod tag_index;

pub use error::MeshError;
