//! Virtual environments of Python in `target/`, for packages with programs and for packages of this repository.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use sinew_scene::output::say;

use crate::failure::Failure;
use crate::python::{find, last_line};

/// The file that lists the contents of an environment, written when it is complete.
const COMPLETE: &str = "complete.txt";

/// The oldest Python that the package supports.
const OLDEST: (u32, u32) = (3, 10);

/// A virtual environment.
pub(crate) struct Environment {
    folder: PathBuf,
}

impl Environment {
    /// The environment with these packages under `target`, created if absent.
    ///
    /// # Errors
    /// [`Failure::Input`] if there is no Python 3.10 or later with venv and pip, [`Failure::Chore`] if pip fails.
    pub(crate) fn with(name: &str, packages: &[&str], target: &Path) -> Result<Self, Failure> {
        let (program, version) = supported()?;
        let own = Self {
            folder: target.join(format!("python-{version}-{name}")),
        };
        let wanted = packages.join("\n");
        let complete = own.folder.join(COMPLETE);
        if fs::read_to_string(&complete).is_ok_and(|found| found == wanted) {
            return Ok(own);
        }
        if own.folder.exists() {
            fs::remove_dir_all(&own.folder).map_err(Failure::chore)?;
        }
        say(&format!(
            "making an environment of Python {version} with {} in target/ ...",
            packages.join(" ")
        ))?;
        let mut make = Command::new(program);
        make.args(["-m", "venv"]).arg(&own.folder);
        let made = make.output().map_err(Failure::chore)?;
        if !made.status.success() {
            return Err(Failure::Input(format!(
                "`{program} -m venv` says: {}",
                last_line(&made)
            )));
        }
        if !packages.is_empty() {
            own.install(packages)?;
        }
        fs::write(complete, wanted).map_err(Failure::chore)?;
        Ok(own)
    }

    /// Installs packages, or files of packages, and replaces those of the same name.
    pub(crate) fn install(&self, packages: &[&str]) -> Result<(), Failure> {
        let mut pip = self.python();
        pip.args(["-m", "pip", "install", "--quiet"])
            .args(["--disable-pip-version-check", "--prefer-binary"])
            .args(packages);
        let output = pip.output().map_err(Failure::chore)?;
        match output.status.success() {
            true => Ok(()),
            false => Err(Failure::Chore(format!(
                "`pip install {}`: {}",
                packages.join(" "),
                last_line(&output)
            ))),
        }
    }

    /// Runs its Python.
    pub(crate) fn python(&self) -> Command {
        self.program("python")
    }

    /// A command for a program that a package installed.
    pub(crate) fn program(&self, name: &str) -> Command {
        Command::new(self.folder.join("bin").join(name))
    }
}

/// A Python that the package supports, with its version as in `3.11`.
fn supported() -> Result<(&'static str, String), Failure> {
    let (major, minor) = OLDEST;
    let needed = format!("the Python package needs Python {major}.{minor} or later with pip");
    let Some((program, version)) = find() else {
        return Err(Failure::Input(format!(
            "{needed}, and neither `python3` nor `python` on the PATH is one"
        )));
    };
    let own = version.split_once('.');
    let own = own.and_then(|(major, minor)| Some((major.parse().ok()?, minor.parse().ok()?)));
    match own {
        Some(own) if own >= OLDEST => Ok((program, version)),
        _ => Err(Failure::Input(format!(
            "{needed}: `{program}` is {version}"
        ))),
    }
}
