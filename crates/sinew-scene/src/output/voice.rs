//! What commands say to people.

use std::io::{self, ErrorKind, Write};
use std::path::PathBuf;

use super::{Destination, OutputError};

/// Where a command speaks: not where its output goes, so that the output stays clean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Voice {
    /// Standard output.
    StandardOutput,
    /// Standard error.
    StandardError,
}

impl Voice {
    /// The one that leaves an output to itself.
    #[must_use]
    pub fn beside(destination: &Destination) -> Self {
        if destination.is_standard_output() {
            Self::StandardError
        } else {
            Self::StandardOutput
        }
    }

    /// Writes a text and the end of its line. A reader that went away is no failure.
    ///
    /// # Errors
    /// [`OutputError::Failed`] when it cannot be written for any other reason.
    pub fn say(self, text: &str) -> Result<(), OutputError> {
        let (written, name) = match self {
            Self::StandardOutput => (line(io::stdout().lock(), text), "standard output"),
            Self::StandardError => (line(io::stderr().lock(), text), "standard error"),
        };
        match written {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
            Err(source) => Err(OutputError::Failed {
                path: PathBuf::from(name),
                source,
            }),
            Ok(()) => Ok(()),
        }
    }
}

fn line(mut stream: impl Write, text: &str) -> io::Result<()> {
    writeln!(stream, "{text}")?;
    stream.flush()
}

/// Writes a text and the end of its line to standard output. A reader that went away is no failure.
///
/// # Errors
/// [`OutputError::Failed`] when it cannot be written for any other reason.
pub fn say(text: &str) -> Result<(), OutputError> {
    Voice::StandardOutput.say(text)
}

/// Writes a warning or an error to standard error. Where that fails there is nobody left to tell.
pub fn complain(text: &str) {
    let _ = Voice::StandardError.say(text);
}
