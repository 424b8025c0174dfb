//! The folder of a run.

use std::path::Path;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Instant;

use sinew_core::{RecordError, SimulateError, StepError, StepReport};
use sinew_scene::output::{OwnedFolder, Replaced, Tenant};
use sinew_scene::{Cutter, HeldParts, OverlapWatch, ProbeRows, Scene, Simulation};
use sinew_world::{AdvanceError, Shown, World, WorldStepError};

use crate::balance::Balance;
use crate::checkpoint::{self, Checkpoint};
use crate::companion::Companion;
use crate::error::RecordRunError;
use crate::frame_writer::{FrameJob, FrameWriter, SeenInFrames};
use crate::frames;
use crate::pace::Pace;
use crate::progress::Progress;
use crate::recorder::{RunRecorder, Schedules, Stop, Tables};
use crate::report;
use crate::request::{self, Record, Request};
use crate::run_end::{Ended, RunEnd};
use crate::stepping::Stepping;
use crate::summary::{self, CutRecord, Summary};
use crate::surface;
use crate::tables;
use crate::tool_rows::{self, ToolRows};

/// The kind of result, in manifests and messages.
const KIND: &str = "run";

/// Largest number of frames of a folder: more are a mistake, and their list alone would be long.
const MOST_FRAMES: usize = 100_000;

/// Largest number of entries of a table, about two gigabytes.
pub const MOST_NUMBERS: usize = 100_000_000;

/// The folder of a run, locked against other writers.
#[derive(Debug)]
pub struct RunFolder {
    folder: OwnedFolder,
    record: Record,
}

/// The state at the beginning of a recording.
pub(crate) struct Beginning {
    pub(crate) schedules: Schedules,
    pub(crate) balance: Balance,
    pub(crate) progress: Progress,
    /// True if the present state was recorded by an earlier process.
    pub(crate) resumed: bool,
    pub(crate) saves: bool,
}

/// Results of a recorder.
pub(crate) struct Recorded {
    pub(crate) progress: Progress,
    /// Steps and work since the recorder began.
    pub(crate) steps: usize,
    pub(crate) work: StepReport,
    pub(crate) ended: Ended,
    /// Times (s) of the frames that it wrote.
    pub(crate) times: Vec<f64>,
}

/// The end of a run that is recorded.
pub(crate) struct End<'a> {
    pub(crate) world: &'a World,
    /// Steps of an earlier process.
    pub(crate) before: usize,
    pub(crate) stepping: Stepping,
    pub(crate) remarks: Vec<String>,
    /// A warning if the step is too long for the body at the end.
    pub(crate) outrun: Option<String>,
    /// Times (s) of all frames.
    pub(crate) times: &'a [f64],
    pub(crate) resumed: bool,
    pub(crate) begun: Instant,
    /// Record of the cuts, if the body may be cut.
    pub(crate) cuts: Option<CutRecord>,
}

impl RunFolder {
    /// Checks, before long work, that a run of this scene, or a replay of its session from a file with the log, may
    /// write into a folder at `path`. Changes nothing except that it completes a finished run, see
    /// [`RunFolder::settle`].
    ///
    /// # Errors
    /// [`RecordRunError::Output`] for a folder with other content, the inputs included, or that cannot be written, and
    /// [`RecordRunError::Resumable`] for one whose run can be continued, unless `again` is set.
    pub fn check(
        path: &Path,
        scene: &Scene,
        log: Option<&Path>,
        again: bool,
    ) -> Result<Tenant, RecordRunError> {
        let mut inputs = scene.input_files();
        inputs.extend(log.map(Path::to_owned));
        Self::settle(path)?;
        let tenant = OwnedFolder::check(path, KIND, &inputs)?;
        let holds = |name: &str| path.join(name).try_exists().unwrap_or(true);
        // A session that was not recorded to its end may have its commands nowhere else.
        let is_resumable =
            tenant == Tenant::Unfinished && (holds(checkpoint::NAME) || holds(request::LOG));
        match is_resumable && !again {
            true => Err(RecordRunError::Resumable {
                folder: path.to_owned(),
            }),
            false => Ok(tenant),
        }
    }

