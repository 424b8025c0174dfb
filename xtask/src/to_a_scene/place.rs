//! A folder in which commands find the program, Python's packages and their programs.

use std::ffi::OsString;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

use crate::failure::Failure;
use crate::python::{Python, last_line};
use crate::repository::root;

pub(super) struct Place<'p> {
    python: &'p Python,
    folder: PathBuf,
    path: OsString,
}

impl<'p> Place<'p> {
    /// An empty folder.
    pub(super) fn new(python: &'p Python) -> Result<Self, Failure> {
        let folder = root().join("target/to-a-scene");
        if folder.exists() {
            fs::remove_dir_all(&folder).map_err(Failure::chore)?;
        }
        fs::create_dir_all(&folder).map_err(Failure::chore)?;
        let mut path = vec![root().join("target/release"), python.programs()];
        path.extend(std::env::split_paths(
            &std::env::var_os("PATH").unwrap_or_default(),
        ));
        let path = std::env::join_paths(path).map_err(Failure::chore)?;
        Ok(Self {
            python,
            folder,
            path,
        })
    }

    pub(super) fn write(&self, name: &str, text: &str) -> Result<(), Failure> {
        fs::write(self.folder.join(name), text).map_err(Failure::chore)
    }

    /// Runs a script of `xtask/python`.
    pub(super) fn script<'a>(
        &self,
        name: &str,
        arguments: impl IntoIterator<Item = &'a str>,
    ) -> Result<(), Failure> {
        let mut command = self.python.command();
        command
            .arg(root().join("xtask/python").join(name))
            .args(arguments)
            .current_dir(&self.folder);
        let output = command.output().map_err(Failure::chore)?;
        match output.status.success() {
            true => Ok(()),
            false => Err(Failure::Chore(format!("{name}: {}", last_line(&output)))),
        }
    }

    /// Runs a shell line that must succeed; returns its standard output.
    pub(super) fn shell(&self, line: &str) -> Result<String, Failure> {
        let output = self.outcome(line)?;
        match output.status.success() {
            true => Ok(String::from_utf8_lossy(&output.stdout).into_owned()),
            false => Err(Failure::Chore(format!(
                "{line}: {}: {}{}",
                output.status,
                String::from_utf8_lossy(&output.stdout),
                String::from_utf8_lossy(&output.stderr)
            ))),
        }
    }

    /// Runs a shell line that must be refused; returns its standard error.
    pub(super) fn refusal(&self, line: &str) -> Result<String, Failure> {
        let output = self.outcome(line)?;
        match output.status.success() {
            true => Err(Failure::Chore(format!("{line} is not refused"))),
            false => Ok(String::from_utf8_lossy(&output.stderr).into_owned()),
        }
    }

    fn outcome(&self, line: &str) -> Result<Output, Failure> {
        let mut shell = Command::new("sh");
        // The environment of Python's own command, and the programs.
        for (name, value) in self.python.command().get_envs() {
            shell.env(name, value.unwrap_or_default());
        }
        shell
            .args(["-c", line])
            .env("PATH", &self.path)
            .current_dir(&self.folder);
        shell
            .output()
            .map_err(|error| Failure::Input(format!("cannot run sh: {error}")))
    }
}
