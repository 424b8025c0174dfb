//! A program that answers each input line with one line.

use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStderr, ChildStdin, ChildStdout, Command, Stdio};

use sinew_bench::beside::RivalError;

/// The running program; it ends when this value is dropped.
pub(super) struct Conversation {
    /// Name of the program in messages.
    name: &'static str,
    child: Child,
    commands: ChildStdin,
    answers: BufReader<ChildStdout>,
    errors: ChildStderr,
}

impl Conversation {
    /// Starts a program.
    pub(super) fn start(name: &'static str, command: &mut Command) -> Result<Self, String> {
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| format!("{}: {error}", command.get_program().display()))?;
        let pipes = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        let (Some(commands), Some(answers), Some(errors)) = pipes else {
            return Err(format!("{name} was started without pipes"));
        };
        Ok(Self {
            name,
            child,
            commands,
            answers: BufReader::new(answers),
            errors,
        })
    }

    /// Sends a command and returns the line that answers it.
    pub(super) fn ask(&mut self, command: &str) -> Result<String, String> {
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
        Err(format!("{} ended at `{command}`: {reason}", self.name))
    }

    /// Like [`Conversation::ask`], for a CPU time (s).
    pub(super) fn time(&mut self, command: &str) -> Result<f64, RivalError> {
        let answer = self.ask(command)?;
        let time = answer.parse().ok().filter(|time| *time > 0.0);
        time.ok_or_else(|| format!("{} answered {answer} instead of a time", self.name).into())
    }
}

impl Drop for Conversation {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The numbers in a file of a program.
pub(super) fn numbers(path: &Path) -> Result<Vec<f64>, RivalError> {
    let bytes = std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let (numbers, _) = bytes.as_chunks();
    Ok(numbers.iter().map(|&n| f64::from_le_bytes(n)).collect())
}
