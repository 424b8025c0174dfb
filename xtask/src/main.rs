//! Repository chores: `cargo xtask bench | reproduce | meshes | docs | ci`.

mod bench;
mod beside;
mod ci;
mod docs;
mod failure;
mod meshes;
mod progress;
mod reproduce;
mod rules;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Chores of the sinew repository.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Subcommand)]
enum Chore {
    /// Measure error, cost and stability of integrators on scenes.
    Bench(bench::Arguments),
    /// Draw the paper's figures and check its claims one by one.
    Reproduce(reproduce::Arguments),
    /// Write the meshes of the repository anew.
    Meshes,
    /// Bring the README's table and pictures up to the last bench and the last hard bench.
    Docs,
    /// Everything that must hold before a change lands.
    Ci,
}

fn main() -> ExitCode {
    let outcome = match Arguments::parse().chore {
        Chore::Bench(arguments) => bench::run(&arguments),
        Chore::Reproduce(arguments) => reproduce::run(&arguments),
        Chore::Meshes => meshes::run(),
        Chore::Docs => docs::run(),
        Chore::Ci => ci::run(),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}

/// The root of the repository.
fn root() -> PathBuf {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
    manifest.parent().unwrap_or(manifest).to_owned()
}
