//! How a command fails: one message, and the line of the scene where there is one.

use std::process::ExitCode;

use miette::{LabeledSpan, NamedSource, Report, miette};
use sinew_scene::SceneError;
use sinew_scene::output::{OutputError, complain};

/// A command that did not succeed.
#[derive(Debug)]
pub(crate) enum Failure {
    /// A scene that cannot be used: exit code 2.
    Scene(SceneError),
    /// Anything else that was given and cannot be used: exit code 2.
    Input(String),
    /// A check found something and said so: exit code 1.
    Findings,
    /// The run itself failed: exit code 1.
    Run(String),
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        Self::Scene(error)
    }
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        if error.is_refusal() {
            Self::Input(error.to_string())
        } else {
            Self::Run(error.to_string())
        }
    }
}

impl Failure {
    /// Says so on standard error.
    pub(crate) fn report(self) -> ExitCode {
        match self {
            Self::Scene(error) => {
                complain(&format!("error: {error}"));
                if let Some(report) = excerpt(&error) {
                    complain(&format!("{report:?}"));
                }
                ExitCode::from(2)
            }
            Self::Input(message) => {
                complain(&format!("error: {message}"));
                ExitCode::from(2)
            }
            Self::Findings => ExitCode::from(1),
            Self::Run(message) => {
                complain(&format!("error: {message}"));
                ExitCode::from(1)
            }
        }
    }
}

/// The text at fault with a mark under it, and the hint.
fn excerpt(error: &SceneError) -> Option<Report> {
    let span = error.span()?;
    let label = LabeledSpan::at(span, error.fault().to_string());
    let help = error.help().unwrap_or_default();
    let source = NamedSource::new(
        error.path().display().to_string(),
        error.source_text().to_owned(),
    );
    let report = if help.is_empty() {
        miette!(labels = vec![label], "in the scene")
    } else {
        miette!(labels = vec![label], help = help, "in the scene")
    };
    Some(report.with_source_code(source))
}
