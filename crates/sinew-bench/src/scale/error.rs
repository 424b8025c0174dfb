//! Errors of a bench over sizes.

use sinew_measure::{CaseError, MeasureError, ThreadError};
use sinew_scene::SceneError;

/// Reasons for which a bench over sizes cannot continue.
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
    /// A body's matrices cannot be put together again.
    #[error(transparent)]
    Operators(#[from] sinew_core::OperatorError),
    /// The measuring thread cannot be started.
    #[error(transparent)]
    Thread(#[from] ThreadError),
}
