//! The subcommands.

mod failure;
pub(crate) mod integrators;
mod interruption;
pub(crate) mod mesh;
mod onlooker;
pub(crate) mod plan;
pub(crate) mod resume;
pub(crate) mod run;

pub(crate) use failure::Failure;
