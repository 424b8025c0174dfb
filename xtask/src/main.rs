//! Repository chores:
//! `cargo xtask bench | verify | native | memory | reproduce | meshes | compare | laws | wheel | python-test | live-test | docs | gallery | book | reference | readme | to-a-scene | dist | rules | ci`.

mod bench;
mod beside;
mod book;
mod ci;
mod compare;
mod dist;
mod docs;
mod environment;
mod failure;
mod gallery;
mod generated;
mod laws;
mod live_test;
mod memory;
mod meshes;
mod native;
mod power_loss;
mod program;
mod progress;
mod python;
mod python_test;
mod readme;
mod reference;
mod repository;
mod reproduce;
mod rules;
mod to_a_scene;
mod verify;
mod wheel;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use sinew_core::CountingAllocator;

/// Counts allocations for the kernels' bench.
#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

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
    /// Compute every required figure of the library and compare it: closed forms, published digits and tables.
    Verify(verify::Arguments),
    /// Compare the kernels' speed in a portable build with one for this processor.
    Native,
    /// Run the kernels' tests under a program that watches memory: Miri or valgrind.
    Memory,
    /// Draw the paper's figures and check its claims one by one.
    Reproduce(reproduce::Arguments),
    /// Write the repository's structured meshes again.
    Meshes,
    /// Let meshio and pyvista read what sinew-mesh writes; pip installs both into target/.
    Compare,
    /// Compare stresses and tangents of all laws with energies in 50 digits; pip installs mpmath into target/.
    Laws,
    /// Build the Python package sinew-sim as a wheel; pip installs maturin into target/.
    Wheel(wheel::Arguments),
    /// Test the Python package in separate environments: tests, examples, notebook, types, and without Rust; pip
    /// installs what they need into target/. Part of `ci`.
    PythonTest,
    /// Test the live page in Chromium without a window: a hand, fingers, a blade, strangers, speed; skipped if Chromium
    /// is absent.
    LiveTest(live_test::Arguments),
    /// Lose the power during runs on a separate disk and continue them; skipped if none can be mounted. Needs root,
    /// ext4 and perl.
    PowerLoss(power_loss::Arguments),
    /// Update the table and the pictures of the book's chapter on the bench from the last bench and the last hard
    /// bench.
    Docs,
    /// Draw the pictures of the ready scenes in the book, and the film of the README, by runs of them.
    Gallery,
    /// Build the book into target/book by mdBook; part of `ci` if mdBook is installed.
    Book(book::Arguments),
    /// Write the reference and the JSON schema of scenes into docs.
    Reference,
    /// Run the commands of the README and of the book as they are written there; part of `ci`.
    Readme,
    /// Run the commands of docs/to-a-scene.md and those that errors name for files of other programs; pip installs what they need into
    /// target/. Part of `ci`.
    ToAScene,
    /// Pack the command with scenes, meshes and documents into an archive for computers without Rust, and test it in
    /// another place.
    Dist(dist::Arguments),
    /// Check the rules of ARCHITECTURE.md that a machine can check; part of `ci`.
    Rules,
    /// Everything that must hold before a change lands.
    Ci(ci::Arguments),
}

fn main() -> ExitCode {
    let outcome = match Arguments::parse().chore {
        Chore::Bench(arguments) => bench::run(&arguments),
        Chore::Verify(arguments) => verify::run(&arguments),
        Chore::Native => native::run(),
        Chore::Memory => memory::run(),
        Chore::Reproduce(arguments) => reproduce::run(&arguments),
        Chore::Meshes => meshes::run(),
        Chore::Compare => compare::run(),
        Chore::Laws => laws::run(),
        Chore::Wheel(arguments) => wheel::run(&arguments),
        Chore::PythonTest => python_test::run(),
        Chore::LiveTest(arguments) => live_test::run(&arguments),
        Chore::PowerLoss(arguments) => power_loss::run(&arguments),
        Chore::Docs => docs::run(),
        Chore::Gallery => gallery::run(),
        Chore::Book(arguments) => book::run(&arguments),
        Chore::Reference => reference::run(),
        Chore::Readme => readme::run(),
        Chore::ToAScene => to_a_scene::run(),
        Chore::Dist(arguments) => dist::run(&arguments),
        Chore::Rules => ci::check_rules(),
        Chore::Ci(arguments) => ci::run(&arguments),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
