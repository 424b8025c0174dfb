//! Sessions that are repeated by their logs, into a folder like that of a run.

use std::path::Path;
use std::time::Instant;

use sinew_core::{Moment, RecordError, SimulateError};
use sinew_scene::Cutter;
use sinew_session::{BodyCut, FollowError, Followed, Replay};

use crate::balance::Balance;
use crate::companion::Companion;
use crate::error::RecordRunError;
use crate::progress::Progress;
use crate::recorder::Schedules;
use crate::request::{LOG, Record, Request};
use crate::run_end::{Ended, RunEnd};
use crate::run_folder::{Beginning, End, RunFolder};
use crate::stepping::Stepping;
use crate::summary::CutRecord;

impl RunFolder {
    /// Repeats a session by its log and leaves in a folder at `path` what a run leaves there: the motion since the last reset, whose steps are counted from
    /// there on. Where steps change their length, rows and frames come after as many steps as fit the mean length.
    ///
    /// # Errors
    /// [`RecordRunError`] for a folder that may not be used, and for a session that takes another course than its log.
    pub fn replay(
        path: &Path,
        replay: &mut Replay,
        request: &Request,
        companion: &mut dyn Companion,
    ) -> Result<RunEnd, RecordRunError> {
        let begun = Instant::now();
        let course = replay.course();
        let mut simulation = replay.recorded_scene()?;
        let schedules = Schedules::of_steps(&simulation, course.steps, course.dt);
        Self::check(path, simulation.scene(), None, request.again)?;
        let mut record = Record::of(simulation.scene(), request)?;
        record.log = Some(LOG.to_owned());
        let folder = Self::claim(path, &simulation, record, &schedules, &[LOG])?;
        let log = replay.log().to_text();
        folder.folder().write(LOG, log.as_bytes())?;
        let mass = replay.session().cutter().map(Cutter::mass);
        let mut progress = Progress::default();
        let (mut largest, mut times) = (Vec::new(), Vec::new());
        let mut change: Option<BodyCut> = None;
        let mut departed = None;
        let (followed, recorded) = loop {
            let method = replay.session().integrator();
            let method = course.is_even().then_some(method);
            let mut balance = Balance::new(&simulation, method, schedules.energy);
            if let Some(BodyCut { after, energy, .. }) = &change {
                balance = balance.after_change(progress.energy, after, *energy)?;
            }
            let before = progress.steps;
            let beginning = Beginning {
                schedules,
                balance,
                progress: progress.clone(),
                largest: std::mem::take(&mut largest),
                resumed: false,
                saves: false,
                cutter: None,
            };
            let (followed, mut recorded) =
                folder.record(&simulation, beginning, companion, |recorder| {
                    let from = replay.session().steps();
                    let ended = match replay.follow(&simulation, recorder) {
                        Ok(followed) => Ok(followed),
                        Err(FollowError::Replay(error)) => Err(error.to_string()),
                        Err(error) => match failure(error) {
                            RecordRunError::State(refused) => Err(refused.to_string()),
                            other => return Err(other),
                        },
                    };
                    // What came until then is kept, as of a run that a law ends.
                    let followed = ended.unwrap_or_else(|reason| {
                        departed = Some(reason);
                        Followed {
                            steps: replay.session().steps().saturating_sub(from),
                            ..Followed::default()
                        }
                    });
                    if let Some(change) = &followed.change {
                        recorder.close_balance(&Moment {
                            system: simulation.system(),
                            inputs: replay.session().inputs(),
                            state: &change.before,
                            step: followed.steps,
                            work: followed.work,
                        })?;
                    }
                    Ok(followed)
                })?;
            times.append(&mut recorded.times);
            change.clone_from(&followed.change);
            if change.is_none() {
                break (followed, recorded);
            }
            progress = recorded.progress;
            progress.steps = before + followed.steps;
            progress.work.add(followed.work);
            simulation = replay.recorded_scene()?;
        };
        let session = replay.session();
        let ended = match followed.diverged {
            Some((t, place)) => Ended::Diverged { t, place },
            None if departed.is_some() => Ended::Refused {
                t: session.t(),
                reason: departed.unwrap_or_default(),
            },
            None if followed.is_stopped => Ended::Interrupted { t: session.t() },
            None => Ended::Finished,
        };
        let cuts = session.cutter().zip(mass);
        let end = End {
            steps: (0, progress.steps + followed.steps),
            stepping: Stepping::of_session(&replay.course_so_far(), &simulation),
            work: followed.work,
            ended,
            state: session.state(),
            integrator: session.integrator(),
            remarks: session.integrator().remarks(),
            outrun: None,
            times: &times,
            resumed: false,
            begun,
            cuts: cuts.map(|(cutter, mass)| CutRecord::of(cutter, mass)),
        };
        folder.complete(&simulation, &schedules, recorded, end)
    }
}

/// The cause of a recorder's failure, or the failure to repeat the session.
fn failure(error: FollowError) -> RecordRunError {
    let RecordError { t, source } = match error {
        FollowError::Record(error) => error,
        FollowError::Replay(error) => return error.into(),
    };
    match source.downcast::<RecordRunError>() {
        Ok(cause) => *cause,
        Err(source) => SimulateError::Record(RecordError { t, source }).into(),
    }
}
