//! Reading of the sources for the rules.

use std::path::{Path, PathBuf};

use super::breach::RuleError;

/// The text of a file.
pub(super) fn source(path: &Path) -> Result<String, RuleError> {
    read(path, std::fs::read_to_string(path))
}

/// All Rust files in a folder and the folders in it, in order.
pub(super) fn rust_files(folder: &Path) -> Result<Vec<PathBuf>, RuleError> {
    let mut files = Vec::new();
    for path in entries(folder)? {
        if path.is_dir() {
            files.extend(rust_files(&path)?);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    Ok(files)
}

/// The paths in a folder, in order.
pub(super) fn entries(folder: &Path) -> Result<Vec<PathBuf>, RuleError> {
    let entries = read(folder, std::fs::read_dir(folder))?;
    let paths = entries.map(|entry| read(folder, entry).map(|entry| entry.path()));
    let mut paths = paths.collect::<Result<Vec<_>, _>>()?;
    paths.sort_unstable();
    Ok(paths)
}

/// A path below the root of the repository, with slashes.
pub(super) fn shown(root: &Path, path: &Path) -> String {
    let path = path.strip_prefix(root).unwrap_or(path);
    let names: Vec<_> = path.iter().map(|name| name.to_string_lossy()).collect();
    names.join("/")
}

fn read<T>(path: &Path, result: std::io::Result<T>) -> Result<T, RuleError> {
    result.map_err(|source| RuleError::File {
        path: path.to_owned(),
        source,
    })
}
