//! A Python interpreter with packages that pip installs into `target/`.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use sinew_scene::output::say;

use crate::failure::Failure;

/// Names under which Python is installed.
const NAMES: [&str; 2] = ["python3", "python"];

/// Variables that keep numerical libraries on one thread.
const THREADS: [&str; 3] = ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"];

/// Packages that are installed together.
pub(crate) struct Packages {
    /// The command or option that needs them, for messages.
    pub(crate) needed_by: &'static str,
    /// The end of the name of their folder in `target/`.
    pub(crate) folder: &'static str,
    /// Names and versions in pip's form.
    pub(crate) names: &'static [&'static str],
    /// True if they contain libraries next to the modules, which pip's `--target` leaves out.
    pub(crate) beside_libraries: bool,
}

/// A Python that finds the installed packages.
pub(crate) struct Python {
    program: &'static str,
    packages: PathBuf,
    programs: PathBuf,
}

impl Python {
    /// Finds Python and installs the packages under `target` if absent.
    ///
    /// # Errors
    ///
    /// [`Failure::Input`] if there is no Python 3 or no pip, [`Failure::Chore`] if pip fails.
    pub(crate) fn with(packages: &Packages, target: &Path) -> Result<Self, Failure> {
        let (program, version) = find().ok_or_else(|| {
            Failure::Input(format!(
                "{} needs Python 3, and neither `python3` nor `python` on the PATH is one",
                packages.needed_by
            ))
        })?;
        // Compiled packages belong to one version of Python.
        let folder = target.join(format!("python-{version}-{}", packages.folder));
        if !folder.exists() {
            install(program, packages, &folder)?;
        }
        // With --prefix modules lie deeper, where depends on the system.
        let inside = packages
            .beside_libraries
            .then(|| modules(&folder))
            .flatten();
        Ok(Self {
            program,
            programs: folder.join("bin"),
            packages: inside.unwrap_or(folder),
        })
    }

    /// The folder of programs that packages install.
    pub(crate) fn programs(&self) -> PathBuf {
        self.programs.clone()
    }

    /// A command that runs this Python on one thread.
    pub(crate) fn command(&self) -> Command {
        let mut command = Command::new(self.program);
        command.env("PYTHONPATH", &self.packages);
        for variable in THREADS {
            command.env(variable, "1");
        }
        command
    }
}

/// The first Python 3 on the PATH, with its version as in `3.11`.
pub(crate) fn find() -> Option<(&'static str, String)> {
    let print = "import sys; print('%d.%d' % sys.version_info[:2])";
    NAMES.into_iter().find_map(|name| {
        let output = Command::new(name).args(["-c", print]).output().ok()?;
        let version = String::from_utf8(output.stdout).ok()?.trim().to_owned();
        (output.status.success() && version.starts_with("3.")).then_some((name, version))
    })
}

/// Installs into a temporary folder and renames it when the installation is complete.
fn install(program: &str, packages: &Packages, folder: &Path) -> Result<(), Failure> {
    let pip = |arguments: &[&str]| {
        let mut command = Command::new(program);
        command.args(["-m", "pip"]).args(arguments);
        command
    };
    let there = pip(&["--version"]).output().map_err(Failure::chore)?;
    if !there.status.success() {
        return Err(Failure::Input(format!(
            "{} needs pip, and `{program} -m pip` says: {}",
            packages.needed_by,
            last_line(&there)
        )));
    }
    let names = packages.names.join(" ");
    say(&format!("installing {names} into target/ ..."))?;
    let partial = folder.with_extension(format!("{}.tmp", std::process::id()));
    let installed = pip(&["install", "--quiet", "--disable-pip-version-check"])
        .args(["--only-binary", ":all:"])
        .args(packages.names)
        .args(match packages.beside_libraries {
            // What Python has already may lack its programs on the PATH.
            true => &["--ignore-installed", "--prefix"][..],
            false => &["--target"],
        })
        .arg(&partial)
        .output()
        .map_err(|error| error.to_string())
        .and_then(|output| match output.status.success() {
            true => Ok(()),
            false => Err(last_line(&output)),
        })
        .and_then(|()| std::fs::rename(&partial, folder).map_err(|error| error.to_string()));
    installed.map_err(|reason| {
        // The first error is the one to report.
        let _ = std::fs::remove_dir_all(&partial);
        Failure::Chore(format!(
            "`{program} -m pip install {names}` failed: {reason}"
        ))
    })
}

/// The folder of modules under a prefix.
fn modules(prefix: &Path) -> Option<PathBuf> {
    let inside = |folder: PathBuf| {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        entries.map(|entry| entry.path()).collect::<Vec<_>>()
    };
    let libraries = [
        prefix.join("lib"),
        prefix.join("local/lib"),
        prefix.join("Lib"),
    ];
    let mut folders: Vec<PathBuf> = libraries.into_iter().flat_map(inside).collect();
    folders.extend([prefix.join("Lib")]);
    let mut packages = folders
        .iter()
        .flat_map(|folder| ["site-packages", "dist-packages"].map(|name| folder.join(name)));
    packages.find(|folder| folder.is_dir())
}

/// The last line that a failed program printed, which is its reason, after warnings and traces.
pub(crate) fn last_line(output: &Output) -> String {
    let said = String::from_utf8_lossy(&output.stderr);
    let errors = said.lines().rev().filter(|line| !line.trim().is_empty());
    let mut errors = errors.map(str::trim);
    errors.next().unwrap_or("nothing").to_owned()
}
