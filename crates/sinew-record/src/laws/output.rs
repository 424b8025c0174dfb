//! Curves of laws in a folder.

use std::fs;
use std::path::{Path, PathBuf};

use sinew_scene::output::{OutputError, OwnedFolder, Tenant};

use super::curves::RegionCurves;
use super::measured::Measured;
use super::picture::{DESCRIBED, picture_of_law};
use super::table::{HEAD, table_of_laws};

/// The kind of result, in manifests and messages.
const KIND: &str = "curves of laws";

/// The table of all regions.
const TABLE: &str = "curves.csv";

/// Checks that curves may be written into a folder at `path`. Changes nothing.
///
/// # Errors
/// [`OutputError`].
pub fn check_curves_folder(path: &Path, inputs: &[PathBuf]) -> Result<Tenant, OutputError> {
    OwnedFolder::check(path, KIND, inputs)
}

/// Writes the curves of regions into a folder: a table, and a picture of each region. Returns the names of the files.
///
/// # Errors
/// [`OutputError`].
pub fn write_curves(
    path: &Path,
    inputs: &[PathBuf],
    regions: &[RegionCurves],
    measured: Option<&Measured>,
) -> Result<Vec<String>, OutputError> {
    let picture = |region: &RegionCurves| format!("region-{}.svg", region.number);
    let mut names = vec![TABLE.to_owned()];
    names.extend(regions.iter().map(picture));
    let folder = OwnedFolder::claim(path, KIND, inputs, &names)?;
    folder.write(TABLE, table_of_laws(regions).as_bytes())?;
    for region in regions {
        folder.write(
            &picture(region),
            picture_of_law(region, measured).as_bytes(),
        )?;
    }
    folder.finish(true)?;
    Ok(names)
}

/// True for a file with a table or a picture of laws.
#[must_use]
pub fn is_curves_file(path: &Path) -> bool {
    fs::read_to_string(path).is_ok_and(|text| {
        let mut lines = text.lines();
        let is_picture = lines
            .next()
            .is_some_and(|line| line.starts_with("<svg") && line.contains(DESCRIBED));
        is_picture || text.lines().find(|line| !line.starts_with('#')) == Some(HEAD)
    })
}
