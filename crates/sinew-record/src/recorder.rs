//! The recorder of a run: writes the due output after each step.

use std::sync::Arc;
use std::time::Instant;

use sinew_core::{Moment, RecordError, StepReport, Verdict};
use sinew_scene::output::OwnedFolder;
use sinew_scene::{HeldParts, Instants, ProbeRows, SceneBody, Schedule, Simulation};
use sinew_world::{BodyChange, Recorder, World};

use crate::balance::Balance;
use crate::checkpoint::Checkpoint;
use crate::companion::Companion;
use crate::error::RecordRunError;
use crate::frame_writer::{FrameWriter, SeenInFrames};
use crate::pace::Pace;
use crate::progress::{Progress, Seals};
use crate::seal::SealedTable;
use crate::tables;
use crate::tool_rows::{self, ToolRows};

/// Largest number of rows of a table, if the scene does not request more.
const MOST_ROWS: usize = 10_000;

/// Number of degrees of freedom up to which energies and reactions of every step are cheap.
const SMALL: usize = 30_000;

/// Schedules of all outputs of a run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Schedules {
    /// Steps of the run.
    pub(crate) steps: usize,
    pub(crate) probes: Schedule,
    pub(crate) energy: Schedule,
    /// Schedule of the fields; `None` for an oscillator.
    pub(crate) fields: Option<Schedule>,
}

impl Schedules {
    pub(crate) fn of(simulation: &Simulation) -> Self {
        Self::of_steps(simulation, simulation.run().steps, simulation.dt())
    }

    /// Schedules of a number of steps, of this length (s) on average.
    pub(crate) fn of_steps(simulation: &Simulation, steps: usize, dt: f64) -> Self {
        let output = simulation.scene().output();
        let asked = |instants: Option<Instants>| match instants {
            Some(instants) => Schedule::at(instants, steps, dt),
            None => Schedule::at_most(MOST_ROWS, steps),
        };
        // Of a larger body a row costs about as much as several steps, and has its velocity in common with a frame.
        let energy = match simulation.system().dofs() > SMALL {
            true => output.energy.or(Some(output.fields)),
            false => output.energy,
        };
        let body = simulation.model().body();
        Self {
            steps,
            probes: Schedule::of_probes(
                output.probes,
                ProbeRows::new(simulation.body()).columns().len(),
                MOST_ROWS,
                (steps, dt),
            ),
            energy: asked(energy),
            fields: body.map(|_| Schedule::at(output.fields, steps, dt)),
        }
    }
}

/// The files that grow.
pub(crate) struct Tables {
    probes: SealedTable,
    energy: SealedTable,
    reactions: Option<SealedTable>,
    tools: Option<SealedTable>,
}

impl Tables {
    /// Opens the tables, truncated to their length at an earlier run's checkpoint.
    pub(crate) fn open(
        folder: &OwnedFolder,
        seals: &Seals,
        balance: &Balance,
        reactions: Option<&HeldParts>,
        tools: Option<&ToolRows>,
        body: &SceneBody,
    ) -> Result<Self, RecordRunError> {
        Ok(Self {
            probes: SealedTable::open(folder, tables::PROBES, &seals.probes, || {
                tables::probes_head(body)
            })?,
            energy: SealedTable::open(folder, tables::ENERGY, &seals.energy, || {
                tables::energy_head(balance)
            })?,
            reactions: reactions
                .map(|held| {
                    SealedTable::open(folder, tables::REACTIONS, &seals.reactions, || {
                        tables::reactions_head(held)
                    })
                })
                .transpose()?,
            tools: tools
                .map(|rows| {
                    SealedTable::open(folder, tool_rows::NAME, &seals.tools, || rows.head())
                })
                .transpose()?,
        })
    }

    /// Makes sure that they are on the disk, and seals them.
    pub(crate) fn secure(
        &mut self,
        folder: &OwnedFolder,
        seals: &mut Seals,
    ) -> Result<(), RecordRunError> {
        seals.probes = self.probes.secure(folder)?;
        seals.energy = self.energy.secure(folder)?;
        if let Some(table) = &mut self.reactions {
            seals.reactions = table.secure(folder)?;
        }
        if let Some(table) = &mut self.tools {
            seals.tools = table.secure(folder)?;
        }
        Ok(())
    }
}

