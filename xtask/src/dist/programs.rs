//! Programs for building archives and packages.

use std::process::Command;

use crate::failure::Failure;

/// Runs a program that reports its own errors.
pub(crate) fn finish(command: &mut Command) -> Result<(), Failure> {
    let status = command.status().map_err(|error| missing(command, &error))?;
    match status.success() {
        true => Ok(()),
        false => Err(Failure::Chore(format!("{command:?}: {status}"))),
    }
}

/// Standard output of a program.
pub(super) fn text_of(command: &mut Command) -> Result<String, Failure> {
    let output = command.output().map_err(|error| missing(command, &error))?;
    match output.status.success() {
        true => Ok(String::from_utf8_lossy(&output.stdout).into_owned()),
        false => Err(Failure::Chore(format!(
            "{command:?}: {}: {}",
            output.status,
            String::from_utf8_lossy(&output.stderr)
        ))),
    }
}

fn missing(command: &Command, error: &std::io::Error) -> Failure {
    let program = command.get_program().to_string_lossy();
    Failure::Input(format!(
        "cannot run {program}: {error}; archives and packages need cargo, git and tar"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_program_is_named() {
        let failure = text_of(&mut Command::new("no-such-program")).unwrap_err();
        let Failure::Input(message) = failure else {
            panic!("{failure:?}");
        };
        assert!(message.contains("cannot run no-such-program"), "{message}");
    }
}
