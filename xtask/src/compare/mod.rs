//! `cargo xtask compare`: meshio and pyvista read what sinew-mesh writes.

mod expected;
mod files;

use std::process::Stdio;

use sinew_bench::output::{OutputFolder, say};

use crate::failure::Failure;
use crate::python::{Packages, Python, last_line};
use crate::repository::root;

/// The packages that `xtask/python/read_meshes.py` imports.
const PACKAGES: Packages = Packages {
    needed_by: "compare",
    folder: "meshio",
    names: &["meshio==5.3.5", "pyvista", "numpy"],
    beside_libraries: false,
};

pub(crate) fn run() -> Result<(), Failure> {
    run_with(&python()?)
}

/// A Python that has meshio and pyvista.
///
/// # Errors
///
/// [`Failure::Input`] where there is no Python 3 or no pip, [`Failure::Chore`] where pip fails.
pub(crate) fn python() -> Result<Python, Failure> {
    Python::with(&PACKAGES, &root().join("target"))
}

/// Writes meshes in all formats, lets meshio and pyvista read them and compares every number.
pub(crate) fn run_with(python: &Python) -> Result<(), Failure> {
    let folder = OutputFolder::new(root().join("target/compare"), &[]);
    let mesh = files::mesh().map_err(Failure::chore)?;
    let files = files::all(&mesh).map_err(Failure::chore)?;
    let names: Vec<String> = files.iter().map(|(name, _)| (*name).to_owned()).collect();
    folder.check(&names)?;
    for (name, bytes) in &files {
        let _ = folder.write(name, bytes)?;
    }
    let script = root().join("xtask/python/read_meshes.py");
    let output = python
        .command()
        .arg(&script)
        .arg(folder.path())
        .stdin(Stdio::null())
        .output()
        .map_err(Failure::chore)?;
    if !output.status.success() {
        let (script, reason) = (script.display(), last_line(&output));
        return Err(Failure::Chore(format!("{script}: {reason}")));
    }
    let read = String::from_utf8_lossy(&output.stdout);
    let overlapping = files::overlapping().map_err(Failure::chore)?;
    let expected = expected::of(&mesh, &overlapping);
    let lines = expected::compare(&read, &expected).map_err(Failure::chore)?;
    let names = names.join(", ");
    Ok(say(&format!(
        "meshio and pyvista read what was written: {lines} lines of numbers from {names}"
    ))?)
}
