//! Sweeps in one pass: the products of a few rows and all that a cell does with them, before they leave
//! the first cache.
//!
//! A [`Sweep`] is a [`CellMap`] with its matrices. [`Fields`] hold the vectors of all cells as
//! structures of arrays, in the order of a [`Numbering`]. Rows are taken in chunks, each by one
//! thread and in the same order of operations whatever the number of threads, so that the bits do not
//! depend on it.

mod chunk;
mod clamp;
mod fields;
mod lattice;
mod map;
mod numbering;
mod precision;
mod rows;
mod sell;
mod templates;

pub use chunk::{Outcome, Sweep};
pub use clamp::clamp_vector;
pub use fields::Fields;
pub use lattice::Lattice;
pub use map::{CellMap, Clamp, Field, Own, Product, Quotient, Update};
pub use numbering::Numbering;
pub use precision::Precision;
pub use rows::Rows;
pub use sell::Sell;
pub use templates::Grid;

/// Vectors of positions in a chunk.
pub const CHUNK: usize = 16;
