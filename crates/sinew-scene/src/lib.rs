//! Scenes of soft tissue in TOML: read, check, plan, build.
//!
//! A [`Scene`] is the user's text with every key checked. [`Scene::build`] turns it into a
//! [`Simulation`]: a system that integrators can move, with a printable [`Plan`]. Every mistake is
//! reported as one [`SceneError`], with its line.
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
mod formula;
mod keys;
mod nearest;
mod number;
mod options_json;
pub mod output;
mod overlap;
mod overrides;
mod plan;
mod probe_csv;
mod probe_rows;
mod proposal;
mod reference;
mod scene;
mod schedule;
mod simulation;
mod source;

pub use error::{
    Fault, MotionTableError, MotionTableFault, NoStableStep, OverrideError, SceneError,
    StableStepError, ToolFault,
};
pub use formula::{Formula, FormulaError};
pub use options_json::options_json;
pub use overlap::{Overlap, OverlapWatch};
pub use plan::{Plan, PlanSection};
pub use probe_csv::ProbeCsv;
pub use probe_rows::{ProbeRowError, ProbeRows};
pub use proposal::propose;
pub use reference::{scene_reference, scene_schema};
pub use scene::{
    Blade, Body, Choice, Cutting, Grasp, Initial, Instants, Lips, LoosePieces, Members,
    MeshChanges, MeshSource, Motion, Oscillator, OutputSettings, ProbeAt, ProbePoint, Quantity,
    Rotation, RunSettings, Scene, Selected, StartsInside, Subject, TimeStep, Tool, ToolBody,
    ToolPart, ToolPath, ToolShape, ToolStart, Way,
};
pub use schedule::Schedule;
pub use simulation::{
    AtRestError, BodyModel, CutFrom, CutTotals, Cutter, CuttingError, DrivenLoadError, Footprint,
    HeldParts, HeldPlace, LoadRemedy, MeshedScene, NearestNode, Probe, ProbeNode, Reaction,
    ReactionError, ReactionOf, RefinementError, RefusedLoad, RoughStrokes, SavedCuts, SceneBody,
    SceneModel, SelectedPart, Simulation, UnresolvedLoad, Warning, WarningKind,
};
pub use source::SceneSource;
