//! Sessions that are repeated from their logs, with results in a folder like that of a run.

use std::path::Path;
use std::time::Instant;

use sinew_scene::Cutter;
use sinew_world::{FollowError, Replay};

use crate::balance::Balance;
use crate::companion::Companion;
use crate::error::RecordRunError;
use crate::progress::Progress;
use crate::recorder::Schedules;
use crate::request::{LOG, Record, Request};
use crate::run_end::{Ended, RunEnd};
use crate::run_folder::{Beginning, End, RunFolder, cause, cut_record};
use crate::stepping::Stepping;

impl RunFolder {
    /// Replays a session from its log and writes the files of a run into a folder at `path`: the motion since the last
    /// reset, with steps counted from there on. If the length of steps changes, the spacing of rows and frames in steps
    /// follows from the mean length.
    ///
    /// # Errors
    /// [`RecordRunError`] for a folder that may not be used, and for a session whose motion differs from its log.
    pub fn replay(
        path: &Path,
        replay: &mut Replay,
        request: &Request,
        companion: &mut dyn Companion,
    ) -> Result<RunEnd, RecordRunError> {
        let begun = Instant::now();
        let course = replay.course();
        let (simulation, body) = (replay.world().scene(), replay.world().body());
        let schedules = Schedules::of_steps(simulation, course.steps, course.dt);
        Self::check(path, simulation.scene(), None, request.again)?;
        let mut record = Record::of(simulation.scene(), request)?;
        record.log = Some(LOG.to_owned());
        let folder = Self::claim(path, simulation, record, &schedules, &[LOG])?;
        let log = replay.log().to_text();
        folder.folder().write(LOG, log.as_bytes())?;
        let mass = replay.world().cutter().map(Cutter::mass);
        let method = replay.world().integrator();
        let method = course.is_even().then_some(method);
        let beginning = Beginning {
            schedules,
            balance: Balance::new(simulation, body, method, schedules.energy),
            progress: Progress::default(),
            resumed: false,
            saves: false,
        };
        let mut recorded = folder.record(replay, beginning, companion, |replay, shown| {
            // What came until a failure is kept, as of a run that a law ends.
            let reason = match replay.advance(shown) {
                Ok(ended) => return Ok(Ended::of(ended, replay.world().t())),
                Err(FollowError::Replay(error)) => error.to_string(),
                Err(FollowError::Record(error)) => match cause(error) {
                    RecordRunError::State(refused) => refused.to_string(),
                    other => return Err(other),
                },
            };
            Ok(Ended::Refused {
                t: replay.world().t(),
                reason,
            })
        })?;
        let times = std::mem::take(&mut recorded.times);
        let world = replay.world();
        let end = End {
            world,
            before: 0,
            stepping: Stepping::of_session(&replay.course_so_far(), world.scene()),
            remarks: world.integrator().remarks(),
            outrun: None,
            times: &times,
            resumed: false,
            begun,
            cuts: cut_record(world, mass),
        };
        folder.complete(&schedules, recorded, end)
    }
}
