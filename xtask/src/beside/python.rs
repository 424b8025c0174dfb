//! A Python with numpy and scipy, installed by pip into `target/`.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use sinew_bench::output::say;

use crate::failure::Failure;

/// Names a Python goes by.
const NAMES: [&str; 2] = ["python3", "python"];

/// Variables that keep numerical libraries on one thread.
const THREADS: [&str; 3] = ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"];

/// A Python that finds numpy and scipy.
pub(super) struct Python {
    program: &'static str,
    packages: PathBuf,
}

impl Python {
    /// Finds Python and installs numpy and scipy under `target` unless they are there.
    pub(super) fn with_scipy(target: &Path) -> Result<Self, Failure> {
        let (program, version) = find().ok_or_else(|| {
            Failure::Input(
                "--beside scipy needs Python 3, and neither `python3` nor `python` on the PATH is one"
                    .into(),
            )
        })?;
        // Compiled packages belong to one version of Python.
        let packages = target.join(format!("python-{version}"));
        if !packages.exists() {
            install(program, &packages)?;
        }
        Ok(Self { program, packages })
    }

    /// A command that runs this Python on one thread.
    pub(super) fn command(&self) -> Command {
        let mut command = Command::new(self.program);
        command.env("PYTHONPATH", &self.packages);
        for variable in THREADS {
            command.env(variable, "1");
        }
        command
    }
}

/// The first Python 3 on the PATH, with its version as in `3.11`.
fn find() -> Option<(&'static str, String)> {
    let print = "import sys; print('%d.%d' % sys.version_info[:2])";
    NAMES.into_iter().find_map(|name| {
        let output = Command::new(name).args(["-c", print]).output().ok()?;
        let version = String::from_utf8(output.stdout).ok()?.trim().to_owned();
        (output.status.success() && version.starts_with("3.")).then_some((name, version))
    })
}

/// Installs beside `packages` and renames when all is there.
fn install(program: &str, packages: &Path) -> Result<(), Failure> {
    let pip = |arguments: &[&str]| {
        let mut command = Command::new(program);
        command.args(["-m", "pip"]).args(arguments);
        command
    };
    let there = pip(&["--version"]).output().map_err(Failure::chore)?;
    if !there.status.success() {
        return Err(Failure::Input(format!(
            "--beside scipy needs pip, and `{program} -m pip` says: {}",
            last_line(&there)
        )));
    }
    say("installing numpy and scipy into target/ ...")?;
    let partial = packages.with_extension(format!("{}.tmp", std::process::id()));
    let installed = pip(&["install", "--quiet", "--disable-pip-version-check"])
        .args(["--only-binary", ":all:", "numpy", "scipy", "--target"])
        .arg(&partial)
        .output()
        .map_err(|error| error.to_string())
        .and_then(|output| match output.status.success() {
            true => Ok(()),
            false => Err(last_line(&output)),
        })
        .and_then(|()| std::fs::rename(&partial, packages).map_err(|error| error.to_string()));
    installed.map_err(|reason| {
        // The first error is the one to tell.
        let _ = std::fs::remove_dir_all(&partial);
        Failure::Chore(format!(
            "`{program} -m pip install numpy scipy` failed: {reason}"
        ))
    })
}

/// What a failed program said last: the reason, after warnings and traces.
pub(super) fn last_line(output: &Output) -> String {
    let said = String::from_utf8_lossy(&output.stderr);
    let errors = said.lines().rev().filter(|line| !line.trim().is_empty());
    let mut errors = errors.map(str::trim);
    errors.next().unwrap_or("nothing").to_owned()
}
