//! Cuts through bodies of tetrahedra.
//!
//! A blade, a segment, sweeps a [`Sheet`] from one pose to the next through tissue that may move at the same time.
//! [`CuttableBody::stroke`] moves nodes near it onto it, cuts the faces that are nearest to it, and splits their nodes
//! (Nienhuys and van der Stappen, A surgery simulation supporting cuts and finite element deformation, MICCAI 2001). No
//! tetrahedron is created, so mass is conserved, and no stable step falls below the bound of the single tetrahedra.
//! [`CuttableBody::remove`] removes tetrahedra with their mass.
//!
//! ```
//! use sinew_cutting::{CuttableBody, Sheet, TetProperties};
//! use sinew_mesh::structured::{self, Split};
//!
//! struct Water;
//! impl TetProperties for Water {
//!     fn density(&self, _: usize) -> f64 {
//!         1000.0 // kg/m3
//!     }
//!     fn frequency(&self, _: usize, _: &[[f64; 3]; 4]) -> f64 {
//!         0.0 // nothing to be bounded
//!     }
//! }
//!
//! let mesh = structured::cube(4, 0.1, Split::Kuhn)?;
//! let mut body = CuttableBody::new(&mesh, Box::new(Water))?;
//! let mut positions = mesh.points.clone();
//! // A blade along y comes down through the middle.
//! let blade = |z: f64| [[0.05, -0.01, z], [0.05, 0.11, z]];
//! let sheet = Sheet::swept(blade(0.11), blade(-0.01)).ok_or("it has an area")?;
//! let stroke = body.stroke(&sheet, &mut positions, 0.25)?;
//! assert_eq!((stroke.faces.len(), stroke.copied.len()), (32, 25));
//! assert!((stroke.area - 0.01).abs() < 1e-15);
//! assert_eq!(body.pieces().count, 2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod around;
mod body;
mod course;
mod cut;
mod drift;
mod error;
mod flat;
mod incidence;
mod marks;
mod near;
mod passed;
mod pieces;
mod properties;
mod remove;
mod report;
mod rough;
mod saved;
mod seen;
mod sheet;
mod snap;
mod split;
mod strokes;
mod swept;
mod tet;
mod touch;
mod uncut;

pub use body::{CuttableBody, spare_nodes};
pub use error::CutError;
pub use pieces::Pieces;
pub use properties::TetProperties;
pub use report::{Removal, Stroke};
pub use rough::{Chips, Missed};
pub use saved::{SavedBody, SavedBodyError};
pub use sheet::Sheet;
pub use snap::FREQUENCY_GROWTH;
pub use strokes::{BladeAct, BladePose, Strokes, StrokesError};
pub use uncut::Uncut;
