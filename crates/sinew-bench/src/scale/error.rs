//! Errors of a bench over sizes.

use sinew_measure::{CaseError, MeasureError, ThreadError};
use sinew_scene::SceneError;

/// Why a bench over sizes cannot go on.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ScaleError {
    /// A cube cannot be built.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A cube has no reference.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// A method cannot run.
    #[error(transparent)]
    Measure(#[from] MeasureError),
    /// A timed run that does not come to its end.
    #[error(transparent)]
    Timed(#[from] crate::TimedRunError),
    /// A body's matrices cannot be put together again.
    #[error(transparent)]
    Operators(#[from] sinew_core::OperatorError),
    /// The measuring thread cannot be started.
    #[error(transparent)]
    Thread(#[from] ThreadError),
}
