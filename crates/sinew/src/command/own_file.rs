//! Files that commands write: new ones, and with `--force` also existing ones.

use std::fs;
use std::path::Path;

use sinew_scene::output::{Delivery, Destination};

use super::Failure;

/// Permission to overwrite files.
#[derive(clap::Args, Clone, Copy)]
pub(crate) struct Force {
    /// Overwrite a file that holds something else
    #[arg(long)]
    pub(crate) force: bool,
}

impl Force {
    /// Refuses an existing file that is not this command's own, unless it may be overwritten.
    pub(crate) fn check(
        self,
        destination: &Destination,
        is_own: impl FnOnce() -> bool,
    ) -> Result<(), Failure> {
        let path = destination.path();
        let is_there = !destination.is_stream() && path.symlink_metadata().is_ok();
        match is_there && !self.force && !is_own() {
            true => Err(Failure::Exists {
                path: path.to_owned(),
            }),
            false => Ok(()),
        }
    }

    /// Writes a whole file, unless it exists with another content and may not be overwritten.
    pub(crate) fn write(
        self,
        destination: Destination,
        content: &[u8],
    ) -> Result<Delivery, Failure> {
        let path = destination.path().to_owned();
        self.check(&destination, || holds(&path, content))?;
        Ok(destination.write(content)?)
    }
}

/// True if a file has this content.
pub(crate) fn holds(path: &Path, content: &[u8]) -> bool {
    let length = fs::metadata(path).map(|found| found.len());
    length.is_ok_and(|length| length == content.len() as u64)
        && fs::read(path).is_ok_and(|found| found == content)
}
