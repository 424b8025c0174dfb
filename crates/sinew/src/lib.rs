//! Soft-tissue dynamics for surgical simulation: all sinew crates under one name.
//!
//! Each crate also works alone. The default feature `cli` builds the `sinew` command; a program that does not need it
//! depends on `sinew = { version = "..", default-features = false }`, which leaves out the command's libraries, and
//! adds the features `implicit` (implicit methods), `rayon` (threads) and `haptics` (devices with force feedback) as
//! needed.
//!
//! ```
//! use sinew::prelude::*;
//!
//! let mesh = structured::cube(4, 0.1, Split::Kuhn)?;
//! let problem = Problem::of([Region::new(Law::linear(3500.0, 0.45), 1060.0)])
//!     .with_fixed(Fixed::at("bottom"))
//!     .with_gravity([0.0, 0.0, -9.81]);
//! let model = Model::build(&mesh, &problem)?;
//! let mut integrator = sinew::integrators::build("central-difference", &Options::new())?;
//! let StableStep::UpTo(limit) = integrator.stable_step(&model)? else { unreachable!() };
//! let mut state = State::at_rest(model.dofs());
//! let run = Run::covering(0.05, 0.9 * limit);
//! let report = simulate(&model, &mut *integrator, &mut state, &run, &mut ())?;
//! assert_eq!(report.outcome, Outcome::Finished);
//! assert!(state.u.iter().skip(2).step_by(3).all(|u_z| *u_z < 0.0), "it sags");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub use {
    sinew_cnn as cnn, sinew_core as core, sinew_cutting as cutting, sinew_fem as fem,
    sinew_integrators as integrators, sinew_machines as machines, sinew_measure as measure,
    sinew_mesh as mesh, sinew_scene as scene, sinew_sparse as sparse, sinew_tools as tools,
    sinew_world as world,
};

#[cfg(feature = "haptics")]
pub use sinew_haptics as haptics;

#[cfg(feature = "cli")]
pub mod cli;
#[cfg(feature = "cli")]
mod command;

/// The items that most programs need.
pub mod prelude {
    pub use sinew_cnn::{Saturation, Templates};
    pub use sinew_core::{
        Between, Channel, Inputs, Integrator, LinearSystem, LoadTime, Options, Outcome, Ramp,
        Recorder, Run, StableStep, State, StepReport, System, simulate, simulate_under,
        worst_beyond,
    };
    pub use sinew_fem::stress::von_mises;
    pub use sinew_fem::{
        Course, Element, Fixed, FromMesh, Law, LoadKind, LoadSpec, Model, Moving, NodalForces, On,
        Problem, Rayleigh, Region, SpringRule, Tissue,
    };
    pub use sinew_integrators::Stepper;
    pub use sinew_mesh::structured::{self, Split};
    pub use sinew_mesh::{TetMesh, read_mesh_file, read_msh_file};
    pub use sinew_scene::Scene;
    pub use sinew_world::World;
}

/// The examples of the README and of the book, compiled and run with the tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
#[doc = include_str!("../../../docs/book/src/own-program.md")]
#[doc = include_str!("../../../docs/book/src/own-parts.md")]
#[doc = include_str!("../../../docs/book/src/haptics.md")]
pub struct Documents;
