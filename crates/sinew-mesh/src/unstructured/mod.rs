//! VTK's unstructured grids in `.vtu` and `.vtk` files: types of cells, numbers as bytes, cells as blocks, arrays as
//! data.

#![deny(
    clippy::indexing_slicing,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic
)]

mod cell_types;
mod cells;
mod grid;
mod labels;
mod scalar;

pub(crate) use cell_types::vtk_cell_type;
pub(crate) use cells::Cells;
pub(crate) use grid::{Field, GridBuilder};
pub(crate) use scalar::{ByteOrder, Scalar};
