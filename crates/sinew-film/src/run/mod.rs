//! Frames of a run, read from its folder.

mod frame;
mod series;

use std::io;
use std::sync::Arc;

use sinew_mesh::Mesh;
use sinew_mesh::vtu::read_vtu;

use crate::body::{Surface, Uncut};
use crate::field::{Colouring, Field};
use crate::{Clip, FilmError, Frame};

use frame::Cells;
use series::{SERIES, frames_of};

/// The end of a frame's file.
const END: &[u8] = b"</VTKFile>";

/// The files of a run by their names in its folder.
pub type Files<'a> = dyn Fn(&str) -> io::Result<Vec<u8>> + 'a;

/// The frames of a run.
pub struct Run<'a> {
    files: &'a Files<'a>,
    /// Times (s) and files of the frames.
    series: Vec<(f64, String)>,
    fields: Vec<Field>,
}

impl<'a> Run<'a> {
    /// Opens the run with these files.
    ///
    /// # Errors
    /// [`FilmError`] for a run without frames, and for damaged files.
    pub fn open(files: &'a Files<'a>) -> Result<Self, FilmError> {
        let series = match files(SERIES) {
            Ok(bytes) => frames_of(&bytes)?,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Err(FilmError::NoFrames { name: SERIES });
            }
            Err(source) => {
                let name = SERIES.to_owned();
                return Err(FilmError::Read { name, source });
            }
        };
        let (_, first) = series
            .first()
            .ok_or(FilmError::EmptySeries { name: SERIES })?;
        let fields = frame::fields_of(&read(files, first)?);
        Ok(Self {
            files,
            series,
            fields,
        })
    }

    /// The fields of its frames.
    #[must_use]
    pub fn fields(&self) -> &[Field] {
        &self.fields
    }

    /// The colouring of this name: `tissue`, or a field, or one of its components such as `displacement.z`.
    ///
    /// # Errors
    /// [`FilmError::Colour`], which lists the available ones.
    pub fn colouring(&self, name: &str) -> Result<Colouring, FilmError> {
        Colouring::find(name, &self.fields)
    }

    /// Times (s) of its frames.
    pub fn times(&self) -> impl Iterator<Item = f64> {
        self.series.iter().map(|(t, _)| *t)
    }

    /// Reads the surface at all frames, with the values by which it is coloured.
    ///
    /// # Errors
    /// [`FilmError`] for damaged files.
    pub fn clip(&self, colouring: &Colouring) -> Result<Clip, FilmError> {
        self.clip_of(colouring, |_| true)
    }

    /// Reads the surface at the first frame and at those whose time (s) `is_wanted`.
    ///
    /// # Errors
    /// [`FilmError`] for damaged files.
    pub fn clip_of(
        &self,
        colouring: &Colouring,
        is_wanted: impl Fn(f64) -> bool,
    ) -> Result<Clip, FilmError> {
        let mut frames = Vec::with_capacity(self.series.len());
        let mut known: Option<(Cells, Arc<Surface>)> = None;
        let mut uncut: Option<Uncut> = None;
        let wanted = self.series.iter().enumerate();
        // The faces of cuts are found by the first frame.
        let wanted = wanted.filter(|(frame, (t, _))| *frame == 0 || is_wanted(*t));
        for (_, (t, name)) in wanted {
            let mesh = read(self.files, name)?;
            let damaged = |reason: String| FilmError::Damaged {
                name: name.clone(),
                reason,
            };
            let mut cells = Cells::of(&mesh).map_err(damaged)?;
            let (cells, surface) = match known.take() {
                Some((before, surface)) if before == cells => (before, surface),
                _ => {
                    let boundary = cells.boundary(uncut.as_ref());
                    if uncut.is_none() {
                        uncut = Some(Uncut::of(&cells.points, &boundary));
                    }
                    let surface = Arc::new(cells.surface(&boundary));
                    (cells, surface)
                }
            };
            let nodes = cells.surface_nodes();
            let displacements = frame::displacements(&mesh, nodes).map_err(damaged)?;
            let values = match colouring.field() {
                Some(field) => frame::values(&mesh, field, &cells).map_err(damaged)?,
                None => Vec::new(),
            };
            frames.push(Frame::new(*t, Arc::clone(&surface), displacements, values));
            known = Some((cells, surface));
        }
        Ok(Clip::new(frames))
    }
}

/// Reads a frame whole.
fn read(files: &Files<'_>, name: &str) -> Result<Mesh, FilmError> {
    let bytes = files(name).map_err(|source| FilmError::Read {
        name: name.to_owned(),
        source,
    })?;
    let damaged = |reason: String| FilmError::Damaged {
        name: name.to_owned(),
        reason,
    };
    if !bytes.trim_ascii_end().ends_with(END) {
        return Err(damaged("it does not end as a frame does".to_owned()));
    }
    read_vtu(&bytes).map_err(|error| damaged(error.to_string()))
}
