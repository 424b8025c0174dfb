//! Scenes of soft tissue in TOML: read, check, plan, build.
//!
//! A [`Scene`] is what a user wrote, every key checked. [`Scene::build`] makes a [`Simulation`] of
//! it, which integrators can move and which prints its [`Plan`]. Whatever is wrong comes as one
//! [`SceneError`] that knows the line.
//!
//! ```
//! use sinew_scene::{Scene, SceneSource};
//!
//! let text = r#"
//! title = "a mass on a spring"
//! [oscillator]
//! mass = 0.1        # kg
//! stiffness = 100.0 # N/m
//! damping = 1.0     # N s/m
//! velocity = -5.0   # m/s
//! [run]
//! duration = 1.0    # s
//! integrator = "central-difference"
//! dt = 0.02         # s
//! "#;
//! let simulation = Scene::parse(SceneSource::new("spring.toml", text))?.build()?;
//! assert_eq!(simulation.run().steps, 50);
//! assert!((simulation.plan().critical_step - 0.0632).abs() < 1e-4);
//!
//! let wrong = text.replace("0.02", "-0.02");
//! let error = Scene::parse(SceneSource::new("spring.toml", wrong)).expect_err("a negative step");
//! assert_eq!(
//!     error.to_string(),
//!     "spring.toml:11: [run]: dt = -0.02: expected a finite step above 0 s, or \"auto\""
//! );
//! # Ok::<(), sinew_scene::SceneError>(())
//! ```

mod decode;
mod error;
mod nearest;
pub mod output;
mod plan;
mod probe_csv;
mod scene;
mod simulation;
mod source;

pub use error::{Fault, SceneError};
pub use plan::{Plan, PlanSection};
pub use probe_csv::ProbeCsv;
pub use scene::{
    Body, Initial, MeshSource, Oscillator, ProbePoint, RunSettings, Scene, Subject, TimeStep,
};
pub use simulation::{BodyModel, NearestNode, Probe, SceneModel, Simulation};
pub use source::SceneSource;
