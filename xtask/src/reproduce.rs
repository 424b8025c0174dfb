//! `cargo xtask reproduce`.

use std::path::PathBuf;

use crate::failure::Failure;

/// Where to write.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Where the figures and the table go [default: target/reproduce]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let _ = &arguments.out;
    Err(Failure::chore("not yet"))
}
