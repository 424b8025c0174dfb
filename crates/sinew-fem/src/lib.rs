//! From a tetrahedral mesh, materials, supports and loads to a linear system.
//!
//! ```
//! use sinew_core::{Ramp, System};
//! use sinew_fem::{Fixed, Law, LoadKind, LoadSpec, Model, Problem, Region};
//! use sinew_mesh::structured::{self, Split};
//!
//! let mesh = structured::cube(4, 0.1, Split::Kuhn)?;
//! let problem = Problem {
//!     regions: vec![Region {
//!         group: None,
//!         density: 1060.0, // kg/m3
//!         law: Law::Linear { youngs_modulus: 3500.0, poissons_ratio: 0.45 },
//!     }],
//!     fixed: vec![Fixed { group: "sides".into(), axes: [true; 3] }],
//!     loads: vec![LoadSpec {
//!         group: "top".into(),
//!         kind: LoadKind::Traction([0.0, 0.0, -100.0]), // Pa
//!         ramp: Ramp::Step,
//!     }],
//!     ..Problem::default()
//! };
//! let model = Model::build(&mesh, &problem)?;
//! assert_eq!(model.dofs(), 3 * (3 * 3 * 5)); // the nodes off the four sides
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod assembly;
mod cells;
mod check;
mod elements;
mod error;
mod loads;
mod model;
mod problem;
mod report;
mod scales;
pub mod springs;
pub mod tetra;

pub use error::{Cause, FemError, Item};
pub use loads::LoadFacts;
pub use model::Model;
pub use problem::{Fixed, Law, LoadKind, LoadSpec, Problem, Rayleigh, Region, SpringRule};
pub use report::{ModelReport, RegionFacts};
pub use springs::NetworkModulus;