/// Writes the due output after each step of a run.
pub(crate) struct RunRecorder<'a> {
    pub(crate) scene: Arc<Simulation>,
    pub(crate) body: Arc<SceneBody>,
    pub(crate) folder: &'a OwnedFolder,
    pub(crate) companion: &'a mut dyn Companion,
    pub(crate) schedules: Schedules,
    pub(crate) tables: Tables,
    pub(crate) probes: ProbeRows,
    pub(crate) balance: Balance,
    pub(crate) reactions: Option<HeldParts>,
    pub(crate) tools: Option<ToolRows>,
    /// Writer of the frames; `None` for an oscillator.
    pub(crate) frames: Option<FrameWriter<'a>>,
    pub(crate) progress: Progress,
    /// Times (s) of the frames written since it began.
    pub(crate) frame_times: Vec<f64>,
    /// True if it writes checkpoints.
    pub(crate) saves: bool,
    /// The reason for which it stopped the run.
    pub(crate) stop: Option<Stop>,
    /// Number of steps whose rows of probes were received.
    pub(crate) watched: usize,
    pub(crate) pace: Pace,
    /// Instant of the last checkpoint, or of the beginning.
    pub(crate) saved: Instant,
    pub(crate) line: String,
    /// Velocity (m/s) at the moment that is being written.
    pub(crate) v: Vec<f64>,
}

/// The reason for which a recorder stops a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stop {
    /// A checkpoint is due, after which the run continues.
    Checkpoint,
    /// The user interrupted it.
    Interrupted,
}

impl RunRecorder<'_> {
    /// Writes the due output after this step.
    fn write(&mut self, step: usize, moment: &Moment<'_>) -> Result<Verdict, RecordRunError> {
        let energy = self.schedules.energy.is_due(step);
        let frame = self
            .schedules
            .fields
            .is_some_and(|fields| fields.is_due(step));
        let look = energy || self.balance.looks_at_every_step();
        if look || frame {
            // Of a staggered method it takes a force evaluation.
            self.v.resize(moment.state.u.len(), 0.0);
            moment.velocity(&mut self.v)?;
        }
        let row = match look {
            true => Some(self.balance.row(moment, &self.v)?),
            false => None,
        };
        if let Some(row) = &row {
            self.progress.taken.see(row);
        }
        if let Some(row) = row.filter(|_| energy) {
            let kinetic = &mut self.progress.kinetic;
            *kinetic = [kinetic[0].max(row.kinetic), row.kinetic];
            let [most, made] = self.progress.balance;
            let energy = row.kinetic + row.elastic;
            let most = most.max(energy);
            self.progress.balance = [most, made.max(row.remainder)];
            let has_changed = self.balance.has_changed();
            self.progress.crept.see(row.remainder, has_changed);
            tables::energy_row(&mut self.line, &row);
            self.tables.energy.push(&self.line)?;
            if let (Some(reactions), Some(file)) = (&mut self.reactions, &mut self.tables.reactions)
            {
                let t = moment.state.t();
                let before = self.balance.last.as_ref().map_or(0.0, |row| t - row.before);
                let next = self.schedules.energy.next(step + 1);
                let after = next.map_or(before, |next| (next - step) as f64 * self.scene.dt());
                tables::reactions_row(&mut self.line, reactions, moment, [before, after])?;
                file.push(&self.line)?;
            }
        }
        if frame {
            self.frame(moment)?;
        }
        if self.probes.need_moments() && self.schedules.probes.is_due(step) {
            let row = self.probes.of_moment(moment)?;
            self.tables.probes.push(row)?;
        }
        if let (Some(tools), Some(file)) = (&self.tools, &mut self.tables.tools)
            && self.schedules.probes.is_due(step)
        {
            tools.row(&mut self.line, moment, &mut self.progress.received);
            file.push(&self.line)?;
        }
        self.progress.steps = step;
        self.pace.look(step);
        let last = step == self.schedules.steps;
        self.companion.progress(step, moment.state.t());
        let due = self.saved.elapsed().as_secs_f64() >= self.scene.scene().output().checkpoint;
        self.stop = match (self.companion.is_interrupted(), self.saves && due) {
            _ if last => None,
            (true, _) => Some(Stop::Interrupted),
            (false, true) => Some(Stop::Checkpoint),
            (false, false) => None,
        };
        Ok(match self.stop {
            Some(_) => Verdict::Stop,
            None => Verdict::Continue,
        })
    }

    fn frame(&mut self, moment: &Moment<'_>) -> Result<(), RecordRunError> {
        let Some(frames) = &mut self.frames else {
            return Ok(());
        };
        let has_acceleration = self.scene.scene().output().acceleration;
        frames.write(self.progress.frames, moment, &self.v, has_acceleration)?;
        self.progress.frames += 1;
        self.frame_times.push(moment.state.t());
        Ok(())
    }

    /// Updates the balance to the last moment of this body, for which no row needs to be due.
    pub(crate) fn close_balance(&mut self, moment: &Moment<'_>) -> Result<(), RecordRunError> {
        let t = moment.state.t();
        if self.balance.last.as_ref().is_some_and(|last| last.t >= t) {
            return Ok(());
        }
        self.v.resize(moment.state.u.len(), 0.0);
        moment.velocity(&mut self.v)?;
        self.balance.row(moment, &self.v)?;
        Ok(())
    }

    /// Completes pending writes; returns the progress of the run.
    pub(crate) fn settle(&mut self) -> Result<Progress, RecordRunError> {
        self.tables.secure(self.folder, &mut self.progress.seals)?;
        self.progress.energy = self.balance.sums;
        let Some(frames) = &mut self.frames else {
            return Ok(self.progress.clone());
        };
        let SeenInFrames { seen, seals } = frames.settle()?.clone();
        self.progress.seen = seen;
        self.progress.seals.frames = seals;
        Ok(self.progress.clone())
    }

    /// Writes a checkpoint of a world that it stopped, after this work.
    pub(crate) fn save(&mut self, world: &World, work: StepReport) -> Result<(), RecordRunError> {
        let mut progress = self.settle()?;
        let row = self.balance.last.clone().unwrap_or_default();
        progress.work.add(work);
        // What the checkpoint counts on is there before it is.
        self.folder.secure()?;
        let checkpoint = Checkpoint { progress, row };
        checkpoint.write(self.folder, world)?;
        self.saved = Instant::now();
        Ok(())
    }

    fn change_body(&mut self, change: &BodyChange<'_>) -> Result<(), RecordRunError> {
        let body = change.body;
        match change.cut {
            None => self.balance.change_loads(body),
            Some(cut) => {
                self.close_balance(&Moment {
                    system: Arc::clone(&self.body).system(),
                    inputs: change.inputs,
                    state: &cut.before,
                    step: change.steps,
                    work: change.work,
                })?;
                self.balance.change_body(body, cut)?;
                self.probes = ProbeRows::new(body);
                self.reactions = HeldParts::of(body)?;
                self.tools = ToolRows::of(body);
                if let (Some(frames), Some(model)) = (&mut self.frames, body.model().body()) {
                    frames.change_body(model);
                }
            }
        }
        self.body = Arc::clone(body);
        Ok(())
    }
}

