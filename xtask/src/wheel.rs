//! `cargo xtask wheel`: the Python package as a wheel.

use std::fs;
use std::path::{Path, PathBuf};

use sinew_scene::output::say;

use crate::environment::Environment;
use crate::failure::Failure;
use crate::repository::root;

/// The package that builds wheels.
const MATURIN: &str = "maturin==1.16.0";

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Folder of the wheel
    #[arg(long, value_name = "DIR", default_value = "target/wheel")]
    out: PathBuf,
    /// Also make a source distribution, and build the wheel from it: everything is compiled again
    #[arg(long)]
    sdist: bool,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let wheel = build(&arguments.out, arguments.sdist)?;
    let bytes = fs::metadata(&wheel).map_err(Failure::chore)?.len();
    let megabytes = bytes as f64 / 1e6;
    Ok(say(&format!("{}: {megabytes:.1} MB", wheel.display()))?)
}

/// Builds the wheel into a folder, removing other wheels from it; returns its path.
///
/// # Errors
/// Same as [`Environment::with`], and [`Failure::Chore`] if the build fails.
pub(crate) fn build(out: &Path, sdist: bool) -> Result<PathBuf, Failure> {
    let environment = Environment::with("wheel", &[MATURIN], &root().join("target"))?;
    for old in wheels(out) {
        fs::remove_file(old).map_err(Failure::chore)?;
    }
    let mut maturin = environment.program("maturin");
    maturin
        .args(["build", "--release", "--locked", "--quiet"])
        .args(sdist.then_some("--sdist"))
        .args(["--manifest-path", "crates/sinew-py/Cargo.toml", "--out"])
        .arg(std::path::absolute(out).map_err(Failure::chore)?)
        .current_dir(root());
    let status = maturin.status().map_err(Failure::chore)?;
    if !status.success() {
        return Err(Failure::Chore(format!("maturin: {status}")));
    }
    let mut built = wheels(out);
    match (built.pop(), built.is_empty()) {
        (Some(wheel), true) => Ok(wheel),
        _ => Err(Failure::Chore(format!(
            "{}: expected one wheel of maturin",
            out.display()
        ))),
    }
}

/// The wheels in a folder.
fn wheels(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let paths = entries.map(|entry| entry.path());
    paths
        .filter(|path| path.extension().is_some_and(|end| end == "whl"))
        .collect()
}