    /// Completes a folder whose run was killed between its end and its completion; returns true in this case.
    ///
    /// # Errors
    /// [`RecordRunError::Output`].
    pub fn settle(path: &Path) -> Result<bool, RecordRunError> {
        let Ok(folder) = OwnedFolder::reopen(path, KIND) else {
            return Ok(false);
        };
        let summary = folder.read(summary::NAME)?;
        let summary: Option<serde_json::Value> =
            summary.and_then(|summary| serde_json::from_slice(&summary).ok());
        let Some(summary) = summary.filter(|_| matches!(folder.read(checkpoint::NAME), Ok(None)))
        else {
            return Ok(false);
        };
        if folder.is_unfinished()? {
            folder.finish(summary["outcome"] == "finished")?;
        } else {
            folder.forget_kept()?;
        }
        Ok(true)
    }

    /// Creates the folder of a new run. The results of an earlier run in it are kept next to it, under its name with
    /// `.old`, until the new ones are complete.
    ///
    /// # Errors
    /// [`RecordRunError`] for a folder that may not be used, see [`RunFolder::check`], for more frames than a folder
    /// may contain, and for inputs that can no longer be read.
    pub fn create(
        path: &Path,
        simulation: &Simulation,
        request: &Request,
    ) -> Result<Self, RecordRunError> {
        let scene = simulation.scene();
        Self::check(path, scene, None, request.again)?;
        let record = Record::of(scene, request)?;
        Self::claim(path, simulation, record, &Schedules::of(simulation), &[])
    }

    /// Creates the folder, with files in addition to those of a run.
    pub(crate) fn claim(
        path: &Path,
        simulation: &Simulation,
        record: Record,
        schedules: &Schedules,
        others: &[&str],
    ) -> Result<Self, RecordRunError> {
        let scene = simulation.scene();
        let frames = schedules.fields.map_or(0, |fields| fields.count());
        let columns = ProbeRows::new(simulation.body()).columns().len();
        let numbers = schedules.probes.count().saturating_mul(columns);
        let supports = simulation.body().held_parts()?.len();
        let energies = schedules.energy.count().saturating_mul(8 + 6 * supports);
        for (what, key, asked, most) in [
            ("frames of fields", "fields", frames, MOST_FRAMES),
            ("numbers in probes.csv", "probes", numbers, MOST_NUMBERS),
            (
                "numbers in tables of energy and reactions",
                "energy",
                energies,
                MOST_NUMBERS,
            ),
        ] {
            if asked > most {
                return Err(RecordRunError::TooMuch {
                    asked,
                    what,
                    most,
                    key,
                });
            }
        }
        let mut names: Vec<String> = [
            request::NAME,
            request::SCENE,
            checkpoint::NAME,
            tables::PROBES,
            tables::ENERGY,
            report::NAME,
            summary::NAME,
        ]
        .map(str::to_owned)
        .to_vec();
        names.extend(others.iter().map(|name| (*name).to_owned()));
        if !simulation.body().held_parts()?.is_empty() {
            names.push(tables::REACTIONS.to_owned());
        }
        if ToolRows::of(simulation.body()).is_some() {
            names.push(tool_rows::NAME.to_owned());
        }
        if schedules.fields.is_some() {
            names.extend([frames::SERIES, surface::NAME].map(str::to_owned));
            names.extend((0..frames).map(frames::frame_name));
        }
        let folder = OwnedFolder::claim(path, KIND, &scene.input_files(), &names)?;
        record.write(&folder, scene)?;
        Ok(Self { folder, record })
    }

