//! VTK's XML files, for ParaView and pyvista: `.vtu` for a mesh with data, read and written, `.pvd` for a series of
//! them.
//!
//! ```
//! use sinew_mesh::vtu::{Array, Grid, VtuEncoding, write_pvd, write_vtu_grid};
//! use sinew_mesh::structured;
//!
//! let mesh = structured::cube(2, 0.1, structured::Split::Kuhn)?;
//! let displacement = vec![[0.0, 0.0, 1e-3]; mesh.points.len()];
//! let grid = Grid {
//!     point_data: vec![Array::of_vectors("displacement", &displacement)],
//!     ..Grid::of(&mesh)
//! };
//! let mut file = Vec::new();
//! write_vtu_grid(&grid, VtuEncoding::RawAppended, &mut file)?;
//!
//! let mut series = Vec::new();
//! write_pvd(&[(0.0, "frame-0.vtu"), (0.02, "frame-1.vtu")], &mut series)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod base64;
mod error;
mod grid;
mod of_mesh;
mod out;
mod reading;
mod series;
mod write;

pub use error::WriteVtuError;
pub use grid::{Array, Grid, Values};
pub use of_mesh::write_vtu;
pub use out::VtuEncoding;
pub use reading::read_vtu;
pub use series::write_pvd;
pub use write::write_vtu_grid;
