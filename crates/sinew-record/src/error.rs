//! Reasons for which a run leaves no result.

use std::path::PathBuf;

use sinew_core::{EvaluationError, OptionError, SimulateError, StateBytesError};
use sinew_fem::FieldError;
use sinew_mesh::vtu::WriteVtuError;
use sinew_scene::output::OutputError;
use sinew_scene::{CuttingError, ProbeRowError, ReactionError, SceneError};
use sinew_world::{InputFileError, ReplayError, WorldStepError};

/// A reason for which a run leaves no result, or cannot continue.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordRunError {
    /// A folder or file that cannot be written or read.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The scene of an earlier run that cannot be used.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// An option that the integrator refuses.
    #[error(transparent)]
    Option(#[from] OptionError),
    /// A step or a recorder that failed.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// A system that refuses a state.
    #[error(transparent)]
    State(#[from] EvaluationError),
    /// A field that cannot be written.
    #[error(transparent)]
    Field(#[from] FieldError),
    /// A body that cannot be cut.
    #[error(transparent)]
    Cutting(#[from] CuttingError),
    /// Supports without reactions.
    #[error(transparent)]
    Reaction(#[from] ReactionError),
    /// A row of probes that cannot be written.
    #[error(transparent)]
    ProbeRow(#[from] ProbeRowError),
    /// A field that a .vtu file cannot store.
    #[error(transparent)]
    Vtu(#[from] WriteVtuError),
    /// The state of a checkpoint that does not fit.
    #[error("the checkpoint in {}: {source}; run the scene again into a new folder", folder.display())]
    Checkpoint {
        /// The folder.
        folder: PathBuf,
        /// The reason.
        source: StateBytesError,
    },
    /// A file of an earlier run that is damaged or of another version.
    #[error("{} in {} cannot be used: {reason}; run the scene again into a new folder", name, folder.display())]
    Unusable {
        /// The folder.
        folder: PathBuf,
        /// The file in it.
        name: &'static str,
        /// The reason.
        reason: String,
    },
    /// A file of the folder that was changed after the run wrote it.
    #[error("{} is not as the run wrote it: {reason}; run the scene again, with --again into this folder", path.display())]
    Altered {
        /// The file.
        path: PathBuf,
        /// The difference.
        reason: String,
    },
    /// A run that was not completed and can be continued.
    #[error("{} holds a run that was not completed: `sinew resume {}` continues it; to discard it, use `sinew run --again`", folder.display(), folder.display())]
    Resumable {
        /// The folder.
        folder: PathBuf,
    },
    /// More results than a folder may contain.
    #[error(
        "the scene asks for {asked} {what}, and {most} are the most: make `{key}` in [output] rarer"
    )]
    TooMuch {
        /// Their number.
        asked: usize,
        /// The kind of requested results.
        what: &'static str,
        /// The largest number that a folder may contain.
        most: usize,
        /// The key of the scene that requests them.
        key: &'static str,
    },
    /// An input that changed since the run began.
    #[error("{} is not the file with which the run began: its content changed; run the scene again into a new folder", path.display())]
    OtherInput {
        /// The input.
        path: PathBuf,
    },
    /// An input that cannot be read.
    #[error("{0}; the run reads it")]
    NoInput(#[from] InputFileError),
    /// The folder of a repeated session, which a run cannot continue.
    #[error("{} holds a session that was repeated by its log, with which no run can go on: repeat it again, by `sinew run --replay`", folder.display())]
    Replay {
        /// The folder.
        folder: PathBuf,
    },
    /// A session that cannot be repeated.
    #[error(transparent)]
    Repeat(#[from] ReplayError),
    /// A step that cannot be taken.
    #[error(transparent)]
    Step(#[from] WorldStepError),
}
