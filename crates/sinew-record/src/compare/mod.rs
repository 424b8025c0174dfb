//! Differences between the results of two runs.

mod frames;
mod outcome;
mod places;
mod tables;

use std::path::Path;

pub use outcome::{CompareError, Comparison, Difference};

use crate::tables::{ENERGY, PROBES, REACTIONS};
use crate::tool_rows;

/// Compares the results in two folders: tables at the times of the first (those of the second between its rows on
/// straight lines), displacements and velocities of frames at equal times. Bodies of different shape and probes at
/// different positions are differences too.
///
/// # Errors
/// [`CompareError`] for a folder without a result and for damaged files.
pub fn compare(one: &Path, other: &Path) -> Result<Comparison, CompareError> {
    for path in [one, other] {
        if !path.join(crate::summary::NAME).is_file() {
            let path = path.to_owned();
            return Err(CompareError::NoRun { path });
        }
    }
    let mut comparison = Comparison::default();
    for name in [PROBES, ENERGY, REACTIONS, tool_rows::NAME] {
        tables::compare(&mut comparison, name, one, other)?;
    }
    frames::compare(&mut comparison, one, other)?;
    Ok(comparison)
}
