//! scipy's central difference, run step by step in a program of its own.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStderr, ChildStdin, ChildStdout, Stdio};

use serde_json::Value;
use sinew_bench::beside::{Exported, Rival, RivalError};

use crate::python::Python;
use crate::repository::root;

/// Step (s).
const DT: f64 = 1e-3;

/// The running script `xtask/python/central_difference.py`.
pub(super) struct Scipy {
    name: String,
    exported: Exported,
    child: Child,
    commands: ChildStdin,
    answers: BufReader<ChildStdout>,
    errors: ChildStderr,
}

impl Scipy {
    /// Starts the script on an exported system.
    pub(super) fn start(python: &Python, exported: &Exported) -> Result<Self, String> {
        let script = root().join("xtask/python/central_difference.py");
        let mut child = python
            .command()
            .arg(&script)
            .arg(&exported.directory)
            .arg(DT.to_string())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| format!("{}: {error}", script.display()))?;
        let pipes = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        let (Some(commands), Some(answers), Some(errors)) = pipes else {
            return Err("the script was started without pipes".into());
        };
        let mut scipy = Self {
            name: "scipy".into(),
            exported: exported.clone(),
            child,
            commands,
            answers: BufReader::new(answers),
            errors,
        };
        let hello = scipy.ask("hello")?;
        let versions: Value = serde_json::from_str(&hello).map_err(|error| error.to_string())?;
        let version = |of: &str| versions[of].as_str().unwrap_or("?").to_owned();
        scipy.name = format!(
            "scipy {} (numpy {}, Python {})",
            version("scipy"),
            version("numpy"),
            version("python")
        );
        Ok(scipy)
    }

    /// Sends a command and returns the line that answers it.
    fn ask(&mut self, command: &str) -> Result<String, String> {
        let mut answer = String::new();
        let asked = writeln!(self.commands, "{command}").and_then(|()| self.commands.flush());
        let read = asked.and_then(|()| self.answers.read_line(&mut answer));
        if matches!(read, Ok(bytes) if bytes > 0) {
            return Ok(answer.trim_end().to_owned());
        }
        let mut said = String::new();
        // The script's own message says more than the failure to read from it.
        let _ = self.errors.read_to_string(&mut said);
        let reason = said.trim_end().lines().last().unwrap_or("it said nothing");
        Err(format!("scipy's script ended at `{command}`: {reason}"))
    }
}

impl Rival for Scipy {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn same(&self) -> (&'static str, f64) {
        ("central-difference", DT)
    }

    fn lap(&mut self) -> Result<f64, RivalError> {
        let answer = self.ask("lap")?;
        let time = answer.parse().ok().filter(|time| *time > 0.0);
        time.ok_or_else(|| format!("scipy's script answered {answer} instead of a time").into())
    }

    fn displacements(&mut self) -> Result<Vec<Vec<f64>>, RivalError> {
        self.ask("displacements")?;
        let path = self.exported.directory.join("displacements.f64");
        let bytes = std::fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let (numbers, _) = bytes.as_chunks();
        let numbers: Vec<f64> = numbers.iter().map(|&n| f64::from_le_bytes(n)).collect();
        let samples = numbers.chunks(self.exported.dofs);
        Ok(samples.map(<[f64]>::to_vec).collect())
    }
}

impl Drop for Scipy {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
