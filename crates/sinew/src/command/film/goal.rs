//! Destinations of pictures and films.

use std::ffi::OsStr;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use sinew_film::is_own_png;
use sinew_scene::output::{Destination, OwnedFolder};

use super::arguments::Arguments;
use crate::command::Failure;

/// The kind of result, in manifests and messages.
pub(super) const KIND: &str = "pictures of a run";

/// Bytes at the beginning of a file that are searched for the mark of this command.
const HEAD: u64 = 4096;

/// The result to write.
pub(super) enum Goal {
    /// A picture of an instant.
    Picture(Destination),
    /// A film as animated PNG.
    Film(Destination),
    /// A film as mp4.
    Mp4(Destination),
    /// A folder of pictures.
    Folder(PathBuf),
}

impl Goal {
    /// The goal that the arguments request, checked before anything is drawn; a run reads `inputs`.
    pub(super) fn of(arguments: &Arguments, inputs: &[PathBuf]) -> Result<Self, Failure> {
        let out = match &arguments.out {
            Some(out) => out.clone(),
            None => named_after(&arguments.run),
        };
        let ending = out.extension().map(OsStr::to_ascii_lowercase);
        let ending = ending.as_ref().and_then(|ending| ending.to_str());
        let is_file = !out.is_dir();
        let goal = match (ending, arguments.at) {
            (Some("mp4"), None) if is_file => Self::Mp4(Destination::new(&out, inputs)?),
            (Some("png" | "apng"), None) if is_file => Self::Film(Destination::new(&out, inputs)?),
            (Some("png"), Some(_)) if is_file => Self::Picture(Destination::new(&out, inputs)?),
            (None, None) if out == Path::new("-") => Self::Film(Destination::new(&out, inputs)?),
            (None, Some(_)) if out == Path::new("-") => {
                Self::Picture(Destination::new(&out, inputs)?)
            }
            (None, None) => Self::Folder(out),
            (_, None) if !is_file => Self::Folder(out),
            (None | Some("mp4" | "apng"), Some(t)) => {
                return Err(Failure::OnePicture { t, path: out });
            }
            _ => return Err(Failure::FilmFormat { path: out }),
        };
        goal.check(arguments, inputs)?;
        Ok(goal)
    }

    /// Refuses files that must not be overwritten.
    fn check(&self, arguments: &Arguments, inputs: &[PathBuf]) -> Result<(), Failure> {
        match self {
            Self::Folder(path) => {
                OwnedFolder::check(path, KIND, inputs)?;
                Ok(())
            }
            Self::Picture(file) | Self::Film(file) => {
                arguments.force.check(file, || is_own(file.path()))
            }
            Self::Mp4(file) => arguments.force.check(file, || false),
        }
    }
}

/// A file in the current folder with the name of a run and the ending .png.
fn named_after(run: &Path) -> PathBuf {
    let real = run.canonicalize();
    let path = real.as_deref().unwrap_or(run);
    let name = match path.is_dir() {
        true => path.file_name(),
        false => path.file_stem(),
    };
    let mut name = name.unwrap_or_default().to_owned();
    name.push(".png");
    name.into()
}

/// True for a file that this command wrote.
fn is_own(path: &Path) -> bool {
    let mut head = Vec::new();
    let read = File::open(path).and_then(|file| file.take(HEAD).read_to_end(&mut head));
    read.is_ok() && is_own_png(&head)
}
