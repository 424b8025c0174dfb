//! The `sinew` command as a function, for programs that offer it under another name.

use std::ffi::OsString;
use std::io::ErrorKind;

use clap::{Parser, Subcommand};

use crate::command::{self, Failure};

#[cfg(feature = "implicit")]
pub use crate::command::memory_of;
pub use crate::command::plan::{PlanError, plan_json};

/// Soft-tissue dynamics: plan and run scenes.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Describe what a scene builds, what it leaves out and which steps are stable; with --tolerance,
    /// also advise the cheapest integrator and step.
    Plan(command::plan::Arguments),
    /// Run a scene: the motion of its probes as CSV, or with --out a folder with fields and tables.
    Run(command::run::Arguments),
    /// Continue a run that was interrupted or killed.
    Resume(command::resume::Arguments),
    /// Compare the results of two runs, or of two scenes: the largest difference of each quantity, with its time.
    Compare(command::compare::Arguments),
    /// Estimate the error of a scene's mesh: the scene runs again on a refined one, and the error of its step is given
    /// too.
    Converge(command::converge::Arguments),
    /// Draw a run: a picture of an instant, or a film of all of it, with its tools, as tissue or coloured by a field.
    Film(command::film::Arguments),
    /// Show the law of each region: its curves in tension, shear and of sheets, where they are stable, together with
    /// measured points.
    Law(command::law::Arguments),
    /// Find natural frequencies, mode shapes and the modes that the loads of a scene excite.
    #[cfg(feature = "implicit")]
    Modes(command::modes::Arguments),
    /// Press on a scene and cut it with the mouse: a page in a browser of this computer, in real time.
    #[cfg(feature = "live")]
    Live(command::live::Arguments),
    /// Write a first scene for a mesh, or one of the ready scenes.
    New(command::new::Arguments),
    /// Inspect, check, convert and refine mesh files.
    #[command(subcommand)]
    Mesh(command::mesh::Command),
    /// List the integrators, or describe one with its options.
    Integrators(command::integrators::Arguments),
    /// List the tables and keys of a scene, or print a JSON schema of scenes for editors.
    SceneReference(command::scene_reference::Arguments),
}

/// Runs the command with these arguments, the first of which is the name under which it was called, and returns its
/// exit code. It listens to Ctrl-C and similar signals from then on.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(said) => return answer(&said),
    };
    let outcome = match arguments.command {
        Command::Plan(arguments) => command::plan::run(&arguments),
        Command::Run(arguments) => command::run::run(&arguments),
        Command::Resume(arguments) => command::resume::run(&arguments),
        Command::Compare(arguments) => command::compare::run(&arguments),
        Command::Converge(arguments) => command::converge::run(&arguments),
        Command::Film(arguments) => command::film::run(&arguments),
        Command::Law(arguments) => command::law::run(&arguments),
        #[cfg(feature = "implicit")]
        Command::Modes(arguments) => command::modes::run(&arguments),
        #[cfg(feature = "live")]
        Command::Live(arguments) => command::live::run(&arguments),
        Command::New(arguments) => command::new::run(&arguments),
        Command::Mesh(arguments) => command::mesh::run(&arguments),
        Command::Integrators(arguments) => command::integrators::run(&arguments),
        Command::SceneReference(arguments) => command::scene_reference::run(&arguments),
    };
    match outcome {
        Ok(()) => 0,
        Err(failure) => failure.report(),
    }
}

/// Prints help, the version or a mistake in the arguments.
fn answer(said: &clap::Error) -> u8 {
    match said.print() {
        Err(error) if !said.use_stderr() && error.kind() != ErrorKind::BrokenPipe => {
            Failure::Print(error).report()
        }
        _ => u8::try_from(said.exit_code()).unwrap_or(2),
    }
}
