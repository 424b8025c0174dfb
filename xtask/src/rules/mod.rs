//! The rules of ARCHITECTURE.md that a machine can check.

mod architecture_paths;
mod breach;
mod code;
mod components;
mod dev_cycles;
mod doc_words;
mod document_links;
mod file_circles;
mod files;
mod light_trees;
mod modules;
mod pure_sources;
mod rooms;
mod workspace;

use std::path::Path;

use breach::{Breach, RuleError};

/// Checks all rules on the repository in `root`.
///
/// # Errors
///
/// Every breach that was found, or the first file that could not be read.
pub(crate) fn check(root: &Path) -> Result<(), RuleError> {
    let packages = workspace::packages(root)?;
    let breaches: Vec<Breach> = [
        rooms::check(&packages),
        dev_cycles::check(&packages),
        light_trees::check(root, light_trees::LIGHT)?,
        pure_sources::check(root, pure_sources::PURE)?,
        file_circles::check(root)?,
        architecture_paths::check(root)?,
        document_links::check(root)?,
        doc_words::check(root)?,
    ]
    .into_iter()
    .flatten()
    .collect();
    if breaches.is_empty() {
        Ok(())
    } else {
        Err(RuleError::Broken(breaches))
    }
}

/// Names of the crates that are published, in the order of the workspace.
///
/// # Errors
///
/// [`RuleError`] if cargo cannot list them.
pub(crate) fn published(root: &Path) -> Result<Vec<String>, RuleError> {
    let packages = workspace::packages(root)?.into_iter();
    let published = packages.filter(|package| package.is_published);
    Ok(published.map(|package| package.name).collect())
}

/// A folder with these files, by path and text.
#[cfg(test)]
fn tree<'a>(files: impl IntoIterator<Item = (&'a str, &'a str)>) -> tempfile::TempDir {
    let root = tempfile::tempdir().unwrap();
    for folder in ["crates", "xtask"] {
        std::fs::create_dir_all(root.path().join(folder)).unwrap();
    }
    for (path, text) in files {
        let path = root.path().join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    root
}
