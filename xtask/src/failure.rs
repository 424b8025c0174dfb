//! Failures of a chore and their exit codes.

use std::process::ExitCode;

use sinew_scene::output::{OutputError, complain};

/// A chore that did not succeed.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The user's input cannot be used: exit code 2.
    Input(String),
    /// The chore itself failed: exit code 1.
    Chore(String),
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        if error.is_refusal() {
            Self::input(error)
        } else {
            Self::chore(error)
        }
    }
}

impl Failure {
    /// A failure due to the user's input.
    pub(crate) fn input(error: impl ToString) -> Self {
        Self::Input(error.to_string())
    }

    /// A failure of the chore itself.
    pub(crate) fn chore(error: impl ToString) -> Self {
        Self::Chore(error.to_string())
    }

    /// Reports the failure on standard error and returns its exit code.
    pub(crate) fn report(self) -> ExitCode {
        let (message, code) = match self {
            Self::Input(message) => (message, 2),
            Self::Chore(message) => (message, 1),
        };
        complain(&format!("error: {message}"));
        ExitCode::from(code)
    }
}
