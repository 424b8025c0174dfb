//! The folder of a run.

use std::path::Path;
use std::sync::Mutex;
use std::thread;
use std::time::Instant;

use sinew_core::{Outcome, RecordError, SimulateError, StepError, StepReport, System, simulate};
use sinew_integrators::Stepper;
use sinew_scene::output::{OutputError, OwnedFolder, Tenant};
use sinew_scene::{ProbeRows, Scene, Simulation};

use crate::balance::Balance;
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
use crate::summary::{self, Summary};
use crate::surface::{self, Surface};
use crate::tables::{self, Reactions};
use crate::tool_rows::{self, ToolRows};

/// The kind of result, in manifests and messages.
const KIND: &str = "run";

/// The folder of a run, open: nobody else writes into it.
#[derive(Debug)]
pub struct RunFolder {
    folder: OwnedFolder,
    record: Record,
}

impl RunFolder {
    /// Checks, before long work, that a run of this scene may write into a folder at `path`. Changes nothing.
    ///
    /// # Errors
    /// [`OutputError`] for a folder that holds other things or cannot be written.
    pub fn check(path: &Path, scene: &Scene) -> Result<Tenant, OutputError> {
        OwnedFolder::check(path, KIND, &scene.input_files())
    }

    /// Makes the folder of a new run; an earlier run's files in it are removed.
    ///
    /// # Errors
    /// [`RecordRunError`] for a folder that may not be used, and for inputs that cannot be read any more.
    pub fn create(
        path: &Path,
        simulation: &Simulation,
        request: &Request,
    ) -> Result<Self, RecordRunError> {
        let scene = simulation.scene();
        let record = Record::of(scene, request)?;
        let schedules = Schedules::of(simulation);
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
        if !simulation.held_parts()?.is_empty() {
            names.push(tables::REACTIONS.to_owned());
        }
        if ToolRows::of(simulation).is_some() {
            names.push(tool_rows::NAME.to_owned());
        }
        if let Some(fields) = schedules.fields {
            names.extend([frames::SERIES, surface::NAME].map(str::to_owned));
            names.extend((0..fields.count()).map(frames::frame_name));
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
        let system = simulation.system();
        integrator.prepare(system, simulation.dt())?;
        let checkpoint = Checkpoint::read(&self.folder, simulation)?;
        self.folder.remove(summary::NAME)?;
        let resumed = checkpoint.is_some();
        let schedules = Schedules::of(simulation);
        let balance = Balance::new(simulation, integrator, schedules.energy);
        let (mut state, progress, largest, balance) = match checkpoint {
            Some(Checkpoint {
                progress,
                state,
                row,
                largest,
            }) => {
                let balance = balance.resumed(progress.energy, row)?;
                (state, progress, largest, balance)
            }
            None => {
                let state = simulation.initial_state().clone();
                (state, Progress::default(), Vec::new(), balance)
            }
        };
        let reactions = Reactions::of(simulation)?;
        let parts = reactions
            .as_ref()
            .map_or_else(Vec::new, |reactions| reactions.parts.clone());
        let tools = ToolRows::of(simulation);
        let tables = Tables::open(
            &self.folder,
            progress.lengths,
            &balance,
            reactions.as_ref(),
            tools.as_ref(),
            simulation,
        )?;
        let body = simulation.model().body();
        let surface = body.map(|body| Surface::of(&body.mesh));
        let seen = Mutex::new(SeenInFrames {
            seen: progress.seen.clone(),
            largest,
        });
        let (before, begins_at) = (progress.steps, state.t());
        let mut run = simulation.run();
        run.steps -= before.min(run.steps);
        let (steps, work, ended, (mut progress, largest)) = thread::scope(|scope| {
            let frames = body.zip(surface.as_ref()).map(|(body, surface)| {
                let job = FrameJob {
                    folder: &self.folder,
                    mesh: &body.mesh,
                    surface,
                    fields: Fields::new(&body.model, *simulation.scene().output()),
                    seen: &seen,
                };
                FrameWriter::start(scope, job)
            });
            let mut recorder = RunRecorder {
                simulation,
                folder: &self.folder,
                companion,
                schedules,
                tables,
                probes: ProbeRows::new(simulation),
                balance,
                reactions,
                tools,
                frames,
                progress,
                before,
                resumed,
                watched: before,
                pace: Pace::new(before),
                saved: Instant::now(),
                line: String::new(),
                v: Vec::new(),
                work: StepReport::default(),
            };
            let simulated = simulate(system, integrator, &mut state, &run, &mut recorder);
            let (steps, work, ended) = match simulated {
                Ok(report) => {
                    let ended = match report.outcome {
                        Outcome::Finished => Ended::Finished,
                        Outcome::Diverged { t, dof } => Ended::Diverged {
                            t,
                            place: system.cell_name(dof),
                        },
                        Outcome::Stopped => Ended::Interrupted { t: state.t() },
                    };
                    (report.steps, report.work, ended)
                }
                Err(error) => {
                    // Steps are known by the time they reached; work since the last record is not.
                    let steps = (state.t() / simulation.dt()).floor() as usize;
                    let (t, reason) = refusal(error, system)?;
                    let ended = Ended::Refused { t, reason };
                    (steps.saturating_sub(before), recorder.work, ended)
                }
            };
            Ok::<_, RecordRunError>((steps, work, ended, recorder.settle()?))
        })?;
        progress.work.add(work);
        if let (Some(surface), Some(body)) = (&surface, body) {
            surface.write(&self.folder, &body.mesh)?;
            let times = frame_times(&schedules, progress.frames, simulation.dt());
            frames::write_series(&self.folder, &times)?;
        }
        let mut warnings = summary::warnings(&progress.seen);
        warnings.extend(summary::made_energy(simulation, &progress));
        warnings.extend(simulation.outrun(integrator, &state));
        warnings.extend(simulation.left_in_tools(&state));
        let wall = begun.elapsed().as_secs_f64();
        let mut remarks = integrator.remarks();
        if resumed {
            // The method has seen no more, and may have counted.
            for remark in &mut remarks {
                *remark = format!("since the checkpoint at t = {begins_at} s: {remark}");
            }
        }
        let summary = Summary {
            simulation,
            record: &self.record,
            ended: &ended,
            steps: before + steps,
            t: state.t(),
            progress: &progress,
            schedules: &schedules,
            parts: &parts,
            integrator,
            remarks: &remarks,
            wall,
            resumed,
            warnings: &warnings,
        };
        let page = report::page(&summary, surface.as_ref(), &largest, &self.folder)?;
        self.folder.write(report::NAME, page.as_bytes())?;
        self.folder
            .write(summary::NAME, summary.to_json().as_bytes())?;
        // Whoever finds no checkpoint beside a summary knows that the run has come to its end.
        if !matches!(ended, Ended::Interrupted { .. }) {
            self.folder.remove(checkpoint::NAME)?;
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
            own: (own, wall),
            frames: progress.frames,
            work: (work.sweeps, work.solves),
            saturated: work.saturated_share(steps, system.dofs()),
            retaken: work.retaken,
            largest: (seen.value, seen.t, seen.at),
            remarks,
            warnings,
        })
    }
}

/// Time (s) and reason of a refusal, by a law or by a method that found no equilibrium.
///
/// # Errors
/// Any other error, as it is.
fn refusal(error: SimulateError, system: &dyn System) -> Result<(f64, String), RecordRunError> {
    match error {
        SimulateError::Step(StepError::Inaccurate { t, .. }) if system.as_linear().is_none() => {
            Ok((t, error.to_string()))
        }
        SimulateError::Step(StepError::Refused { t, source }) => Ok((t, source.to_string())),
        SimulateError::Step(StepError::NotConverged { t, .. }) => Ok((t, error.to_string())),
        SimulateError::Record(RecordError { t, source }) => {
            match source.downcast::<RecordRunError>() {
                Ok(cause) => match *cause {
                    RecordRunError::State(refused) => Ok((t, refused.to_string())),
                    other => Err(other),
                },
                Err(source) => Err(SimulateError::Record(RecordError { t, source }).into()),
            }
        }
        other => Err(other.into()),
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
