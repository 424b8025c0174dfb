//! The subcommands.

pub(crate) mod compare;
pub(crate) mod converge;
mod failure;
pub(crate) mod film;
pub(crate) mod integrators;
mod interruption;
pub(crate) mod law;
#[cfg(feature = "live")]
pub(crate) mod live;
mod memory_left;
pub(crate) mod mesh;
#[cfg(feature = "implicit")]
pub(crate) mod modes;
mod mp4;
pub(crate) mod new;
mod onlooker;
mod own_file;
mod pace;
pub(crate) mod plan;
mod ready;
mod results;
pub(crate) mod resume;
mod ruled;
pub(crate) mod run;
pub(crate) mod scene_reference;
mod scene_with;
mod share_of;

pub(crate) use failure::Failure;
#[cfg(feature = "implicit")]
pub use scene_with::memory_of;
