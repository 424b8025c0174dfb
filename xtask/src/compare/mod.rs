//! `cargo xtask compare`: meshio and pyvista read what sinew-mesh and sinew-record write, jsonschema the schema of scenes.

mod expected;
mod files;
mod run_folder;

use std::path::Path;
use std::process::Stdio;

use sinew_scene::output::{OutputFolder, say};

use crate::failure::Failure;
use crate::python::{Packages, Python, last_line};
use crate::repository::root;

/// The packages that the scripts in `xtask/python` import.
const PACKAGES: Packages = Packages {
    needed_by: "compare",
    folder: "compare",
    names: &["meshio==5.3.5", "pyvista", "numpy", "jsonschema==4.26.0"],
    beside_libraries: false,
};

pub(crate) fn run() -> Result<(), Failure> {
    run_with(&python()?)
}

/// A Python that has meshio and pyvista.
///
/// # Errors
///
/// [`Failure::Input`] if there is no Python 3 or no pip, [`Failure::Chore`] if pip fails.
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
    let read = said_by(python, "read_meshes.py", folder.path())?;
    let overlapping = files::overlapping().map_err(Failure::chore)?;
    let expected = expected::of(&mesh, &overlapping);
    let lines = expected::compare(&read, &expected).map_err(Failure::chore)?;
    let names = names.join(", ");
    say(&format!(
        "meshio and pyvista read what was written: {lines} lines of numbers from {names}"
    ))?;
    compare_run(python)?;
    check_scenes(python)
}

/// Lets jsonschema check the schema of scenes in `docs`, and every scene against it.
fn check_scenes(python: &Python) -> Result<(), Failure> {
    let read = said_by(python, "check_scenes.py", &root())?;
    Ok(say(&format!(
        "jsonschema checks the schema of scenes: {}",
        read.trim_end()
    ))?)
}

/// Runs a scene into a folder, and lets meshio and pyvista compare its fields with its probes.
fn compare_run(python: &Python) -> Result<(), Failure> {
    let folder = root().join("target/compare-run");
    run_folder::write(&folder)?;
    let read = said_by(python, "read_run.py", &folder)?;
    Ok(say(&format!(
        "meshio and pyvista read the folder of a run: {}",
        read.trim_end()
    ))?)
}

/// Output of a script of `xtask/python` for a folder.
fn said_by(python: &Python, script: &str, folder: &Path) -> Result<String, Failure> {
    let script = root().join("xtask/python").join(script);
    let output = python
        .command()
        .arg(&script)
        .arg(folder)
        .stdin(Stdio::null())
        .output()
        .map_err(Failure::chore)?;
    if !output.status.success() {
        let (script, reason) = (script.display(), last_line(&output));
        return Err(Failure::Chore(format!("{script}: {reason}")));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}
