//! How a chore fails.

use std::process::ExitCode;

/// A chore that did not succeed.
#[derive(Debug)]
pub(crate) enum Failure {
    /// What the user gave cannot be used: exit code 2.
    Input(String),
    /// The chore itself failed: exit code 1.
    Chore(String),
}

impl Failure {
    /// Of something the user gave.
    pub(crate) fn input(error: impl ToString) -> Self {
        Self::Input(error.to_string())
    }

    /// Of the chore itself.
    pub(crate) fn chore(error: impl ToString) -> Self {
        Self::Chore(error.to_string())
    }

    /// Says so on standard error.
    pub(crate) fn report(self) -> ExitCode {
        let (message, code) = match self {
            Self::Input(message) => (message, 2),
            Self::Chore(message) => (message, 1),
        };
        eprintln!("error: {message}");
        ExitCode::from(code)
    }
}
