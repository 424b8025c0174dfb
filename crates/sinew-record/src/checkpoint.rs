//! The file from which a run continues.

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use sinew_scene::output::OwnedFolder;
use sinew_world::{RestoreError, Saved, World};

use crate::balance::LastRow;
use crate::error::RecordRunError;
use crate::frames::frame_name;
use crate::progress::Progress;
use crate::request;

/// Its name.
pub(crate) const NAME: &str = "checkpoint.bin";

/// The first line, with the version of the format.
const HEAD: &str = "sinew checkpoint 11\n";

/// Bytes of the checksum at its end.
const CHECKSUM: usize = 32;

/// Data, in addition to the world, from which a run continues.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Checkpoint {
    pub(crate) progress: Progress,
    /// The motion at the last row of energies.
    pub(crate) row: LastRow,
}

impl Checkpoint {
    pub(crate) fn write(&self, folder: &OwnedFolder, world: &World) -> Result<(), RecordRunError> {
        let head = HEAD.as_bytes().to_vec();
        let content = (self, world.save());
        let bytes = postcard::to_extend(&content, head);
        let mut bytes = bytes.map_err(|error| unusable(folder, &error))?;
        let checksum = checksum(folder, &bytes)?;
        bytes.extend(checksum);
        Ok(folder.write(NAME, &bytes)?)
    }

    /// Restores the world of the last checkpoint in a folder, after a check that its frames are unchanged; `None` if
    /// there is no checkpoint yet.
    pub(crate) fn restore(
        folder: &OwnedFolder,
        world: &mut World,
    ) -> Result<Option<Self>, RecordRunError> {
        let Some(bytes) = folder.read(NAME)? else {
            return Ok(None);
        };
        let damaged = || unusable(folder, &"it is damaged, or that of another run");
        let (bytes, found) = bytes.split_last_chunk::<CHECKSUM>().ok_or_else(damaged)?;
        let head = &bytes[..bytes.len().min(HEAD.len())];
        if !HEAD.as_bytes().starts_with(head) {
            return Err(unusable(folder, &"another version of sinew wrote it"));
        }
        if checksum(folder, bytes)? != *found {
            return Err(damaged());
        }
        let content = bytes.get(HEAD.len()..).ok_or_else(damaged)?;
        let content: (Self, Saved) = postcard::from_bytes(content).map_err(|_| damaged())?;
        let (checkpoint, saved) = content;
        for (frame, seal) in checkpoint.progress.seals.frames.iter().enumerate() {
            seal.check_whole(folder, &frame_name(frame))?;
        }
        world.restore(&saved).map_err(|error| match error {
            RestoreError::Cutting(error) => error.into(),
            RestoreError::State(source) => RecordRunError::Checkpoint {
                folder: folder.path().to_owned(),
                source,
            },
            other => unusable(folder, &other),
        })?;
        Ok(Some(checkpoint))
    }
}

/// The checksum of a checkpoint together with the files of the run, so that the checkpoint of another run is refused.
fn checksum(folder: &OwnedFolder, bytes: &[u8]) -> Result<[u8; CHECKSUM], RecordRunError> {
    let mut hash = Sha256::new();
    hash.update(bytes);
    for name in [request::NAME, request::SCENE] {
        hash.update(folder.read(name)?.unwrap_or_default());
    }
    Ok(hash.finalize().into())
}

fn unusable(folder: &OwnedFolder, reason: &dyn std::fmt::Display) -> RecordRunError {
    RecordRunError::Unusable {
        folder: folder.path().to_owned(),
        name: NAME,
        reason: reason.to_string(),
    }
}