    /// Opens the folder of an unfinished run, to continue it, and its scene.
    ///
    /// # Errors
    /// [`RecordRunError`] for a folder without a run, for one of another version, and for inputs that changed since.
    pub fn reopen(path: &Path) -> Result<(Self, Scene), RecordRunError> {
        let folder = OwnedFolder::reopen(path, KIND)?;
        let (record, scene) = Record::read(&folder)?;
        Ok((Self { folder, record }, scene))
    }

    /// True if the run in this folder is completed.
    ///
    /// # Errors
    /// [`RecordRunError`] for a summary that cannot be read.
    pub fn is_finished(&self) -> Result<bool, RecordRunError> {
        let summary = self.folder.read(summary::NAME)?;
        Ok(summary.is_some() && self.folder.read(checkpoint::NAME)?.is_none())
    }

    /// The requested largest number of threads.
    #[must_use]
    pub fn threads(&self) -> Option<&str> {
        self.record.threads.as_deref()
    }

    /// Runs a world that follows its scene, or continues from the last checkpoint, and completes the folder.
    ///
    /// # Errors
    /// [`RecordRunError`]. The files written until then remain, with the last checkpoint.
    pub fn run(
        &self,
        world: &mut World,
        companion: &mut dyn Companion,
    ) -> Result<RunEnd, RecordRunError> {
        let begun = Instant::now();
        let mass = world.cutter().map(Cutter::mass);
        let checkpoint = Checkpoint::restore(&self.folder, world)?;
        self.folder.remove(summary::NAME)?;
        let resumed = checkpoint.is_some();
        let scene = Arc::clone(world.scene());
        let schedules = Schedules::of(&scene);
        world.set_up()?;
        let mut balance = Balance::new(
            &scene,
            world.body(),
            Some(world.integrator()),
            schedules.energy,
        );
        let mut progress = Progress::default();
        if let Some(checkpoint) = checkpoint {
            balance = balance.resumed(checkpoint.progress.energy, checkpoint.row)?;
            progress = checkpoint.progress;
        }
        let (before, begins_at) = (progress.steps, world.t());
        let beginning = Beginning {
            schedules,
            balance,
            progress,
            resumed,
            saves: true,
        };
        let end = scene.run().steps;
        let recorded = self.record(world, beginning, companion, |world, shown| {
            loop {
                let left = end.saturating_sub(shown.steps());
                let ended = match world.advance_shown(left, shown) {
                    Ok(ended) => ended,
                    Err(error) => return refusal(error, world),
                };
                let stop = match ended {
                    sinew_world::Ended::Stopped => shown.recorder().stop,
                    _ => None,
                };
                if stop.is_some() {
                    let work = shown.work();
                    shown.recorder().save(world, work)?;
                }
                if stop != Some(Stop::Checkpoint) {
                    return Ok(Ended::of(ended, world.t()));
                }
            }
        })?;
        let times = frame_times(&schedules, recorded.progress.frames, scene.dt());
        let mut remarks = world.integrator().remarks();
        if resumed {
            // The method has seen no more, and may have counted.
            for remark in &mut remarks {
                *remark = format!("since the checkpoint at t = {begins_at} s: {remark}");
            }
        }
        let outrun = (world.body()).outrun(world.integrator(), scene.dt(), world.state());
        let end = End {
            world,
            before,
            stepping: Stepping::of_scene(&scene),
            remarks,
            outrun,
            times: &times,
            resumed,
            begun,
            cuts: cut_record(world, mass),
        };
        self.complete(&schedules, recorded, end)
    }

