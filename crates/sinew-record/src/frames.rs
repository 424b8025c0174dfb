//! The files of a series of frames.

use std::io;

use sinew_mesh::vtu::{Grid, VtuEncoding, WriteVtuError, write_pvd, write_vtu_grid};
use sinew_scene::output::OwnedFolder;

use crate::error::RecordRunError;
use crate::seal::{Seal, Sealing};

/// The file that lists the frames with their times.
pub(crate) const SERIES: &str = "fields.pvd";

/// The file of a frame (0-based).
pub(crate) fn frame_name(frame: usize) -> String {
    format!("fields/frame-{frame:05}.vtu")
}

/// Writes the list of frames with their times (s).
pub(crate) fn write_series(folder: &OwnedFolder, times: &[f64]) -> Result<(), RecordRunError> {
    let names: Vec<String> = (0..times.len()).map(frame_name).collect();
    let frames: Vec<(f64, &str)> = times
        .iter()
        .copied()
        .zip(names.iter().map(String::as_str))
        .collect();
    Ok(folder.write_lightly(SERIES, |mut file| write_pvd(&frames, &mut file))?)
}

/// Writes a grid under a name of the folder, and seals the file.
pub(crate) fn write(
    folder: &OwnedFolder,
    name: &str,
    grid: &Grid<'_>,
    encoding: VtuEncoding,
) -> Result<Seal, RecordRunError> {
    let mut refused = None;
    let mut seal = Seal::default();
    let written = folder.write_lightly(name, |file| {
        let mut file = Sealing::new(file);
        let written = write_vtu_grid(grid, encoding, &mut file);
        seal = file.seal();
        written.map_err(|error| {
            let message = error.to_string();
            refused = Some(error);
            io::Error::other(message)
        })
    });
    match refused {
        Some(WriteVtuError::Io(_)) | None => Ok(written.map(|()| seal)?),
        Some(error) => Err(error.into()),
    }
}
