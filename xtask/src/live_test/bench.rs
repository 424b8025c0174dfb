//! Helpers shared by the tests of the live page.

use std::path::PathBuf;

use tempfile::TempDir;

use super::cdp::Tab;
use super::chromium::Chromium;
use crate::failure::Failure;

/// The scene under the ball.
const CUBE: &str = include_str!("cube.toml");

/// The paper's cube, which the start page offers.
const PAPERS_CUBE: &str = include_str!("../../../crates/sinew/src/command/live/papers-cube.toml");

/// Programs and folder for the tests.
pub(super) struct Bench {
    pub(super) sinew: PathBuf,
    pub(super) chromium: Chromium,
    pub(super) folder: TempDir,
}

impl Bench {
    /// Arguments for the paper's cube by two methods side by side.
    pub(super) fn papers_cube(&self) -> Result<[PathBuf; 3], Failure> {
        let path = self.folder.path().join("papers-cube.toml");
        std::fs::write(&path, PAPERS_CUBE).map_err(Failure::chore)?;
        Ok([path, "--beside".into(), "cnn-stabilised".into()])
    }

    /// A scene with `cells` cells along an edge, by this method in steps of `dt` (s).
    pub(super) fn scene(&self, cells: usize, method: &str, dt: f64) -> Result<PathBuf, Failure> {
        let text = CUBE
            .replace("cells = 10", &format!("cells = {cells}"))
            .replace("symplectic-euler", method)
            .replace("dt = 0.001 ", &format!("dt = {dt} "));
        let path = self
            .folder
            .path()
            .join(format!("cube-{cells}-{method}.toml"));
        std::fs::write(&path, text).map_err(Failure::chore)?;
        Ok(path)
    }
}

/// Fails with a sentence if `holds` is false.
pub(super) fn require(holds: bool, what: impl FnOnce() -> String) -> Result<(), Failure> {
    match holds {
        true => Ok(()),
        false => Err(Failure::Chore(what())),
    }
}

/// Fails with a sentence if scripts of a page have failed.
pub(super) fn complaints(tab: &Tab) -> Result<(), Failure> {
    require(tab.errors.is_empty(), || {
        format!("the page complains: {}", tab.errors.join("; "))
    })
}
