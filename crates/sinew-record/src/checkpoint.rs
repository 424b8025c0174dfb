//! The file from which a run continues.

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

/// The first line, with the version of what follows.
const HEAD: &str = "sinew checkpoint 8";

/// Bytes of the checksum at its end.
const CHECKSUM: usize = 32;

/// Data from which a run continues: a line of JSON, then the cuts of the body, the state in the format of `sinew-core`,
/// and numbers.
#[derive(Debug)]
pub(crate) struct Checkpoint {
    pub(crate) progress: Progress,
    /// The motion at the last row of energies.
    pub(crate) row: LastRow,
    /// Displacements (m) of the surface where it was largest so far.
    pub(crate) largest: Vec<f64>,
}

impl Checkpoint {
    pub(crate) fn write(
        folder: &OwnedFolder,
        progress: &Progress,
        world: &World,
        row: &LastRow,
        largest: &[f64],
    ) -> Result<(), RecordRunError> {
        let Saved { cuts, state, .. } = world.save();
        let times = [row.t, row.before];
        let lists: [&[f64]; 6] = [&times, &row.u, &row.v, &row.a, &row.internal, largest];
        let json = serde_json::to_string(progress).map_err(|error| unusable(folder, &error))?;
        let mut bytes = format!("{HEAD}\n{json}\n{} {}", cuts.len(), state.len());
        for list in lists {
            bytes.push_str(&format!(" {}", list.len()));
        }
        bytes.push('\n');
        let mut bytes = bytes.into_bytes();
        bytes.extend(cuts);
        bytes.extend(state);
        let numbers = lists.into_iter().flatten();
        bytes.extend(numbers.flat_map(|number| number.to_le_bytes()));
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
        if !HEAD
            .as_bytes()
            .starts_with(&bytes[..bytes.len().min(HEAD.len())])
        {
            return Err(unusable(folder, &"another version of sinew wrote it"));
        }
        if checksum(folder, bytes)? != *found {
            return Err(damaged());
        }
        let mut lines = bytes.splitn(4, |byte| *byte == b'\n').skip(1);
        let progress: Progress = serde_json::from_slice(lines.next().unwrap_or_default())
            .map_err(|error| unusable(folder, &error))?;
        for (frame, seal) in progress.seals.frames.iter().enumerate() {
            seal.check_whole(folder, &frame_name(frame))?;
        }
        let sizes = str::from_utf8(lines.next().unwrap_or_default()).map_err(|_| damaged())?;
        let sizes: Result<Vec<usize>, _> = sizes.split(' ').map(str::parse).collect();
        let [cuts, size, counts @ ..] = &sizes.map_err(|_| damaged())?[..] else {
            return Err(damaged());
        };
        let rest = lines.next().unwrap_or_default();
        let (cuts, rest) = rest.split_at_checked(*cuts).ok_or_else(damaged)?;
        let (state, rest) = rest.split_at_checked(*size).ok_or_else(damaged)?;
        let saved = Saved {
            cuts: cuts.to_vec(),
            state: state.to_vec(),
            commanded: None,
        };
        world.restore(&saved).map_err(|error| match error {
            RestoreError::Cutting(error) => error.into(),
            RestoreError::State(source) => RecordRunError::Checkpoint {
                folder: folder.path().to_owned(),
                source,
            },
            other => unusable(folder, &other),
        })?;
        let (numbers, []) = rest.as_chunks::<8>() else {
            return Err(damaged());
        };
        let mut numbers = numbers.iter().map(|bytes| f64::from_le_bytes(*bytes));
        let lists: Vec<Vec<f64>> = counts
            .iter()
            .map(|count| numbers.by_ref().take(*count).collect())
            .collect();
        let whole = lists
            .iter()
            .zip(counts)
            .all(|(list, count)| list.len() == *count);
        let Ok([t, u, v, a, internal, largest]) = <[Vec<f64>; 6]>::try_from(lists) else {
            return Err(damaged());
        };
        if !whole || numbers.next().is_some() || t.len() != 2 {
            return Err(damaged());
        }
        Ok(Some(Self {
            progress,
            row: LastRow {
                t: t[0],
                before: t[1],
                u,
                v,
                a,
                internal,
            },
            largest,
        }))
    }
}

/// The checksum of a checkpoint together with what was run, so that that of another run does not fit.
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
