//! A mesh from gmsh that is too large to be committed.

use std::path::PathBuf;

use sinew_scene::output::say;

use crate::failure::Failure;
use crate::python::{Packages, Python, last_line};
use crate::repository::root;

/// The package that `xtask/python/generate_block.py` imports.
const PACKAGES: Packages = Packages {
    needed_by: "the mesh of gmsh",
    folder: "gmsh",
    names: &["gmsh==4.15.2"],
    beside_libraries: true,
};

/// The file of a block of some 50,000 tetrahedra, which gmsh creates unless it exists; `None`, after a line with the
/// reason, if this fails.
pub(crate) fn block() -> Result<Option<PathBuf>, Failure> {
    let target = root().join("target");
    let file = target.join("gmsh-block.msh");
    if file.exists() {
        return Ok(Some(file));
    }
    let python = Python::with(&PACKAGES, &target);
    let made = python.map_err(|failure| match failure {
        Failure::Input(reason) | Failure::Chore(reason) => reason,
    });
    let made = made.and_then(|python| {
        // Under another name until it is whole.
        let partial = target.join(format!("gmsh-block-{}.msh", std::process::id()));
        let script = root().join("xtask/python/generate_block.py");
        let output = python.command().arg(script).arg(&partial).output();
        let output = output.map_err(|error| error.to_string())?;
        if !output.status.success() {
            return Err(last_line(&output));
        }
        std::fs::rename(&partial, &file).map_err(|error| error.to_string())
    });
    match made {
        Ok(()) => Ok(Some(file)),
        Err(reason) => {
            say(&format!("SKIPPED: the mesh of gmsh: {reason}"))?;
            Ok(None)
        }
    }
}
