//! Writing of frames in parallel with the run.

use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::Scope;

use sinew_core::{Moment, vectors};
use sinew_scene::output::OwnedFolder;
use sinew_scene::{BodyModel, OutputSettings, OverlapWatch};

use crate::error::RecordRunError;
use crate::fields::{Fields, Snapshot};
use crate::progress::Seen;
use crate::seal::Seal;

/// Snapshots in use: one that is written, and one that is taken at the same time.
const SNAPSHOTS: usize = 2;

/// Extremes of the written frames, and their seals.
#[derive(Debug, Clone, Default)]
pub(crate) struct SeenInFrames {
    pub(crate) seen: Seen,
    /// Seals of the frames, from the first one of the run on.
    pub(crate) seals: Vec<Seal>,
}

/// Makes fields of snapshots and writes them on a separate thread, so that the run need not wait for them. Frames are
/// written in order, so the extremes do not depend on timing.
pub(crate) struct FrameWriter<'a> {
    to_write: SyncSender<Work>,
    written: Receiver<Result<Snapshot, RecordRunError>>,
    /// Snapshots that are not in use.
    free: Vec<Snapshot>,
    seen: &'a Mutex<SeenInFrames>,
}

/// Work of the writing thread.
enum Work {
    Frame(Snapshot),
    /// A change of the body: frames are of this body from now on.
    Body(Arc<BodyModel>),
}

/// All data that the writing thread needs.
pub(crate) struct FrameJob<'a> {
    folder: &'a OwnedFolder,
    body: Arc<BodyModel>,
    dt: f64,
    settings: OutputSettings,
    fields: Fields,
    overlaps: OverlapWatch,
    seen: &'a Mutex<SeenInFrames>,
}

impl<'a> FrameJob<'a> {
    /// Frames of a body in steps of `dt` (s).
    pub(crate) fn new(
        folder: &'a OwnedFolder,
        body: &Arc<BodyModel>,
        (dt, settings): (f64, OutputSettings),
        seen: &'a Mutex<SeenInFrames>,
    ) -> Self {
        Self {
            folder,
            body: Arc::clone(body),
            dt,
            settings,
            fields: Fields::new(body, dt, settings),
            overlaps: OverlapWatch::new(body),
            seen,
        }
    }
}

impl FrameJob<'_> {
    fn write(&mut self, snapshot: &Snapshot) -> Result<(), RecordRunError> {
        let mut guard = lock(self.seen);
        let SeenInFrames { seen, seals } = &mut *guard;
        let seal = self.fields.write(self.folder, snapshot, seen)?;
        seals.push(seal);
        let displacements = self.fields.displacements();
        self.overlaps.look(snapshot.t, displacements);
        seen.see_overlap(self.overlaps.deepest());
        let (mut node, mut most) = (0, 0.0);
        for (index, u) in displacements.iter().enumerate() {
            let size = vectors::norm(u);
            if size > most {
                (node, most) = (index, size);
            }
        }
        let tag = || self.body.mesh.node_tags[node];
        seen.displacement.see(most, snapshot.t, tag);
        Ok(())
    }

    fn serve(mut self, works: &Receiver<Work>, done: &Sender<Result<Snapshot, RecordRunError>>) {
        for work in works {
            let snapshot = match work {
                Work::Frame(snapshot) => snapshot,
                Work::Body(body) => {
                    self = Self::new(self.folder, &body, (self.dt, self.settings), self.seen);
                    continue;
                }
            };
            let written = self.write(&snapshot).map(|()| snapshot);
            let failed = written.is_err();
            // A run that has ended wants no answer.
            if done.send(written).is_err() || failed {
                return;
            }
        }
    }
}

impl<'a> FrameWriter<'a> {
    /// Starts the thread, which ends when this is dropped.
    pub(crate) fn start<'scope>(scope: &'scope Scope<'scope, '_>, job: FrameJob<'a>) -> Self
    where
        'a: 'scope,
    {
        let seen = job.seen;
        let (to_write, works) = sync_channel(SNAPSHOTS);
        let (done, written) = channel();
        scope.spawn(move || job.serve(&works, &done));
        Self {
            to_write,
            written,
            free: (0..SNAPSHOTS).map(|_| Snapshot::default()).collect(),
            seen,
        }
    }

    /// Requests a frame of a moment with the velocity (m/s) at its time. Waits if the frame before the last one is not
    /// written yet.
    ///
    /// # Errors
    /// The reason for which an earlier frame, or this moment, cannot be written.
    pub(crate) fn write(
        &mut self,
        frame: usize,
        moment: &Moment<'_>,
        v: &[f64],
        has_acceleration: bool,
    ) -> Result<(), RecordRunError> {
        if self.free.is_empty() {
            self.wait()?;
        }
        let mut snapshot = self.free.pop().unwrap_or_default();
        if let Err(refused) = snapshot.take(frame, moment, v, has_acceleration) {
            // Whoever waits for all of them would wait for ever for one that is gone.
            self.free.push(snapshot);
            return Err(refused);
        }
        // Where nobody listens any more, the reason has come already and is found when it is waited for.
        let _ = self.to_write.send(Work::Frame(snapshot));
        Ok(())
    }

    /// Writes frames of another body from now on.
    pub(crate) fn change_body(&mut self, body: &Arc<BodyModel>) {
        // As in `write`.
        let _ = self.to_write.send(Work::Body(Arc::clone(body)));
    }

    /// Waits until all frames are written; returns their extremes.
    ///
    /// # Errors
    /// The reason for which one of them cannot be written.
    pub(crate) fn settle(&mut self) -> Result<MutexGuard<'a, SeenInFrames>, RecordRunError> {
        while self.free.len() < SNAPSHOTS {
            self.wait()?;
        }
        Ok(lock(self.seen))
    }

    /// Waits for the next frame.
    fn wait(&mut self) -> Result<(), RecordRunError> {
        match self.written.recv() {
            Ok(written) => self.free.push(written?),
            // The thread panicked, which ends the scope that it belongs to in the same way.
            Err(_) => self.free.push(Snapshot::default()),
        }
        Ok(())
    }
}

fn lock(seen: &Mutex<SeenInFrames>) -> MutexGuard<'_, SeenInFrames> {
    seen.lock().unwrap_or_else(PoisonError::into_inner)
}
