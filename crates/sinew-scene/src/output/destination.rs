//! Paths that may be written, and outputs while they are written.

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::error::OutputError;
use super::identity::{Input, standard_output_is_file};
use super::stream::Stream;
use super::target::{Target, folder_of};
use super::whole_file::{WholeFile, remove_left_behind};

/// A path that was checked and may be written.
///
/// | path | what happens to it |
/// | --- | --- |
/// | `-`, `/dev/stdout` | stands for standard output |
/// | a character device or a pipe | written to as it is |
/// | a new name in a folder that exists | written as a whole or not at all |
/// | a file with a write bit that this run does not read | replaced as a whole or not at all; its mode stays |
/// | an open file whose name was removed | written to as it is |
/// | a link | its target is treated as above; the link stays |
///
/// ```
/// use sinew_scene::output::Destination;
///
/// let scene = std::env::current_dir()?.join("Cargo.toml");
/// let refused = Destination::new(&scene, &[scene.clone()]).expect_err("an input");
/// assert!(refused.to_string().ends_with("this run reads it; name another file"));
/// assert!(Destination::new("-", &[scene])?.is_standard_output());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Destination {
    path: PathBuf,
    inputs: Vec<Input>,
    target: Target,
}

/// The part of an output that was written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[must_use]
pub enum Delivery {
    /// All of it was written.
    Whole,
    /// Only a part was written: the reader of a pipe closed it before the end.
    ReaderLeft,
}

impl Destination {
    /// Checks a path for a run that reads `inputs`; inputs that do not exist are ignored.
    /// Creates and changes nothing.
    ///
    /// # Errors
    /// [`OutputError`] for a path that is refused.
    pub fn new(path: impl Into<PathBuf>, inputs: &[PathBuf]) -> Result<Self, OutputError> {
        let path = path.into();
        let inputs = Input::all(inputs);
        let target = Target::find(&path, &inputs)?;
        Ok(Self {
            path,
            inputs,
            target,
        })
    }

    /// The path as given.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// True if the output goes to standard output, which should then contain nothing else.
    #[must_use]
    pub fn is_standard_output(&self) -> bool {
        self.target == Target::StandardOutput
    }

    /// True if the output goes to a device, a pipe, an open file or standard output; these are written to and not
    /// replaced.
    #[must_use]
    pub fn is_stream(&self) -> bool {
        !matches!(self.target, Target::File(_))
    }

    /// True if the output stays in a file, and does not pass through a pipe or a device.
    #[must_use]
    pub fn is_kept(&self) -> bool {
        match &self.target {
            Target::File(_) => true,
            Target::StandardOutput => standard_output_is_file(),
            Target::Stream => std::fs::metadata(&self.path).is_ok_and(|found| found.is_file()),
        }
    }

    /// True if both outputs go to the same file, so that the second would replace the first.
    pub(super) fn is_same_file(&self, other: &Self) -> bool {
        self.target.is_same_file(&other.target)
    }

    /// Opens the output. For a named pipe it waits for the reader.
    ///
    /// # Errors
    /// [`OutputError::NotOpened`].
    pub fn open(self) -> Result<Output, OutputError> {
        let sink = match &self.target {
            Target::StandardOutput => Ok(Sink::stream(Stream::standard_output())),
            Target::Stream => Stream::open(&self.path).map(Sink::stream),
            Target::File(path) => {
                remove_left_behind(folder_of(path));
                WholeFile::create(path).map(Sink::Whole)
            }
        };
        match sink {
            Ok(sink) => Ok(Output {
                destination: self,
                sink,
            }),
            Err(source) => Err(OutputError::NotOpened {
                path: self.path,
                source,
            }),
        }
    }

    /// Writes the whole output.
    ///
    /// # Errors
    /// [`OutputError`]; an existing file is then unchanged.
    pub fn write(self, content: &[u8]) -> Result<Delivery, OutputError> {
        let mut output = self.open()?;
        if let Err(source) = output.write_all(content) {
            return Err(output.failed(source));
        }
        output.finish()
    }
}

/// An output that is being written to its [`Destination`]. A file has a temporary name until
/// [`Output::finish`]; dropped before that, it leaves nothing behind.
#[derive(Debug)]
pub struct Output {
    destination: Destination,
    sink: Sink,
}

#[derive(Debug)]
enum Sink {
    Whole(WholeFile),
    Stream(BufWriter<Stream>),
}

impl Sink {
    fn stream(stream: Stream) -> Self {
        Self::Stream(BufWriter::new(stream))
    }
}

impl Output {
    /// True if the reader of a pipe closed it, so that further output is not read.
    #[must_use]
    pub fn reader_left(&self) -> bool {
        match &self.sink {
            Sink::Whole(_) => false,
            Sink::Stream(stream) => stream.get_ref().reader_left(),
        }
    }

    /// Completes the output. A file gets its final name, if a file of this name may still be written.
    ///
    /// # Errors
    /// [`OutputError`]; an existing file is then unchanged.
    pub fn finish(mut self) -> Result<Delivery, OutputError> {
        let flushed = self.flush();
        let delivery = if self.reader_left() {
            Delivery::ReaderLeft
        } else {
            Delivery::Whole
        };
        let Self { destination, sink } = self;
        let Destination {
            path,
            inputs,
            target,
        } = destination;
        let finished = match (flushed, sink) {
            (Ok(()), Sink::Whole(file)) => {
                if Target::find(&path, &inputs)? != target {
                    return Err(OutputError::Changed { path });
                }
                file.finish()
            }
            (flushed, _) => flushed,
        };
        match finished {
            Ok(()) => Ok(delivery),
            Err(source) => Err(OutputError::Failed { path, source }),
        }
    }

    /// An error while writing, with the path.
    pub(crate) fn failed(&self, source: io::Error) -> OutputError {
        OutputError::Failed {
            path: self.destination.path.clone(),
            source,
        }
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.sink {
            Sink::Whole(file) => file.write(bytes),
            Sink::Stream(stream) => stream.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.sink {
            Sink::Whole(file) => file.flush(),
            Sink::Stream(stream) => stream.flush(),
        }
    }
}
