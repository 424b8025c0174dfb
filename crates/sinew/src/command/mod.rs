//! The subcommands.

mod failure;
pub(crate) mod integrators;
pub(crate) mod mesh;
pub(crate) mod plan;
pub(crate) mod run;

pub(crate) use failure::Failure;

use std::io::Write;

/// Writes to standard output; a reader that went away is no failure.
fn say(text: &str) {
    let _ = writeln!(std::io::stdout(), "{text}");
}
