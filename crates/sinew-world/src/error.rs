//! Errors of worlds and their steps.

use sinew_core::{
    EvaluationError, ForceInputError, InputBytesError, InputError, OptionError, RecordError,
    StateBytesError, StepError,
};
use sinew_fem::FieldError;
use sinew_scene::{CuttingError, DrivenLoadError, ReactionError, RefusedLoad, SceneError};
use sinew_tools::ToolsError;

use crate::command::CommandError;
use crate::input_file::InputFileError;

/// Reasons for which a scene cannot be set in motion.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WorldError {
    /// A scene that cannot be built.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A load that the scene's integrator does not support.
    #[error(transparent)]
    Load(#[from] RefusedLoad),
    /// Loads that cannot be steered.
    #[error(transparent)]
    Driven(#[from] DrivenLoadError),
    /// An option that the scene's integrator does not have.
    #[error(transparent)]
    Option(#[from] OptionError),
    /// A first step that cannot be taken.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A body that cannot be cut.
    #[error(transparent)]
    Cutting(#[from] CuttingError),
    /// Tools that do not fit the surface.
    #[error(transparent)]
    Tools(#[from] ToolsError),
    /// A file of the scene that could not be read for its hash.
    #[error(transparent)]
    File(#[from] InputFileError),
}

/// Reasons for which a step fails. Only a reset continues from there.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WorldStepError {
    /// A displacement that is not finite, or beyond [`sinew_scene::Simulation::divergence_limit`]. The step was taken,
    /// and counts.
    #[error("the motion diverged at t = {t} s: {place} is too far away")]
    Diverged {
        /// Time (s).
        t: f64,
        /// The degree of freedom with the largest displacement, in the terms of the system.
        place: String,
    },
    /// A method that could not take the step, or a law that refused a state.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A cut after which the motion cannot continue.
    #[error(transparent)]
    Cutting(#[from] CuttingError),
    /// Loads that cannot be steered on the body after a cut.
    #[error("after a cut: {0}")]
    Driven(String),
    /// A pose that could not be recorded.
    #[error(transparent)]
    Input(#[from] InputError),
    /// Forces that could not be recorded.
    #[error(transparent)]
    Forces(#[from] ForceInputError),
    /// Message of a failure before the motion was saved and restored.
    #[error("{0}")]
    Earlier(String),
    /// A step that is too short to advance the time.
    #[error("t = {t} s: a step of {dt} s does not advance it: expected a longer step, or a reset")]
    Time {
        /// Time (s).
        t: f64,
        /// The step (s).
        dt: f64,
    },
}

/// Reasons for which [`crate::World::advance`] ends before its time.
#[derive(Debug, thiserror::Error)]
pub enum AdvanceError {
    /// A step that failed.
    #[error(transparent)]
    Step(#[from] WorldStepError),
    /// A recorder that failed.
    #[error(transparent)]
    Record(#[from] RecordError),
}

/// Reasons for which [`crate::World::advance_to`] ends before its time.
#[derive(Debug, thiserror::Error)]
pub enum AdvanceToError {
    /// A time that steps cannot reach.
    #[error("t = {t} s: expected a finite time from {now} s on")]
    Time {
        /// The time (s).
        t: f64,
        /// The present time (s).
        now: f64,
    },
    /// A step or a recorder that failed.
    #[error(transparent)]
    Advance(#[from] AdvanceError),
    /// A step that cannot be shortened.
    #[error(transparent)]
    Shorten(#[from] CommandError),
}

/// Reasons for which a world cannot report a field.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// A field over a mesh, of a scene without one.
    #[error("an oscillator has no mesh, and no fields over one")]
    NoMesh,
    /// A slice of the wrong length, or a field that the body does not have.
    #[error(transparent)]
    Field(#[from] FieldError),
    /// A state for which the system has no velocity at its time.
    #[error(transparent)]
    State(#[from] EvaluationError),
    /// Reactions that cannot be computed.
    #[error(transparent)]
    Reaction(#[from] ReactionError),
}

/// Reasons for which [`crate::World::restore`] fails.
#[derive(Debug, thiserror::Error)]
pub enum RestoreError {
    /// A motion saved by a world that follows its scene, for one that takes commands; or the reverse.
    #[error(
        "this motion was kept by a world that was built in another way, by `World::new` or `World::following`"
    )]
    OtherWorld,
    /// A motion of another scene.
    #[error(
        "this motion was kept by the world of another scene: its text, or a file that it reads, is not that of this one"
    )]
    OtherScene,
    /// A moment that is not in the past of this world.
    #[error(
        "this moment is not in the past of this world: another one had it, or went back beyond it"
    )]
    OtherPast,
    /// A part that is not possible in any motion: the value was altered.
    #[error("the saved motion was altered: its {part} cannot be")]
    Impossible {
        /// The part.
        part: &'static str,
    },
    /// Cuts of another body.
    #[error(transparent)]
    Cutting(#[from] CuttingError),
    /// A state of another system.
    #[error(transparent)]
    State(#[from] StateBytesError),
    /// Inputs that cannot be decoded.
    #[error(transparent)]
    Inputs(#[from] InputBytesError),
    /// Loads that cannot be steered.
    #[error(transparent)]
    Driven(#[from] DrivenLoadError),
    /// A method that this program does not have.
    #[error(transparent)]
    Option(#[from] OptionError),
}
