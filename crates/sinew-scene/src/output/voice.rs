//! Messages of the commands for the user.

use std::io::{self, ErrorKind, Write};
use std::path::PathBuf;

use super::destination::Destination;
use super::error::OutputError;

/// The stream of a command's messages, different from that of its output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Voice {
    /// Standard output.
    StandardOutput,
    /// Standard error.
    StandardError,
}

impl Voice {
    /// The stream that is not used by an output.
    #[must_use]
    pub fn apart_from(destination: &Destination) -> Self {
        if destination.is_standard_output() {
            Self::StandardError
        } else {
            Self::StandardOutput
        }
    }

    /// Writes a text and the end of its line. A reader that closed the stream is not an error.
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

/// Writes a text and the end of its line to standard output. A reader that closed it is not an error.
///
/// # Errors
/// [`OutputError::Failed`] when it cannot be written for any other reason.
pub fn say(text: &str) -> Result<(), OutputError> {
    Voice::StandardOutput.say(text)
}

/// Writes a warning or an error to standard error. Ignores a failure, since there is no other way to report it.
pub fn complain(text: &str) {
    let _ = Voice::StandardError.say(text);
}
