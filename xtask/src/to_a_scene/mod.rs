//! `cargo xtask to-a-scene`: runs the scripts and commands of docs/to-a-scene.md, and those that errors name for
//! files of other programs, as written there.

mod advice;
mod page;
mod place;

use std::fs;

use sinew_scene::output::say;

use self::page::{Block, Page};
use self::place::Place;
use crate::failure::Failure;
use crate::program;
use crate::python::{Packages, Python};
use crate::repository::root;

/// The packages for the page, and that for the advice.
const PACKAGES: Packages = Packages {
    needed_by: "to-a-scene",
    folder: "to-a-scene",
    names: &["gmsh", "SimpleITK", "pyvista", "pytetwild", "meshio[all]"],
    beside_libraries: true,
};

pub(crate) fn run() -> Result<(), Failure> {
    run_with(&python()?)
}

/// A Python that has the packages.
///
/// # Errors
/// [`Failure::Input`] if there is no Python 3 or no pip, [`Failure::Chore`] if pip fails.
pub(crate) fn python() -> Result<Python, Failure> {
    Python::with(&PACKAGES, &root().join("target"))
}

/// Runs all in a folder in `target`, with surfaces, images and meshes that a script makes there.
///
/// # Errors
/// [`Failure::Chore`] for the first command that fails.
pub(crate) fn run_with(python: &Python) -> Result<(), Failure> {
    let text = fs::read_to_string(root().join("docs/to-a-scene.md")).map_err(Failure::chore)?;
    let page = Page::of(&text).map_err(Failure::Chore)?;
    program::build()?;
    let place = Place::new(python)?;
    place.script("page_inputs.py", sinew_mesh::converted_extensions())?;
    for block in &page.blocks {
        match block {
            Block::File { name, text } => place.write(name, text)?,
            Block::Commands(lines) => lines.iter().try_for_each(|line| step(&place, line))?,
        }
    }
    place.script("page_results.py", [])?;
    advice::try_all(&place)
}

/// Runs a line of the page. Packages that it would install are already there.
fn step(place: &Place, line: &str) -> Result<(), Failure> {
    say(&format!("$ {line}"))?;
    let Some(packages) = line.strip_prefix("pip install ") else {
        return place.shell(line).map(drop);
    };
    let known = |name: &&str| PACKAGES.names.contains(name);
    match packages.split_whitespace().find(|name| !known(name)) {
        None => Ok(()),
        Some(name) => Err(Failure::Chore(format!(
            "{line}: {name} is not among the packages of to_a_scene/mod.rs"
        ))),
    }
}
