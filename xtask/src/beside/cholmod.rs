//! CHOLMOD's factors, computed in a separate program.

use std::path::{Path, PathBuf};
use std::process::Command;

use sinew_bench::beside::RivalError;
use sinew_bench::beside::factor::FactorLibrary;

use super::conversation::{Conversation, numbers};
use crate::repository::root;

/// Folders of CHOLMOD's header besides the compiler's own.
const INCLUDE: &str = "/usr/include/suitesparse";

/// Variables that keep BLAS on one thread.
const THREADS: [&str; 3] = ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"];

/// The compiled program `xtask/c/cholmod.c`.
pub(super) struct Driver(PathBuf);

impl Driver {
    /// Compiles the program into a folder.
    ///
    /// # Errors
    /// One line that names the missing program.
    pub(super) fn build(folder: &Path) -> Result<Self, String> {
        std::fs::create_dir_all(folder)
            .map_err(|error| format!("{}: {error}", folder.display()))?;
        let program = folder.join("driver");
        let output = Command::new("cc")
            .args(["-O2", "-I", INCLUDE, "-o"])
            .args([&program, &root().join("xtask/c/cholmod.c")])
            .arg("-lcholmod")
            .output()
            .map_err(|error| format!("no C compiler for CHOLMOD's driver: cc: {error}"))?;
        if output.status.success() {
            return Ok(Self(program));
        }
        let said = String::from_utf8_lossy(&output.stderr);
        let reason = said
            .lines()
            .find(|line| line.contains("error") || line.contains("cannot find"));
        Err(format!(
            "CHOLMOD is not installed (libsuitesparse-dev, and a fast BLAS such as libopenblas0): {}",
            reason.unwrap_or("its driver does not compile").trim()
        ))
    }

    /// Starts it on a folder with a matrix.
    pub(super) fn start(&self, folder: &Path) -> Result<Cholmod, String> {
        let mut command = Command::new(&self.0);
        for variable in THREADS {
            command.env(variable, "1");
        }
        let mut program = Conversation::start("CHOLMOD's driver", command.arg(folder))?;
        let hello = program.ask("hello")?;
        let (name, _) = hello.split_once(';').unwrap_or((&hello, ""));
        Ok(Cholmod {
            name: name.to_owned(),
            folder: folder.to_owned(),
            program,
        })
    }
}

/// The running program.
pub(super) struct Cholmod {
    name: String,
    folder: PathBuf,
    program: Conversation,
}

impl FactorLibrary for Cholmod {
    fn factorise(&mut self) -> Result<f64, RivalError> {
        self.program.time("factorise")
    }

    fn solve(&mut self) -> Result<f64, RivalError> {
        self.program.time("solve")
    }

    fn solution(&mut self) -> Result<Vec<f64>, RivalError> {
        self.program.ask("solution")?;
        numbers(&self.folder.join("solution.f64"))
    }

    fn name(&self) -> String {
        self.name.clone()
    }
}
