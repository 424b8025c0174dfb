//! `sinew run --replay`.

use std::path::{Path, PathBuf};

use sinew_core::Recorders;
use sinew_record::{Companion, Ended, FrameLooks, Looked, RecordRunError, Request, RunFolder};
use sinew_scene::output::{Delivery, Destination, Voice, complain};
use sinew_scene::{Cutter, ProbeCsv, ProbeRows, Scene, WarningKind};
use sinew_session::{FollowError, Log, Replay};

use super::arguments::Arguments;
use super::words::{schedule, summary_of};
use crate::command::Failure;
use crate::command::interruption::Interruption;
use crate::command::onlooker::Onlooker;

/// Repeats a session of a scene.
pub(super) fn run(
    arguments: &Arguments,
    scene: Scene,
    log: &Path,
    destination: Option<Destination>,
    interruption: Interruption,
) -> Result<(), Failure> {
    let failed = |source| Failure::Replay {
        log: log.to_owned(),
        source: Box::new(source),
    };
    let mut replay = Replay::new(scene, Log::read(log)?).map_err(failed)?;
    let warnings = warnings_of(&replay);
    for warning in &warnings {
        complain(&format!("warning: {warning}"));
    }
    if arguments.strict && !warnings.is_empty() {
        let count = warnings.len();
        return Err(Failure::Warnings { count });
    }
    let Some(destination) = destination else {
        let path = arguments.out.as_deref().unwrap_or(Path::new("."));
        let request = Request {
            threads: None,
            warnings,
            values: arguments.values.assignments(),
            again: arguments.again,
        };
        let ended = in_folder(path, &mut replay, &request, interruption)?;
        return Failure::of_end(ended, replay.session().simulation(), no_remedy);
    };
    let voice = Voice::apart_from(&destination);
    let recorded_scene = |replay: &Replay| replay.recorded_scene().map_err(RecordRunError::from);
    let mut simulation = recorded_scene(&replay)?;
    let course = replay.course();
    let rows = ProbeRows::new(&simulation);
    let steps = (course.steps, course.dt);
    let schedule = schedule(&simulation, &rows, steps, destination.is_kept())?;
    let mut csv = ProbeCsv::new(destination.open()?, rows, schedule)?.without_rows();
    let (mut steps, mut looked) = (0, Looked::default());
    let (followed, is_interrupted) = loop {
        // After a change of the body steps are counted anew.
        let mut onlooker = onlooker(&replay, interruption.clone());
        let mut rows = csv.with_rows(ProbeRows::new(&simulation));
        let instants = (course.steps, course.dt);
        let mut looks = FrameLooks::of_steps(&simulation, instants, std::mem::take(&mut looked));
        let mut recorders = Recorders::new()
            .with_lent(&mut rows)
            .with_lent(&mut looks)
            .with_lent(&mut onlooker);
        let followed = replay.follow(&simulation, &mut recorders);
        drop(recorders);
        onlooker.finish();
        looked = looks.into_looked();
        let followed = match followed {
            Ok(followed) => followed,
            Err(FollowError::Replay(source)) => return Err(failed(source)),
            Err(FollowError::Record(error)) => {
                return Err(sinew_core::SimulateError::from(error).into());
            }
        };
        csv = rows.without_rows();
        steps += followed.steps;
        if followed.change.is_none() {
            break (followed, onlooker.is_interrupted());
        }
        simulation = recorded_scene(&replay)?;
    };
    let session = replay.session();
    let left = session
        .cutter()
        .map_or_else(Vec::new, Cutter::left_by_strokes);
    for warning in looked.warnings().into_iter().chain(left) {
        complain(&format!("warning: {warning}"));
    }
    if csv.finish()? == Delivery::Whole {
        voice.say(&format!(
            "{}: the {} steps since the last reset repeated, of {} steps and {} commands; t = {:.6} s",
            simulation.scene().title_or_path(),
            steps,
            session.steps(),
            session.log().entries().len(),
            session.t()
        ))?;
        if voice == Voice::StandardOutput {
            voice.say(&format!("probes: {}", probes(arguments).display()))?;
        }
    }
    match followed.diverged {
        Some((t, place)) => Err(Failure::Diverged {
            t,
            place,
            remedy: simulation.after_divergence(),
        }),
        None if followed.is_stopped && is_interrupted => Err(Failure::Interrupted {
            t: session.t(),
            remedy: no_remedy(),
        }),
        None => Ok(()),
    }
}

/// What is to be said before a session is repeated. Its folder shows the motion of all nodes, so that probes are not missed.
pub(crate) fn warnings_of(replay: &Replay) -> Vec<String> {
    let mut warnings = replay.session().simulation().warnings();
    warnings.retain(|warning| warning.kind != WarningKind::NoProbe);
    let warnings = warnings.iter().map(ToString::to_string);
    warnings.chain(replay.warnings()).collect()
}

/// Repeats a session into a folder and says what came out.
pub(crate) fn in_folder(
    path: &Path,
    replay: &mut Replay,
    request: &Request,
    interruption: Interruption,
) -> Result<Ended, Failure> {
    let mut onlooker = onlooker(replay, interruption);
    let end = RunFolder::replay(path, replay, request, &mut onlooker);
    onlooker.finish();
    let end = end?;
    for line in summary_of(replay.session().simulation(), &end, path) {
        complain(&line);
    }
    Ok(end.ended)
}

/// Of what is left to be repeated.
fn onlooker(replay: &Replay, interruption: Interruption) -> Onlooker {
    let course = replay.course();
    let duration = course.steps as f64 * course.dt;
    let taken = replay.session().steps() - course.first;
    Onlooker::new(interruption, course.steps - taken, duration)
}

fn probes(arguments: &Arguments) -> &PathBuf {
    &arguments.probes
}

/// What is said after an interruption.
fn no_remedy() -> String {
    "; a session is repeated as a whole, and cannot be gone on with".to_owned()
}
