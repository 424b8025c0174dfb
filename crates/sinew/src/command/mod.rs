//! The subcommands.

mod failure;
pub(crate) mod integrators;
pub(crate) mod mesh;
pub(crate) mod plan;
pub(crate) mod run;

pub(crate) use failure::Failure;
