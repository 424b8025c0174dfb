//! The command `sinew`, built as users have it.

use std::path::PathBuf;
use std::process::Command;

use crate::failure::Failure;
use crate::repository::root;

/// Builds it in release mode; returns its path.
pub(crate) fn build() -> Result<PathBuf, Failure> {
    let status = Command::new(env!("CARGO"))
        .args(["build", "--release", "--quiet", "-psinew"])
        .current_dir(root())
        .status()
        .map_err(Failure::chore)?;
    let target = std::env::var_os("CARGO_TARGET_DIR");
    let target = target.map_or_else(|| root().join("target"), PathBuf::from);
    match status.success() {
        true => Ok(target.join("release/sinew")),
        false => Err(Failure::Chore(format!("building sinew: {status}"))),
    }
}