    /// Records the motion of a world while `drive` advances it.
    pub(crate) fn record<W: AsRef<World>>(
        &self,
        world: &mut W,
        beginning: Beginning,
        companion: &mut dyn Companion,
        drive: impl FnOnce(&mut W, &mut Shown<'_, RunRecorder<'_>>) -> Result<Ended, RecordRunError>,
    ) -> Result<Recorded, RecordRunError> {
        let Beginning {
            schedules,
            balance,
            progress,
            resumed,
            saves,
        } = beginning;
        let scene = Arc::clone(world.as_ref().scene());
        let body = Arc::clone(world.as_ref().body());
        let reactions = HeldParts::of(&body)?;
        let tools = ToolRows::of(&body);
        let tables = Tables::open(
            &self.folder,
            &progress.seals,
            &balance,
            reactions.as_ref(),
            tools.as_ref(),
            &body,
        )?;
        let seen = Mutex::new(SeenInFrames {
            seen: progress.seen.clone(),
            seals: progress.seals.frames.clone(),
        });
        let before = progress.steps;
        thread::scope(|scope| {
            let frames = body.model().body().map(|model| {
                let settings = (scene.dt(), *scene.scene().output());
                let job = FrameJob::new(&self.folder, model, settings, &seen);
                FrameWriter::start(scope, job)
            });
            let mut recorder = RunRecorder {
                folder: &self.folder,
                companion,
                schedules,
                tables,
                probes: ProbeRows::new(&body),
                scene,
                body,
                balance,
                reactions,
                tools,
                frames,
                progress,
                frame_times: Vec::new(),
                saves,
                stop: None,
                watched: before + usize::from(resumed),
                pace: Pace::new(before),
                saved: Instant::now(),
                line: String::new(),
                v: Vec::new(),
            };
            let mut shown = match resumed {
                true => world.as_ref().show_again(&mut recorder, before),
                false => world.as_ref().show(&mut recorder),
            };
            let ended = drive(world, &mut shown)?;
            let (steps, work) = (shown.steps() - before, shown.work());
            let progress = recorder.settle()?;
            Ok(Recorded {
                progress,
                steps,
                work,
                ended,
                times: recorder.frame_times,
            })
        })
    }

    /// Writes the files of the folder of a finished run.
    pub(crate) fn complete(
        &self,
        schedules: &Schedules,
        recorded: Recorded,
        end: End<'_>,
    ) -> Result<RunEnd, RecordRunError> {
        let Recorded {
            mut progress,
            steps,
            work,
            ended,
            times: _,
        } = recorded;
        let End {
            world,
            before,
            stepping,
            remarks,
            outrun,
            times,
            resumed,
            begun,
            cuts,
        } = end;
        let (scene, moving, state) = (world.scene(), world.body(), world.state());
        progress.work.add(work);
        let surface = moving.model().body().map(|body| body.surface());
        if let (Some(surface), Some(body)) = (surface, moving.model().body()) {
            surface::write(surface, &self.folder, &body.mesh)?;
            frames::write_series(&self.folder, times)?;
        }
        let parts = moving.held_parts()?;
        if let Some(body) = moving.model().body()
            && matches!(ended, Ended::Refused { .. } | Ended::Interrupted { .. })
        {
            // A run that came to its end, or beyond all bounds, has been checked as far as it goes.
            let mut overlaps = OverlapWatch::new(body);
            overlaps.look_at_state(state)?;
            progress.seen.see_overlap(overlaps.deepest());
        }
        let mut warnings = summary::warnings(&progress.seen);
        warnings.extend(summary::driven_by_damping(&progress));
        let (methods, saturates) = (stepping.methods_in_words(), progress.work.saturated > 0);
        let taken = progress.taken.in_words(moving, &methods, saturates);
        warnings.extend(summary::made_energy(scene, moving, &progress));
        // Where loads turn too fast for either, both say so.
        warnings.extend(taken.filter(|taken| !warnings.contains(taken)));
        warnings.extend(outrun);
        warnings.extend(moving.left_by_tools(state));
        warnings.extend(cuts.iter().flat_map(|cuts| cuts.left.clone()));
        let wall = begun.elapsed().as_secs_f64();
        let summary = Summary {
            scene,
            body: moving,
            record: &self.record,
            ended: &ended,
            steps: before + steps,
            stepping: &stepping,
            t: state.t(),
            progress: &progress,
            schedules,
            parts: &parts,
            integrator: world.integrator(),
            remarks: &remarks,
            wall,
            resumed,
            warnings: &warnings,
            cuts: cuts.as_ref(),
        };
        for (frame, seal) in progress.seals.frames.iter().enumerate() {
            seal.check_length(&self.folder, &frames::frame_name(frame))?;
        }
        let page = report::page(&summary, surface.map(|surface| &**surface), &self.folder)?;
        self.folder.write(report::NAME, page.as_bytes())?;
        self.folder.secure()?;
        self.folder
            .write(summary::NAME, summary.to_json().as_bytes())?;
        // Whoever finds no checkpoint beside a summary knows that the run has come to its end.
        let mut replaced = Replaced::Whole;
        if !matches!(ended, Ended::Interrupted { .. }) {
            self.folder.remove(checkpoint::NAME)?;
            replaced = self.folder.finish(ended == Ended::Finished)?;
        }
        let (own, steps, seen, work) = (
            steps,
            before + steps,
            progress.seen.displacement,
            progress.work,
        );
        Ok(RunEnd {
            ended,
            steps,
            stepping,
            own: (own, wall),
            frames: progress.frames,
            work: (work.sweeps, work.solves),
            saturated: work.saturated_share(steps, moving.system().dofs()),
            retaken: work.retaken,
            largest: (seen.value, seen.t, seen.at),
            cuts: cuts.map(|cuts| (cuts.totals, cuts.pieces)),
            remarks,
            warnings,
            replaced,
        })
    }

