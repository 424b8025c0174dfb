//! Result of a comparison, and the reasons for which there may be none.

use std::path::{Component, Path, PathBuf};

/// The largest difference between two results in one quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// The file or series in which it occurs.
    pub of: &'static str,
    /// The quantity: a probe, a column, a field.
    pub what: String,
    /// Its unit.
    pub unit: String,
    /// The largest difference; for vectors its length.
    pub largest: f64,
    /// `largest` over the largest value of the quantity in the first result; 0 if both are 0.
    pub relative: f64,
    /// Its time (s).
    pub t: f64,
    /// Its node, by its number in the mesh from 0, for a field.
    pub node: Option<usize>,
}

/// The differences between two results.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Comparison {
    /// One difference for each quantity that both results have.
    pub differences: Vec<Difference>,
    /// Quantities that could not be compared, one sentence each.
    pub left_out: Vec<String>,
}

/// A reason for which two results cannot be compared.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CompareError {
    /// A folder without a finished or interrupted run.
    #[error("{}: the folder has no completed run; name a folder that a run wrote with `--out`", path.display())]
    NoRun {
        /// The folder.
        path: PathBuf,
    },
    /// A file that cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A file that was not written by a run.
    #[error("{}: {reason}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Description of the damage.
        reason: String,
    },
}

impl Comparison {
    /// The largest of all relative differences.
    #[must_use]
    pub fn largest_relative(&self) -> f64 {
        let relative = self
            .differences
            .iter()
            .map(|difference| difference.relative);
        // What is not a number differs.
        relative.fold(0.0, |largest, relative| match relative.is_nan() {
            true => f64::INFINITY,
            false => relative.max(largest),
        })
    }
}

/// The length of a vector of any number of components, above 0 also if their squares underflow.
pub(super) fn length(components: impl IntoIterator<Item = f64> + Clone) -> f64 {
    let squares = components.clone().into_iter().map(|x| x * x);
    let length = squares.sum::<f64>().sqrt();
    match length == 0.0 {
        true => components
            .into_iter()
            .fold(0.0, |most, x| x.abs().max(most)),
        false => length,
    }
}

/// A difference over the size of the values.
pub(super) fn relative(difference: f64, size: f64) -> f64 {
    match difference == 0.0 {
        true => 0.0,
        false => difference / size,
    }
}

/// A file of a result. Links and names that lead out of the folder are refused, since the folder may come from others.
pub(super) fn read(folder: &Path, name: &str) -> Result<Vec<u8>, CompareError> {
    let unreadable = |path: &Path, source| CompareError::Unreadable {
        path: path.to_owned(),
        source,
    };
    let mut path = folder.to_owned();
    for part in Path::new(name).components() {
        path.push(part);
        let found = path.symlink_metadata();
        let found = found.map_err(|source| unreadable(&path, source))?;
        if !matches!(part, Component::Normal(_)) || found.is_symlink() {
            return Err(damaged(&path, "it leads out of the folder"));
        }
    }
    std::fs::read(&path).map_err(|source| unreadable(&path, source))
}

pub(super) fn damaged(path: &Path, reason: impl Into<String>) -> CompareError {
    CompareError::Damaged {
        path: path.to_owned(),
        reason: reason.into(),
    }
}
