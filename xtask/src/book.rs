//! `cargo xtask book`: the book as web pages, by mdBook.

use std::path::{Path, PathBuf};
use std::process::Command;

use sinew_scene::output::say;

use crate::failure::Failure;
use crate::repository::root;

/// Version of mdBook that the book is written for.
const VERSION: &str = "0.5.4";

/// Folder for programs that are installed for the repository.
const TOOLS: &str = "target/tools";

/// Options of the chore.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Install mdBook into target/tools if it is absent: minutes, once.
    #[arg(long)]
    install: bool,
}

/// Builds the book into target/book.
///
/// # Errors
/// [`Failure::Input`] without mdBook, and [`Failure::Chore`] if it fails or warns.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let program = match program() {
        Ok(program) => program,
        Err(_) if arguments.install => install()?,
        Err(reason) => return Err(reason),
    };
    run_with(&program)
}

/// mdBook, of `PATH` or installed for the repository.
///
/// # Errors
/// [`Failure::Input`] if there is none.
pub(crate) fn program() -> Result<PathBuf, Failure> {
    let installed = root().join(TOOLS).join("bin/mdbook");
    let programs = [PathBuf::from("mdbook"), installed];
    let answers = |program: &PathBuf| {
        let output = Command::new(program).arg("--version").output();
        output.is_ok_and(|output| output.status.success())
    };
    programs.into_iter().find(answers).ok_or_else(|| {
        Failure::Input(
            "there is no mdbook; `cargo xtask book --install` or `cargo install mdbook` brings it"
                .into(),
        )
    })
}

fn install() -> Result<PathBuf, Failure> {
    let status = Command::new(env!("CARGO"))
        .args([
            "install",
            "mdbook",
            "--version",
            VERSION,
            "--locked",
            "--root",
        ])
        .arg(root().join(TOOLS))
        .status()
        .map_err(Failure::chore)?;
    match status.success() {
        true => program(),
        false => Err(Failure::Chore(format!("installing mdbook: {status}"))),
    }
}

/// Builds the book with this program.
///
/// # Errors
/// [`Failure::Chore`] if it fails or warns.
pub(crate) fn run_with(program: &Path) -> Result<(), Failure> {
    let output = Command::new(program)
        .args(["build", "docs/book"])
        .current_dir(root())
        .output()
        .map_err(Failure::chore)?;
    let told = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() || told.contains("WARN") || told.contains("ERROR") {
        return Err(Failure::Chore(format!(
            "mdbook: {}: {}",
            output.status,
            told.trim()
        )));
    }
    Ok(say("target/book/index.html")?)
}
