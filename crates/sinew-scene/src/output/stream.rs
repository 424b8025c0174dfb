//! Outputs that are written to directly.

use std::fs::File;
use std::io::{self, ErrorKind, Stdout, Write};
use std::path::Path;

/// Standard output, a device, a pipe or an open file. A reader that closes its pipe is not an error: the rest is
/// discarded.
#[derive(Debug)]
pub(super) struct Stream {
    sink: Sink,
    reader_left: bool,
}

#[derive(Debug)]
enum Sink {
    StandardOutput(Stdout),
    Path(File),
}

impl Stream {
    pub(super) fn standard_output() -> Self {
        Self::on(Sink::StandardOutput(io::stdout()))
    }

    /// Opens the file, device or pipe of the path; a pipe waits for its reader.
    pub(super) fn open(path: &Path) -> io::Result<Self> {
        let file = File::options().append(true).open(path)?;
        Ok(Self::on(Sink::Path(file)))
    }

    fn on(sink: Sink) -> Self {
        Self {
            sink,
            reader_left: false,
        }
    }

    /// True if the reader of a pipe closed it.
    pub(super) fn reader_left(&self) -> bool {
        self.reader_left
    }

    fn unless_left<T>(&mut self, result: io::Result<T>, otherwise: T) -> io::Result<T> {
        match result {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => {
                self.reader_left = true;
                Ok(otherwise)
            }
            result => result,
        }
    }
}

impl Write for Stream {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.reader_left {
            return Ok(bytes.len());
        }
        let written = match &mut self.sink {
            Sink::StandardOutput(stdout) => stdout.write(bytes),
            Sink::Path(file) => file.write(bytes),
        };
        self.unless_left(written, bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = match &mut self.sink {
            Sink::StandardOutput(stdout) => stdout.flush(),
            Sink::Path(file) => file.flush(),
        };
        self.unless_left(flushed, ())
    }
}
