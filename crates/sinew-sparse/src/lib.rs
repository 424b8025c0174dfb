//! Block-sparse matrices on a fixed symmetric pattern.
//!
//! A [`Pattern`] lists the neighbours of cells; a [`BlockMatrix`] stores one dense block per
//! neighbour pair: 3x3 for a network of three coupled layers (x, y, z), 1x1 for a one-layer network.
//! Vectors are node-major: the `layers` entries of cell 0, then those of cell 1, and so on.
//!
//! The storage order is private; assembly, block access, products and block sparse rows
//! ([`BlockMatrix::to_bsr`]) are the contract.
//!
//! ```
//! use std::sync::Arc;
//! use sinew_sparse::{BlockMatrix, Layers, Pattern};
//!
//! // Two cells joined by a spring of 2 N/m, one degree of freedom each.
//! let pattern = Arc::new(Pattern::from_elements(2, [[0, 1]])?);
//! let mut stiffness = BlockMatrix::zeros(pattern, Layers::One);
//! stiffness.add_element(&[0, 1], &[2.0, -2.0, -2.0, 2.0])?;
//!
//! let mut force = [0.0; 2];
//! stiffness.multiply(&[0.5, 0.0], &mut force);
//! assert_eq!(force, [1.0, -1.0]);
//! # Ok::<(), sinew_sparse::AssemblyError>(())
//! ```

mod bsr;
mod error;
mod incidence;
mod matrix;
pub mod ordering;
mod pattern;
mod product;
mod rows_of_cells;
pub mod simd;
pub mod sweep;
pub mod vectors;

pub use bsr::Bsr;
pub use error::AssemblyError;
pub use matrix::{BlockMatrix, Layers};
pub use pattern::Pattern;
pub use rows_of_cells::RowsOfCells;
pub use sweep::clamp_vector;
