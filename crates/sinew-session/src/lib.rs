//! Scenes that are driven while they run: tools in a hand, loads turned up and down, methods and steps switched.
//!
//! A [`Session`] takes steps one by one and [`Command`]s between them. Every command stands in its [`Log`], by which the session can be
//! repeated bit for bit: states depend on the scene and the log, and on nothing else.

mod command;
mod course;
mod error;
mod input_file;
mod log;
mod replay;
mod session;

pub use command::{Command, CommandError};
pub use course::Course;
pub use error::{SessionError, SessionStepError};
pub use input_file::{InputFile, InputFileError};
pub use log::{Entry, Header, Journal, JournalError, Log, LogError, LogFault};
pub use replay::{FollowError, Followed, Replay, ReplayError};
pub use session::{BodyCut, Session};
