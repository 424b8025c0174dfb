//! Systems from a tetrahedral mesh, materials of small or large deformation, supports and loads.
//!
//! ```
//! use sinew_core::System;
//! use sinew_fem::{Fixed, Law, LoadKind, LoadSpec, Model, Problem, Region};
//! use sinew_mesh::structured::{self, Split};
//!
//! let mesh = structured::cube(4, 0.1, Split::Kuhn)?;
//! let law = Law::linear(3500.0, 0.45); // Young's modulus (Pa), Poisson's ratio
//! let problem = Problem::of([Region::new(law, 1060.0)]) // kg/m3
//!     .with_fixed(Fixed::at("sides"))
//!     .with_load(LoadSpec::new("top", LoadKind::Traction([0.0, 0.0, -100.0]))); // Pa
//! let model = Model::build(&mesh, &problem)?;
//! assert_eq!(model.dofs(), 3 * (3 * 3 * 5)); // the nodes off the four sides
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A model also evaluates a state: positions of all nodes, strain and stress of each tetrahedron,
//! and the reactions of its supports. A mesh without groups is fixed at nodes:
//!
//! ```
//! # use sinew_core::System;
//! # use sinew_fem::{Fixed, Law, Model, On, Problem, Region};
//! # use sinew_mesh::structured::{self, Split};
//! let mesh = structured::cube(4, 0.1, Split::Kuhn)?;
//! let law = Law::linear(3500.0, 0.0);
//! let floor: Vec<u32> = (0..25).collect();
//! let floor_held = Fixed::at(On::Nodes(floor.clone()));
//! let model = Model::build(&mesh, &Problem::of([Region::new(law, 1060.0)]).with_fixed(floor_held))?;
//!
//! // Stretched by one per cent along z: a stress of 35 Pa, held on 0.01 m2 by -0.35 N.
//! let field: Vec<[f64; 3]> = mesh.points.iter().map(|p| [0.0, 0.0, 0.01 * p[2]]).collect();
//! let (mut u, v) = (vec![0.0; model.dofs()], vec![0.0; model.dofs()]);
//! model.to_dofs(&field, &mut u)?;
//! let mut stress = vec![[0.0; 6]; mesh.tets.len()];
//! model.stress(0.0, &u, &mut stress)?;
//! assert!(stress.iter().all(|[.., zz, _, _, _]| (zz - 35.0).abs() < 1e-9));
//! let reaction = model.reaction(0.0, &u, &v, &On::Nodes(floor))?;
//! assert!((reaction[2] + 0.35).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Parts of it can be moved, which takes a force:
//!
//! ```
//! # use sinew_core::{Ramp, System};
//! # use sinew_fem::{Course, Fixed, Law, Model, Moving, Problem, Region};
//! # use sinew_mesh::structured::{self, Split};
//! let mesh = structured::cube(4, 0.1, Split::Kuhn)?;
//! let law = Law::linear(3500.0, 0.0);
//! let up = Course::new([0.0, 0.0, 0.001], Ramp::Sin2 { rise: 0.2 }); // m, s
//! let problem = Problem::of([Region::new(law, 1060.0)])
//!     .with_fixed(Fixed::at("bottom"))
//!     .with_move(Moving::new("top", [up]));
//! let model = Model::build(&mesh, &problem)?;
//!
//! // At t = 0.1 s the top is half way up; held evenly in between, it pulls with 17.5 Pa on 0.01 m2.
//! let field: Vec<[f64; 3]> = mesh.points.iter().map(|p| [0.0, 0.0, 0.005 * p[2]]).collect();
//! let (mut u, v) = (vec![0.0; model.dofs()], vec![0.0; model.dofs()]);
//! model.to_dofs(&field, &mut u)?;
//! let mut stress = vec![[0.0; 6]; mesh.tets.len()];
//! model.stress(0.1, &u, &mut stress)?;
//! assert!(stress.iter().all(|[.., zz, _, _, _]| (zz - 17.5).abs() < 1e-9));
//! let reaction = model.reaction(0.1, &u, &v, &"top".into())?;
//! assert!((reaction[2] - 0.175).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod assembly;
mod body;
mod border;
mod boundary;
mod by_tet;
mod cells;
mod check;
mod cut;
mod cut_model;
mod element;
mod elements;
mod error;
mod following;
mod frame;
mod from_mesh;
mod graph;
pub mod homogeneous;
pub mod hyperelastic;
mod in_place;
mod large;
mod law;
mod law_registry;
mod loads;
mod lumped;
mod material;
mod model;
mod motion;
mod network;
mod number;
mod on;
mod orthotropic;
mod parts;
mod places;
mod problem;
mod regions;
mod relaxed;
mod report;
mod scales;
mod shares;
mod smoothing;
pub mod springs;
pub mod stress;
mod supports;
pub mod tetra;
mod tissue;
mod vector_error;
mod volumes;

pub use body::smoothed_blocks;
pub use boundary::{Course, Fixed, Moving};
pub use cut_model::{CutModel, CutModelError, CutReport, SavedCut};
pub use element::Element;
pub use error::{Cause, FemError, Item};
pub use frame::are_parallel;
pub use from_mesh::{DataError, FromMesh};
pub use law::{Law, SpringRule};
pub use model::{
    CutStateError, DeformedTet, FieldError, Model, ModelLoads, NodalForces, NodesCarried,
    SupportMotion, TetDeformation, WithMemory,
};
pub use on::On;
pub use problem::{LoadKind, LoadSpec, Problem, Rayleigh, Region};
pub use report::{LoadFacts, ModelReport, MoveFacts, RegionFacts};
pub use springs::NetworkModulus;
pub use tissue::{Direction, FibreFamily, Memory, Moduli, Tissue, ViscousPart};
pub use vector_error::{ForceError, SupportMotionError};
