//! CHOLMOD's factors, made in a program of its own.

use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, ChildStdin, ChildStdout, Command, Stdio};

use sinew_bench::beside::RivalError;
use sinew_bench::beside::factor::FactorLibrary;

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
    /// One line that says what is missing.
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
        let mut child = command
            .arg(folder)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| format!("{}: {error}", self.0.display()))?;
        let pipes = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        let (Some(commands), Some(answers), Some(errors)) = pipes else {
            return Err("CHOLMOD's driver was started without pipes".into());
        };
        let mut cholmod = Cholmod {
            name: String::new(),
            folder: folder.to_owned(),
            child,
            commands,
            answers: BufReader::new(answers),
            errors,
        };
        let hello = cholmod.ask("hello")?;
        let (name, _) = hello.split_once(';').unwrap_or((&hello, ""));
        cholmod.name = name.to_owned();
        Ok(cholmod)
    }
}

/// The running program.
pub(super) struct Cholmod {
    name: String,
    folder: PathBuf,
    child: Child,
    commands: ChildStdin,
    answers: BufReader<ChildStdout>,
    errors: ChildStderr,
}

impl Cholmod {
    /// Sends a command and returns the line that answers it.
    fn ask(&mut self, command: &str) -> Result<String, String> {
        let mut answer = String::new();
        let asked = writeln!(self.commands, "{command}").and_then(|()| self.commands.flush());
        let read = asked.and_then(|()| self.answers.read_line(&mut answer));
        if matches!(read, Ok(bytes) if bytes > 0) {
            return Ok(answer.trim_end().to_owned());
        }
        let mut said = String::new();
        // The program's own message says more than the failure to read from it.
        let _ = self.errors.read_to_string(&mut said);
        let reason = said.trim_end().lines().last().unwrap_or("it said nothing");
        Err(format!("CHOLMOD's driver ended at `{command}`: {reason}"))
    }

    fn time(&mut self, command: &str) -> Result<f64, RivalError> {
        let answer = self.ask(command)?;
        let time = answer.parse().ok().filter(|time| *time > 0.0);
        time.ok_or_else(|| format!("CHOLMOD's driver answered {answer} instead of a time").into())
    }
}

impl FactorLibrary for Cholmod {
    fn factorise(&mut self) -> Result<f64, RivalError> {
        self.time("factorise")
    }

    fn solve(&mut self) -> Result<f64, RivalError> {
        self.time("solve")
    }

    fn solution(&mut self) -> Result<Vec<f64>, RivalError> {
        self.ask("solution")?;
        let path = self.folder.join("solution.f64");
        let bytes = std::fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let (numbers, _) = bytes.as_chunks();
        Ok(numbers.iter().map(|&n| f64::from_le_bytes(n)).collect())
    }

    fn name(&self) -> String {
        self.name.clone()
    }
}

impl Drop for Cholmod {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
