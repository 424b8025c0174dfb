//! Sweeps in one pass: the products of a few rows and all operations of a cell with them, before they leave
//! the first cache.
//!
//! A [`Sweep`] is a [`CellMap`] with its matrices. [`Fields`] store the vectors of all cells as
//! structures of arrays, in the order of a [`Numbering`]. Rows are taken in chunks, each by one
//! thread and in the same order of operations for any number of threads, so that the bits do not
//! depend on it.

#![allow(
    clippy::needless_range_loop,
    reason = "kernels count lanes and layers of several arrays at once"
)]

mod chunk;
mod clamp;
mod fields;
mod kernels;
mod lattice;
mod map;
mod numbering;
mod peak;
mod rounding;
mod rows;
mod sell;
mod templates;

pub use chunk::{Outcome, Precision, Sweep};
pub use clamp::clamp_vector;
pub use fields::Fields;
pub use lattice::Lattice;
pub use map::{CellMap, Clamp, Field, Own, Product, Quotient, Update};
pub use numbering::Numbering;
pub use peak::{multiply_adds, read_all};
pub use rows::Rows;
pub use sell::Sell;
pub use templates::Grid;

/// Vectors of positions in a chunk.
pub const CHUNK: usize = 16;
