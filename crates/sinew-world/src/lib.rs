//! Scenes in motion.
//!
//! Only a [`World`] takes the steps of a scene: alone, or observed by a [`Recorder`]. [`Command`]s between its steps
//! steer tools, scale loads, cut, and switch methods. Every command is kept in its [`Log`], which repeats the motion
//! bit for bit: states depend on the scene and the log, and on nothing else.

mod command;
mod course;
mod error;
mod input_file;
mod log;
mod recorder;
mod replay;
mod scene_identity;
mod world;

pub use command::{Command, CommandError, LoadId, ToolId};
pub use course::Course;
pub use error::{
    AdvanceError, AdvanceToError, ReportError, RestoreError, WorldError, WorldStepError,
};
pub use input_file::{InputFile, InputFileError};
pub use log::{Entry, Header, Journal, JournalError, Log, LogError, LogFault, WentBack};
pub use recorder::{BodyChange, BodyCut, Recorder, Recorders, Shown};
pub use replay::{FollowError, Replay, ReplayError};
pub use world::{Advanced, Ended, Moment, Saved, Trial, World};
