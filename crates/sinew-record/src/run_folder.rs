//! The folder of a run.

use std::cell::RefCell;
use std::path::Path;
use std::sync::Mutex;
use std::thread;
use std::time::Instant;

use sinew_core::{State, StepReport};
use sinew_integrators::Stepper;
use sinew_mesh::BoundarySurface;
use sinew_scene::output::{OwnedFolder, Replaced, Tenant};
use sinew_scene::{Cutter, OverlapWatch, ProbeRows, Scene, Simulation};

use crate::balance::{Balance, LastRow};
use crate::checkpoint::{self, Checkpoint};
use crate::companion::Companion;
use crate::error::RecordRunError;
use crate::fields::Fields;
use crate::frame_writer::{FrameJob, FrameWriter, SeenInFrames};
use crate::frames;
use crate::pace::Pace;
use crate::progress::Progress;
use crate::recorder::{RunRecorder, Schedules, Tables};
use crate::report;
use crate::request::{self, Record, Request};
use crate::run_end::{Ended, RunEnd};
use crate::stepping::Stepping;
use crate::stretch;
use crate::summary::{self, CutRecord, Summary};
use crate::surface;
use crate::tables::{self, HeldPart, Reactions};
use crate::tool_rows::{self, ToolRows};

/// The kind of result, in manifests and messages.
const KIND: &str = "run";

/// Most frames of a folder: more are a mistake, and their list alone would be long.
const MOST_FRAMES: usize = 100_000;

/// Most numbers of a table, about two gigabytes.
pub const MOST_NUMBERS: usize = 100_000_000;

/// The folder of a run, open: nobody else writes into it.
#[derive(Debug)]
pub struct RunFolder {
    folder: OwnedFolder,
    record: Record,
}

/// What a recorder begins with.
pub(crate) struct Beginning<'a> {
    pub(crate) schedules: Schedules,
    pub(crate) balance: Balance<'a>,
    pub(crate) progress: Progress,
    /// Displacements (m) of the surface where it was largest so far.
    pub(crate) largest: Vec<f64>,
    pub(crate) resumed: bool,
    pub(crate) saves: bool,
    /// What cuts the body, where something does.
    pub(crate) cutter: Option<&'a RefCell<Cutter>>,
}

/// What a balance of energy goes on from.
enum From {
    Beginning,
    /// The last row before a checkpoint.
    Row(LastRow),
    /// A change of the body that brought in this energy (J).
    Change(f64),
}

/// What a recorder leaves.
pub(crate) struct Recorded {
    pub(crate) progress: Progress,
    largest: Vec<f64>,
    parts: Vec<HeldPart>,
    surface: Option<BoundarySurface>,
    /// Times (s) of the frames that it wrote.
    pub(crate) times: Vec<f64>,
}

/// The end of a run that is recorded.
pub(crate) struct End<'a> {
    /// Steps of an earlier process, and of this one.
    pub(crate) steps: (usize, usize),
    pub(crate) stepping: Stepping,
    pub(crate) work: StepReport,
    pub(crate) ended: Ended,
    pub(crate) state: &'a State,
    pub(crate) integrator: &'a dyn Stepper,
    pub(crate) remarks: Vec<String>,
    /// A warning where the step is too long for the body as it is in the end.
    pub(crate) outrun: Option<String>,
    /// Times (s) of all frames.
    pub(crate) times: &'a [f64],
    pub(crate) resumed: bool,
    pub(crate) begun: Instant,
    /// What was cut, where the body may be cut.
    pub(crate) cuts: Option<CutRecord>,
}

impl RunFolder {
    /// Checks, before long work, that a run of this scene, or a replay of its session by a file with the log, may write into a folder at `path`. Changes
    /// nothing but what [`RunFolder::settle`] completes.
    ///
    /// # Errors
    /// [`RecordRunError::Output`] for a folder that holds other things, what is to be read among them, or cannot be written, and
    /// [`RecordRunError::Resumable`] for one whose run can be gone on with, unless it is to be run `again`.
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

    /// Completes a folder whose run came to its end when it was killed before it said so; whether there is one.
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

    /// Makes the folder of a new run. The results of an earlier run in it are kept beside it, under its name with `.old`, until the new ones are complete.
    ///
    /// # Errors
    /// [`RecordRunError`] for a folder that may not be used, as [`RunFolder::check`] says, for more frames than a folder holds, and for inputs that cannot be
    /// read any more.
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

