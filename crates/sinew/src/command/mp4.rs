//! Films as mp4, by ffmpeg.

use std::fs;
use std::io::{self, Read, Write};
use std::process::{Child, Command, Stdio};

use sinew_film::{Picture, Size};
use tempfile::TempDir;

/// The program.
const FFMPEG: &str = "ffmpeg";

/// The name of the film in a temporary folder.
const NAME: &str = "film.mp4";

/// A film that ffmpeg does not make.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Mp4Error {
    /// A program that is not installed.
    #[error(
        "no mp4 without ffmpeg ({0}); install it, or name a file that ends in .png, which needs nothing and which browsers play"
    )]
    Missing(io::Error),
    /// A program that failed.
    #[error("ffmpeg made no mp4: {0}")]
    Failed(String),
    /// A folder or a pipe that failed.
    #[error("no mp4: {0}")]
    Io(io::Error),
}

/// A running ffmpeg.
pub(super) struct Mp4 {
    child: Child,
    folder: TempDir,
}

impl Mp4 {
    /// Starts ffmpeg for pictures of a size, `fps` per second.
    pub(super) fn begin(size: Size, fps: f64) -> Result<Self, Mp4Error> {
        let folder = tempfile::Builder::new().prefix("sinew-film-").tempdir();
        let folder = folder.map_err(Mp4Error::Io)?;
        let child = Command::new(FFMPEG)
            .args([
                "-loglevel",
                "error",
                "-y",
                "-f",
                "rawvideo",
                "-pix_fmt",
                "rgb24",
            ])
            .args(["-s", &format!("{}x{}", size.width(), size.height())])
            .args(["-r", &fps.to_string(), "-i", "-"])
            // What all players show, and its head first, so that a page plays it while it loads.
            .args(["-pix_fmt", "yuv420p", "-movflags", "+faststart"])
            .arg(folder.path().join(NAME))
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(Mp4Error::Missing)?;
        Ok(Self { child, folder })
    }

    /// Passes the next picture to ffmpeg.
    pub(super) fn add(&mut self, picture: &Picture) -> Result<(), Mp4Error> {
        let written = match &mut self.child.stdin {
            Some(pipe) => pipe.write_all(picture.pixels().as_flattened()),
            None => Ok(()),
        };
        written.map_err(|error| match error.kind() {
            // It has ended, and says why.
            io::ErrorKind::BrokenPipe => Mp4Error::Failed(self.said()),
            _ => Mp4Error::Io(error),
        })
    }

    /// The film, after its last picture.
    pub(super) fn finish(mut self) -> Result<Vec<u8>, Mp4Error> {
        drop(self.child.stdin.take());
        let said = self.said();
        let status = self.child.wait().map_err(Mp4Error::Io)?;
        match status.success() {
            true => fs::read(self.folder.path().join(NAME)).map_err(Mp4Error::Io),
            false if said.is_empty() => Err(Mp4Error::Failed(status.to_string())),
            false => Err(Mp4Error::Failed(said)),
        }
    }

    /// The error message of ffmpeg, after its end.
    fn said(&mut self) -> String {
        let mut said = Vec::new();
        if let Some(mut pipe) = self.child.stderr.take() {
            // What cannot be read was not said.
            let _ = pipe.read_to_end(&mut said);
        }
        String::from_utf8_lossy(&said).trim().to_owned()
    }
}

impl Drop for Mp4 {
    fn drop(&mut self) {
        // One that has ended already is no failure.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
