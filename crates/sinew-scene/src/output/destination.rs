//! Paths that outputs go to, and outputs on their way.

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::OutputError;
use super::identity::Input;
use super::place::Place;
use super::stream::Stream;
use super::whole_file::WholeFile;

/// A path that may be written.
///
/// | path | is |
/// | --- | --- |
/// | `-`, `/dev/stdout` | standard output |
/// | a character device or a pipe | written on as it is |
/// | a new name in a folder that exists | written as a whole or not at all |
/// | a file with a write bit that this run does not read | replaced as a whole or not at all; its mode stays |
/// | an open file whose name was taken away | written on as it is |
/// | a link | the same for what it leads to; the link stays |
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
    place: Place,
}

/// How far an output came.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[must_use]
pub enum Delivery {
    /// All of it was written.
    Whole,
    /// The reader of a pipe went away before the end.
    ReaderLeft,
}

impl Destination {
    /// Checks a path for a run that reads `inputs`; those that do not exist are passed over.
    /// Nothing is made or changed.
    ///
    /// # Errors
    /// [`OutputError`] for a path that is refused.
    pub fn new(path: impl Into<PathBuf>, inputs: &[PathBuf]) -> Result<Self, OutputError> {
        let path = path.into();
        let inputs = Input::all(inputs);
        let place = Place::find(&path, &inputs)?;
        Ok(Self {
            path,
            inputs,
            place,
        })
    }

    /// The path as it was given.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether the output goes to standard output, which should then hold nothing else.
    #[must_use]
    pub fn is_standard_output(&self) -> bool {
        self.place == Place::StandardOutput
    }

    /// Whether the output goes to a device, a pipe, an open file or standard output, which are
    /// written on and not replaced.
    #[must_use]
    pub fn is_stream(&self) -> bool {
        !matches!(self.place, Place::File(_))
    }

    /// Whether both outputs go to one file, so that the later would replace the earlier.
    pub(super) fn is_same_file(&self, other: &Self) -> bool {
        self.place.is_same_file(&other.place)
    }

    /// Begins the output. A named pipe waits for its reader.
    ///
    /// # Errors
    /// [`OutputError::NotOpened`].
    pub fn open(self) -> Result<Output, OutputError> {
        let sink = match &self.place {
            Place::StandardOutput => Ok(Sink::stream(Stream::standard_output())),
            Place::Stream => Stream::open(&self.path).map(Sink::stream),
            Place::File(path) => WholeFile::create(path).map(Sink::Whole),
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

    /// Writes all of an output at once.
    ///
    /// # Errors
    /// [`OutputError`]; a file that was there is then as it was.
    pub fn write(self, content: &[u8]) -> Result<Delivery, OutputError> {
        let mut output = self.open()?;
        if let Err(source) = output.write_all(content) {
            return Err(output.failed(source));
        }
        output.finish()
    }
}

/// An output on its way to its [`Destination`]. A file has another name until [`Output::finish`];
/// dropped before that, it leaves nothing behind.
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
    /// Whether the reader of a pipe went away, so that more output has nobody to go to.
    #[must_use]
    pub fn reader_left(&self) -> bool {
        match &self.sink {
            Sink::Whole(_) => false,
            Sink::Stream(stream) => stream.get_ref().reader_left(),
        }
    }

    /// Completes the output. A file gets its name now, if that may still be written.
    ///
    /// # Errors
    /// [`OutputError`]; a file that was there is then as it was.
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
            place,
        } = destination;
        let finished = match (flushed, sink) {
            (Ok(()), Sink::Whole(file)) => {
                if Place::find(&path, &inputs)? != place {
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

    /// The error of writing to it, with its path.
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