    /// Makes the folder, with files beside those of a run.
    pub(crate) fn claim(
        path: &Path,
        simulation: &Simulation,
        record: Record,
        schedules: &Schedules,
        others: &[&str],
    ) -> Result<Self, RecordRunError> {
        let scene = simulation.scene();
        let frames = schedules.fields.map_or(0, |fields| fields.count());
        let columns = ProbeRows::new(simulation).columns().len();
        let numbers = schedules.probes.count().saturating_mul(columns);
        let supports = simulation.held_parts()?.len();
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
        if !simulation.held_parts()?.is_empty() {
            names.push(tables::REACTIONS.to_owned());
        }
        if ToolRows::of(simulation).is_some() {
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

    /// Opens the folder of an unfinished run to go on with it, and its scene.
    ///
    /// # Errors
    /// [`RecordRunError`] for a folder without a run, for one of another version, and for inputs that changed since.
    pub fn reopen(path: &Path) -> Result<(Self, Scene), RecordRunError> {
        let folder = OwnedFolder::reopen(path, KIND)?;
        let (record, scene) = Record::read(&folder)?;
        Ok((Self { folder, record }, scene))
    }

    /// Whether the run in it has come to its end.
    ///
    /// # Errors
    /// [`RecordRunError`] for a summary that cannot be read.
    pub fn is_finished(&self) -> Result<bool, RecordRunError> {
        let summary = self.folder.read(summary::NAME)?;
        Ok(summary.is_some() && self.folder.read(checkpoint::NAME)?.is_none())
    }

    /// The largest number of threads that the run was asked for.
    #[must_use]
    pub fn threads(&self) -> Option<&str> {
        self.record.threads.as_deref()
    }

    /// Runs the scene, or goes on from the last checkpoint, and completes the folder.
    ///
    /// # Errors
    /// [`RecordRunError`]. What was written until then stays, with the last checkpoint.
    pub fn run(
        &self,
        simulation: &Simulation,
        integrator: &mut dyn Stepper,
        companion: &mut dyn Companion,
    ) -> Result<RunEnd, RecordRunError> {
        let begun = Instant::now();
        let cutter = simulation.cutter()?.map(RefCell::new);
        let cutter = cutter.as_ref();
        let mass = cutter.map(|cutter| cutter.borrow().mass());
        let checkpoint = Checkpoint::read(&self.folder, simulation, cutter)?;
        self.folder.remove(summary::NAME)?;
        let resumed = checkpoint.is_some();
        let schedules = Schedules::of(simulation);
        let mut state = simulation.initial_state().clone();
        let mut progress = Progress::default();
        // The scene on the body as cuts left it.
        let mut cut: Option<Simulation> = None;
        let (mut largest, mut from, mut steps) = (Vec::new(), From::Beginning, 0);
        if let Some(checkpoint) = checkpoint {
            state = checkpoint.state;
            progress = checkpoint.progress;
            cut = checkpoint.cut;
            largest = checkpoint.largest;
            from = From::Row(checkpoint.row);
        }
        let begins_on = cut.as_ref().unwrap_or(simulation);
        begins_on.set_up(integrator)?;
        let (before, begins_at) = (progress.steps, state.t());
        let mut run = simulation.run();
        run.steps -= before.min(run.steps);
        let (last, recorded) = loop {
            let now = cut.as_ref().unwrap_or(simulation);
            let balance = Balance::new(now, Some(integrator), schedules.energy);
            let is_seen = !matches!(from, From::Beginning);
            let balance = match std::mem::replace(&mut from, From::Beginning) {
                From::Beginning => balance,
                From::Row(row) => balance.resumed(progress.energy, row)?,
                From::Change(energy) => balance.after_change(progress.energy, &state, energy)?,
            };
            let beginning = Beginning {
                schedules,
                balance,
                progress: progress.clone(),
                largest: std::mem::take(&mut largest),
                resumed: is_seen,
                saves: true,
                cutter,
            };
            let (mut stretch, recorded) = self.record(now, beginning, companion, |recorder| {
                stretch::take(
                    now,
                    cutter,
                    integrator,
                    &mut state,
                    &run,
                    (recorder, is_seen),
                )
            })?;
            run.steps -= stretch.steps.min(run.steps);
            steps += stretch.steps;
            let Some(change) = stretch.change.take() else {
                break (stretch, recorded);
            };
            progress = recorded.progress;
            progress.steps = before + steps;
            progress.work.add(stretch.work);
            from = From::Change(change.energy);
            cut = Some(change.simulation);
        };
        let simulation = cut.as_ref().unwrap_or(simulation);
        let times = frame_times(&schedules, recorded.progress.frames, simulation.dt());
        let mut remarks = integrator.remarks();
        if resumed {
            // The method has seen no more, and may have counted.
            for remark in &mut remarks {
                *remark = format!("since the checkpoint at t = {begins_at} s: {remark}");
            }
        }
        let outrun = simulation.outrun(integrator, &state);
        let end = End {
            steps: (before, steps),
            stepping: Stepping::of_scene(simulation),
            work: last.work,
            ended: last.ended,
            state: &state,
            integrator,
            remarks,
            outrun,
            times: &times,
            resumed,
            begun,
            cuts: cutter
                .zip(mass)
                .map(|(cutter, mass)| CutRecord::of(&cutter.borrow(), mass)),
        };
        self.complete(simulation, &schedules, recorded, end)
    }

    /// Has a run recorded, which `drive` takes.
    pub(crate) fn record<R>(
        &self,
        simulation: &Simulation,
        beginning: Beginning<'_>,
        companion: &mut dyn Companion,
        drive: impl FnOnce(&mut RunRecorder<'_>) -> Result<R, RecordRunError>,
    ) -> Result<(R, Recorded), RecordRunError> {
        let Beginning {
            schedules,
            balance,
            progress,
            largest,
            resumed,
            saves,
            cutter,
        } = beginning;
        let reactions = Reactions::of(simulation)?;
        let parts = reactions
            .as_ref()
            .map_or_else(Vec::new, |reactions| reactions.parts.clone());
        let tools = ToolRows::of(simulation);
        let tables = Tables::open(
            &self.folder,
            &progress.seals,
            &balance,
            reactions.as_ref(),
            tools.as_ref(),
            simulation,
        )?;
        let body = simulation.model().body();
        let surface = body.map(|body| body.mesh.boundary_surface());
        let seen = Mutex::new(SeenInFrames {
            seen: progress.seen.clone(),
            largest,
            seals: progress.seals.frames.clone(),
        });
        let before = progress.steps;
        let (driven, progress, largest, times) = thread::scope(|scope| {
            let frames = body.zip(surface.as_ref()).map(|(body, surface)| {
                let job = FrameJob {
                    folder: &self.folder,
                    mesh: &body.mesh,
                    surface,
                    fields: Fields::new(&body.model, simulation.dt(), *simulation.scene().output()),
                    is_cut: body.cut.is_some(),
                    overlaps: OverlapWatch::new(body).with_surface(surface),
                    seen: &seen,
                };
                FrameWriter::start(scope, job)
            });
            let mut recorder = RunRecorder {
                simulation,
                folder: &self.folder,
                companion,
                cutter,
                schedules,
                tables,
                probes: ProbeRows::new(simulation),
                balance,
                reactions,
                tools,
                frames,
                progress,
                frame_times: Vec::new(),
                saves,
                before,
                watched: before + usize::from(resumed),
                pace: Pace::new(before),
                saved: Instant::now(),
                line: String::new(),
                v: Vec::new(),
                work: StepReport::default(),
            };
            let driven = drive(&mut recorder)?;
            let (progress, largest) = recorder.settle()?;
            Ok::<_, RecordRunError>((driven, progress, largest, recorder.frame_times))
        })?;
        let recorded = Recorded {
            progress,
            largest,
            parts,
            surface,
            times,
        };
        Ok((driven, recorded))
    }

    /// Writes what stands in the folder of a run that has come to an end.
    pub(crate) fn complete(
        &self,
        simulation: &Simulation,
        schedules: &Schedules,
        recorded: Recorded,
        end: End<'_>,
    ) -> Result<RunEnd, RecordRunError> {
        let Recorded {
            mut progress,
            largest,
            parts,
            surface,
            ..
        } = recorded;
        let End {
            steps: (before, steps),
            stepping,
            work,
            ended,
            state,
            integrator,
            remarks,
            outrun,
            times,
            resumed,
            begun,
            cuts,
        } = end;
        let system = simulation.system();
        progress.work.add(work);
        if let (Some(surface), Some(body)) = (&surface, simulation.model().body()) {
            surface::write(surface, &self.folder, &body.mesh)?;
            frames::write_series(&self.folder, times)?;
        }
        if let Some(body) = simulation.model().body()
            && matches!(ended, Ended::Refused { .. } | Ended::Interrupted { .. })
        {
            // A run that came to its end, or beyond all bounds, has been looked at as far as it goes.
            let mut overlaps = OverlapWatch::new(body);
            overlaps.look_at_state(state)?;
            progress.seen.see_overlap(overlaps.deepest());
        }
        let mut warnings = summary::warnings(&progress.seen);
        warnings.extend(summary::driven_by_damping(&progress));
        let (methods, saturates) = (stepping.methods_in_words(), progress.work.saturated > 0);
        let taken = progress.taken.in_words(simulation, &methods, saturates);
        warnings.extend(summary::made_energy(simulation, &progress));
        // Where loads turn too fast for either, both say so.
        warnings.extend(taken.filter(|taken| !warnings.contains(taken)));
        warnings.extend(outrun);
        warnings.extend(simulation.left_by_tools(state));
        warnings.extend(cuts.iter().flat_map(|cuts| cuts.left.clone()));
        let wall = begun.elapsed().as_secs_f64();
        let summary = Summary {
            simulation,
            record: &self.record,
            ended: &ended,
            steps: before + steps,
            stepping: &stepping,
            t: state.t(),
            progress: &progress,
            schedules,
            parts: &parts,
            integrator,
            remarks: &remarks,
            wall,
            resumed,
            warnings: &warnings,
            cuts: cuts.as_ref(),
        };
        for (frame, seal) in progress.seals.frames.iter().enumerate() {
            seal.check_length(&self.folder, &frames::frame_name(frame))?;
        }
        let page = report::page(&summary, surface.as_ref(), &largest, &self.folder)?;
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
            saturated: work.saturated_share(steps, system.dofs()),
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
