//! Reasons why the spatial error of a scene is unknown.

use sinew_core::{OptionError, SetupError, SimulateError};
use sinew_scene::RefinementError;

use crate::forecast::ForecastError;
use crate::reference::ReferenceError;

/// Reasons why a scene could not be solved on several meshes.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ConvergeError {
    /// No finer mesh is possible.
    #[error(transparent)]
    Refinement(#[from] RefinementError),
    /// The integrator's options do not fit.
    #[error(transparent)]
    Options(#[from] OptionError),
    /// The integrator cannot be set up.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// A step failed.
    #[error(transparent)]
    Run(#[from] SimulateError),
    /// The first steps on the scene's mesh failed.
    #[error(transparent)]
    Forecast(#[from] ForecastError),
    /// No reference could be solved.
    #[error("on mesh {level}: {source}")]
    Reference {
        /// The mesh, from 1 on.
        level: usize,
        /// The reason.
        source: ReferenceError,
    },
    /// The run with half the step diverged, so that nothing is left to compare.
    #[error(
        "on mesh {level} the run in steps of {dt:e} s diverged, so that nothing can be compared; `sinew plan` names the stable step"
    )]
    Diverged {
        /// The mesh, from 1 on.
        level: usize,
        /// The step (s).
        dt: f64,
    },
    /// The run with half the step is the same, so that the two give no error in time.
    #[error(
        "on mesh {level} the run in steps of {dt:e} s and that in half of them are the same to the last bit, so that they tell nothing of the error in time; \
         take another dt, in seconds, or another method"
    )]
    SameRun {
        /// The mesh, from 1 on.
        level: usize,
        /// The step (s).
        dt: f64,
    },
    /// A body that may be cut.
    #[error(
        "the body may be cut ([cutting]), on each mesh otherwise: remove the table [cutting] to measure the uncut body"
    )]
    Cut,
    /// Errors are relative to the motion, and nothing moves.
    #[error("nothing moves in this scene, so that there is no error to estimate")]
    NothingMoves,
    /// A displacement could not be computed at all nodes.
    #[error("the motion of the nodes cannot be told: {0}")]
    Field(String),
}