fn failed(t: f64, error: RecordRunError) -> RecordError {
    RecordError {
        t,
        source: Box::new(error),
    }
}

impl sinew_core::Recorder for RunRecorder<'_> {
    fn next(&mut self, step: usize) -> Option<usize> {
        let fields = self.schedules.fields.and_then(|fields| fields.next(step));
        let energy = match self.balance.looks_at_every_step() {
            true => Some(step),
            false => self.schedules.energy.next(step),
        };
        let end = self.schedules.steps;
        let probes = match self.probes.need_moments() || self.tools.is_some() {
            true => self.schedules.probes.next(step),
            false => None,
        };
        let look = self.pace.next().clamp(step, end.max(step));
        [fields, energy, probes, Some(look)]
            .into_iter()
            .flatten()
            .min()
    }

    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        self.write(moment.step, moment)
            .map_err(|error| failed(moment.state.t(), error))
    }

    fn watches(&self) -> Vec<u32> {
        self.probes.watched()
    }

    fn watched(&mut self, t: f64, u: &[f64]) -> Result<Verdict, RecordError> {
        let step = self.watched;
        self.watched += 1;
        if self.schedules.probes.is_due(step) {
            let row = self.probes.of_watched(t, u);
            let written = self.tables.probes.push(row);
            written.map_err(|error| failed(t, error))?;
        }
        Ok(Verdict::Continue)
    }
}

impl Recorder for RunRecorder<'_> {
    fn body_changed(&mut self, change: &BodyChange<'_>) -> Result<(), RecordError> {
        let t = change.cut.map_or(0.0, |cut| cut.before.t());
        self.change_body(change).map_err(|error| failed(t, error))
    }
}
