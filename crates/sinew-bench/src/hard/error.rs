//! Why a hard run or a mark could not be measured.

use std::path::PathBuf;

use sinew_core::{OperatorError, OptionError, SetupError, SimulateError, StepError};
use sinew_fem::FemError;
use sinew_integrators::StaticError;
use sinew_measure::MeasureError;
use sinew_mesh::structured::StructuredError;
use sinew_scene::SceneError;

use sinew_verify::tissue::TissueError;

/// Why a hard run or the figure of a mark could not be measured.
#[derive(Debug, thiserror::Error)]
pub(crate) enum HardError {
    #[error(transparent)]
    Measure(#[from] MeasureError),
    #[error(transparent)]
    Options(#[from] OptionError),
    #[error(transparent)]
    Setup(#[from] SetupError),
    #[error(transparent)]
    Step(#[from] StepError),
    #[error(transparent)]
    Run(#[from] SimulateError),
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A copy of a scene's body.
    #[error(transparent)]
    Body(#[from] FemError),
    /// An equilibrium.
    #[error(transparent)]
    Static(#[from] StaticError),
    /// A structured mesh.
    #[error(transparent)]
    Mesh(#[from] StructuredError),
    /// A block of tissue.
    #[error(transparent)]
    Tissue(#[from] TissueError),
    /// A copy of a scene's oscillator.
    #[error(transparent)]
    Oscillator(#[from] OperatorError),
    #[error("{}: {source}", .folder.display())]
    Folder {
        folder: PathBuf,
        source: std::io::Error,
    },
    #[error("{0} was not read")]
    NotRead(String),
    #[error("needs the matrices of a linear system")]
    NotLinear,
    #[error("nothing vibrates")]
    NothingVibrates,
    #[error("the reference does not come to rest")]
    NeverAtRest,
    #[error("needs one load, a pulse")]
    NotOnePulse,
    #[error("no mode was found")]
    NoMode,
    #[error("no method or no step was given")]
    NoRun,
    #[error("an oscillator has no direction and no mirror image")]
    NoBody,
    #[error("the mesh is not its own mirror image")]
    NotSymmetric,
}
