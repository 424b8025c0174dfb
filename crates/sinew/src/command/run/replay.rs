//! `sinew run --replay`.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use sinew_record::{Companion, FrameLooks, Request, RunFolder};
use sinew_scene::output::{Delivery, Destination, Voice, complain};
use sinew_scene::{Cutter, ProbeCsv, ProbeRows, Scene, WarningKind};
use sinew_world::{Ended, FollowError, Log, Recorders, Replay};

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
        return Failure::of_end(ended, replay.world().scene(), no_remedy);
    };
    let voice = Voice::apart_from(&destination);
    let simulation = Arc::clone(replay.world().scene());
    let course = replay.course();
    let rows = ProbeRows::new(replay.world().body());
    let steps = (course.steps, course.dt);
    let schedule = schedule(&simulation, &rows, steps, destination.is_kept())?;
    let mut csv = ProbeCsv::new(destination.open()?, rows, schedule)?;
    let mut looks = FrameLooks::of_steps(&simulation, steps);
    let mut onlooker = onlooker(&replay, interruption);
    let mut recorders = Recorders::new()
        .with(&mut csv)
        .with(&mut looks)
        .with(&mut onlooker);
    let mut shown = replay.world().show(&mut recorders);
    let ended = replay.advance(&mut shown);
    let steps = shown.steps();
    drop(recorders);
    onlooker.finish();
    let ended = match ended {
        Ok(ended) => ended,
        Err(FollowError::Replay(source)) => return Err(failed(source)),
        Err(FollowError::Record(error)) => {
            return Err(sinew_core::SimulateError::from(error).into());
        }
    };
    let (is_interrupted, looked) = (onlooker.is_interrupted(), looks.into_looked());
    let world = replay.world();
    let simulation = world.scene();
    let left = world
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
            world.steps(),
            replay.log().entries().len(),
            world.t()
        ))?;
        if voice == Voice::StandardOutput {
            voice.say(&format!("probes: {}", probes(arguments).display()))?;
        }
    }
    match ended {
        Ended::Diverged { t, place } => Err(Failure::Diverged {
            t,
            place,
            remedy: simulation.after_divergence(),
        }),
        Ended::Stopped if is_interrupted => Err(Failure::Interrupted {
            t: world.t(),
            remedy: no_remedy(),
        }),
        Ended::Finished | Ended::Stopped => Ok(()),
    }
}

/// Warnings before a session is replayed. Its folder shows the motion of all nodes, so that probes are not missed.
pub(crate) fn warnings_of(replay: &Replay) -> Vec<String> {
    let mut warnings = replay.world().scene().warnings();
    warnings.retain(|warning| warning.kind != WarningKind::NoProbe);
    let warnings = warnings.iter().map(ToString::to_string);
    warnings.chain(replay.warnings()).collect()
}

/// Replays a session into a folder and prints the outcome.
pub(crate) fn in_folder(
    path: &Path,
    replay: &mut Replay,
    request: &Request,
    interruption: Interruption,
) -> Result<sinew_record::Ended, Failure> {
    let mut onlooker = onlooker(replay, interruption);
    let end = RunFolder::replay(path, replay, request, &mut onlooker);
    onlooker.finish();
    let end = end?;
    for line in summary_of(replay.world().scene(), &end, path) {
        complain(&line);
    }
    Ok(end.ended)
}

/// Onlooker for the rest of a replay.
fn onlooker(replay: &Replay, interruption: Interruption) -> Onlooker {
    let course = replay.course();
    let duration = course.steps as f64 * course.dt;
    let taken = replay.world().steps() - course.first;
    Onlooker::new(interruption, course.steps - taken, duration)
}

fn probes(arguments: &Arguments) -> &PathBuf {
    &arguments.probes
}

/// The rest of the message after an interruption.
fn no_remedy() -> String {
    "; a replay runs from the beginning and cannot be resumed".to_owned()
}