    /// The open folder.
    pub(crate) fn folder(&self) -> &OwnedFolder {
        &self.folder
    }
}

/// Record of the cuts since the body had this mass (kg), if it may be cut.
pub(crate) fn cut_record(world: &World, mass: Option<f64>) -> Option<CutRecord> {
    let cuts = world.cutter().zip(mass);
    cuts.map(|(cutter, mass)| CutRecord::of(cutter, mass))
}

/// End of a motion by an error: a law refused a state, or a method found no equilibrium.
///
/// # Errors
/// Any other error, unchanged.
fn refusal(error: AdvanceError, world: &World) -> Result<Ended, RecordRunError> {
    let refused = |t: f64, reason: String| Ok(Ended::Refused { t, reason });
    let is_linear = world.body().system().as_linear().is_some();
    match error {
        AdvanceError::Step(WorldStepError::Cutting(source)) => {
            refused(world.t(), source.to_string())
        }
        AdvanceError::Step(WorldStepError::Step(error)) => match &error {
            StepError::Inaccurate { t, .. } if !is_linear => refused(*t, error.to_string()),
            StepError::NotConverged { t, .. } => refused(*t, error.to_string()),
            StepError::Refused { t, source } => refused(*t, source.to_string()),
            _ => Err(SimulateError::Step(error).into()),
        },
        AdvanceError::Step(error) => Err(error.into()),
        AdvanceError::Record(error) => {
            let t = error.t;
            match cause(error) {
                RecordRunError::State(refusal) => refused(t, refusal.to_string()),
                other => Err(other),
            }
        }
    }
}

/// The cause of a recorder's failure.
pub(crate) fn cause(RecordError { t, source }: RecordError) -> RecordRunError {
    match source.downcast::<RecordRunError>() {
        Ok(cause) => *cause,
        Err(source) => SimulateError::Record(RecordError { t, source }).into(),
    }
}

/// Times (s) of the frames that were written.
fn frame_times(schedules: &Schedules, count: usize, dt: f64) -> Vec<f64> {
    let mut times = Vec::with_capacity(count);
    let mut from = 0;
    while let Some(step) = schedules.fields.and_then(|fields| fields.next(from)) {
        if times.len() == count {
            break;
        }
        times.push(step as f64 * dt);
        from = step + 1;
    }
    times
}
