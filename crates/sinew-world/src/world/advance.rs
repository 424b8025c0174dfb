//! The steps of a world.

use std::cell::OnceCell;
use std::sync::Arc;

use sinew_core::{Batch, Clock, Outcome, RecordedSteps, Run, SimulateError, StepReport};
use sinew_scene::{Cutter, SceneBody};
use sinew_tools::Pose;

use super::{Advanced, Ended, World};
use crate::command::Command;
use crate::error::{AdvanceError, AdvanceToError, WorldStepError};
use crate::recorder::{BodyCut, Recorder, Shown};

impl World {
    /// Takes one step of [`World::dt`].
    ///
    /// # Errors
    /// [`WorldStepError`] if the motion diverges, a law refuses a state or a method finds no solution: only
    /// [`Command::Reset`](crate::Command::Reset) continues from there, and every other step gives the same error.
    pub fn step(&mut self) -> Result<StepReport, WorldStepError> {
        self.guarded(|world| {
            world.begin_step()?;
            let system = world.body.system();
            let mut batch = Batch::new(system, &world.inputs, world.method.dt, 1);
            batch = batch.with_divergence_limit(world.limit);
            let taken = batch.take(&mut *world.method.integrator, &mut world.state);
            let (count, work, diverged) = (batch.taken(), batch.work(), batch.diverged());
            world.count(count);
            taken?;
            match diverged {
                Some(dof) => Err(world.diverged(dof)),
                None => Ok(work),
            }
        })
    }

    /// Takes steps observed by a recorder, which receives the present state first.
    ///
    /// # Errors
    /// [`AdvanceError`].
    pub fn advance<R: Recorder + ?Sized>(
        &mut self,
        steps: usize,
        recorder: &mut R,
    ) -> Result<Ended, AdvanceError> {
        let mut shown = self.show(recorder);
        self.advance_shown(steps, &mut shown)
    }

    /// Takes the steps of [`World::dt`] that cover the time up to `t` (s): no steps for the present time, and for a
    /// time that the last step passed.
    ///
    /// # Errors
    /// [`AdvanceToError`], also for a time before the last step, and one that is not finite.
    pub fn advance_to<R: Recorder + ?Sized>(
        &mut self,
        t: f64,
        recorder: &mut R,
    ) -> Result<Ended, AdvanceToError> {
        let now = self.t();
        let last = self.state.clock.last_step().unwrap_or(0.0);
        let is_reached = t > now - last || t >= now - Clock::ROUNDING * now.abs();
        if !t.is_finite() || !is_reached {
            return Err(AdvanceToError::Time { t, now });
        }
        let steps = Run::covering(t - now, self.dt()).steps;
        Ok(self.advance(steps, recorder)?)
    }

    /// Advances by a time (s) in steps of [`World::dt`]; if the time is not a multiple of it, the steps are equal and
    /// shorter. A single short step among long ones would add energy with methods that are stable in steps of
    /// constant length only.
    ///
    /// # Errors
    /// [`AdvanceToError`], also for a time that is negative or not finite.
    pub fn advance_by<R: Recorder + ?Sized>(
        &mut self,
        by: f64,
        recorder: &mut R,
    ) -> Result<Advanced, AdvanceToError> {
        let (now, dt, before) = (self.t(), self.dt(), self.steps);
        if !(by >= 0.0 && by.is_finite()) {
            return Err(AdvanceToError::Time { t: now + by, now });
        }
        let steps = (by / dt * (1.0 - Clock::ROUNDING)).ceil();
        let each = by / steps;
        let shortened = (steps > 0.0 && each < dt * (1.0 - Clock::ROUNDING)).then_some(each);
        if let Some(each) = shortened {
            self.command(Command::Dt(each))?;
        }
        let ended = self.advance(steps as usize, recorder);
        if shortened.is_some() && self.failure.is_none() {
            self.command(Command::Dt(dt))?;
        }
        let ended = ended?;
        Ok(Advanced {
            ended,
            steps: self.steps - before,
            shortened,
        })
    }

    /// A recorder that has not seen the present state.
    pub fn show<'r, R: Recorder + ?Sized>(&self, recorder: &'r mut R) -> Shown<'r, R> {
        Shown {
            steps: RecordedSteps::new(recorder),
            body: Arc::clone(&self.body),
        }
    }

    /// A recorder that has already seen the motion up to the present state, in `steps` steps.
    pub fn show_again<'r, R: Recorder + ?Sized>(
        &self,
        recorder: &'r mut R,
        steps: usize,
    ) -> Shown<'r, R> {
        Shown {
            steps: RecordedSteps::resumed(recorder, steps),
            body: Arc::clone(&self.body),
        }
    }

    /// Takes steps observed by a recorder that may have received other steps before.
    ///
    /// Between two actions of a blade, steps are taken in batches, as in [`sinew_core::simulate()`].
    ///
    /// # Errors
    /// [`AdvanceError`] if a step or the recorder fails, and for a motion that has already failed, also if no steps are
    /// requested. A step that fails is counted as in [`World::step`].
    pub fn advance_shown<R: Recorder + ?Sized>(
        &mut self,
        steps: usize,
        shown: &mut Shown<'_, R>,
    ) -> Result<Ended, AdvanceError> {
        if let Some(failure) = &self.failure {
            return Err(failure.clone().into());
        }
        let end = shown.steps().saturating_add(steps);
        // The body before any cut is what stands at the beginning.
        let ended = self.take(0, shown)?;
        if steps == 0 || ended != Ended::Finished {
            return Ok(ended);
        }
        loop {
            let span = self.guarded(Self::begin_step)?;
            shown.follow(&self.body, &self.inputs, self.change.as_ref())?;
            let ended = self.take(span.min(end - shown.steps()), shown)?;
            if ended != Ended::Finished || shown.steps() >= end {
                return Ok(ended);
            }
        }
    }

    /// Takes steps during which nothing is cut or steered.
    fn take<R: Recorder + ?Sized>(
        &mut self,
        steps: usize,
        shown: &mut Shown<'_, R>,
    ) -> Result<Ended, AdvanceError> {
        shown.follow(&self.body, &self.inputs, None)?;
        let run = Run {
            dt: self.method.dt,
            steps,
            divergence_limit: self.limit,
        };
        let before = shown.steps();
        let system = (self.body.system(), &self.inputs);
        let taken = shown
            .steps
            .take(system, &mut *self.method.integrator, &mut self.state, &run);
        self.count(shown.steps() - before);
        match taken {
            Ok(Outcome::Finished) => Ok(Ended::Finished),
            Ok(Outcome::Stopped) => Ok(Ended::Stopped),
            Ok(Outcome::Diverged { dof, .. }) => {
                let failure = self.diverged(dof);
                self.failure = Some(failure.clone());
                match failure {
                    WorldStepError::Diverged { t, place } => Ok(Ended::Diverged { t, place }),
                    failure => Err(failure.into()),
                }
            }
            Err(SimulateError::Step(error)) => {
                let failure = WorldStepError::from(error);
                self.failure = Some(failure.clone());
                Err(failure.into())
            }
            Err(SimulateError::Record(error)) => Err(error.into()),
        }
    }

    /// Stores the failure of a step.
    fn guarded<T>(
        &mut self,
        act: impl FnOnce(&mut Self) -> Result<T, WorldStepError>,
    ) -> Result<T, WorldStepError> {
        if let Some(failure) = &self.failure {
            return Err(failure.clone());
        }
        let acted = act(self);
        if let Err(failure) = &acted {
            self.failure = Some(failure.clone());
        }
        acted
    }

    /// Counts steps that were taken.
    fn count(&mut self, steps: usize) {
        self.steps += steps;
        self.reached = self.state.t();
        self.log.ends_after(self.steps);
    }

    fn diverged(&self, dof: usize) -> WorldStepError {
        WorldStepError::Diverged {
            t: self.state.t(),
            place: self.body.system().cell_name(dof),
        }
    }

    /// Steers tools, scales loads and cuts at the beginning of a step; returns the number of steps until it must be
    /// called again.
    fn begin_step(&mut self) -> Result<usize, WorldStepError> {
        let dt = self.method.dt;
        let mut clock = self.state.clock;
        clock.advance(dt);
        let (t, end) = (self.state.t(), clock.time());
        if end <= t {
            return Err(WorldStepError::Time { t, dt });
        }
        self.move_tools(t, end)?;
        for load in &mut self.loads {
            if let Some(factor) = load.next.take() {
                self.inputs.set(load.channel, t, factor)?;
            }
        }
        for hand in &mut self.tools {
            if let Some(closed) = hand.next_jaws.take() {
                hand.steering.set_jaws(&mut self.inputs, t, closed)?;
            }
        }
        self.give_forces(t)?;
        self.cut_before(end)?;
        if self.tools.iter().any(|hand| hand.target.is_some()) {
            return Ok(1);
        }
        let idle = self.cutter.as_ref().map(|cutter| {
            let clock = self.state.clock;
            cutter.idle_steps(clock, dt, &self.undriven, &self.inputs)
        });
        Ok(idle.unwrap_or(usize::MAX).max(1))
    }

    /// Applies the cuts of users and of the scene at the beginning of a step that ends at `end` (s).
    fn cut_before(&mut self, end: f64) -> Result<(), WorldStepError> {
        self.change = None;
        let drives_loads = self.drives_loads();
        let Some(cutter) = &mut self.cutter else {
            return Ok(());
        };
        let is_due = || cutter.is_due(end, self.method.dt, &self.undriven, &self.inputs);
        if self.sheets.is_empty() && !is_due() {
            return Ok(());
        }
        let energy = cutter.totals().energy();
        let (state, inputs) = (&mut self.state, &self.inputs);
        let (trial, mut is_kept) = (&mut self.trial, false);
        // Keeps the state before the first act that changes it: few do.
        let mut keep = |cutter: &Cutter| {
            if let Some(before) = cutter.state_before().filter(|_| !is_kept) {
                trial.clone_from(before);
                is_kept = true;
            }
        };
        let mut all_acts = || {
            let mut changed: Option<SceneBody> = None;
            for sheet in self.sheets.drain(..) {
                if self.blade.replace(sheet[1]) != Some(sheet[0]) {
                    cutter.lift();
                }
                let now = changed.as_ref().unwrap_or(&self.undriven);
                let cut = cutter.cut(sheet, now, state, inputs);
                keep(cutter);
                changed = cut?.or(changed);
            }
            let now = changed.as_ref().unwrap_or(&self.undriven);
            let cut = cutter.follow(now, state, inputs, end);
            keep(cutter);
            Ok(cut?.or(changed))
        };
        let acted = all_acts();
        let changed = match acted {
            Ok(Some(changed)) => changed,
            Ok(None) => return Ok(()),
            Err(error) => {
                // What is shown of a session that failed is one body with its own state.
                if is_kept {
                    self.state.clone_from(&self.trial);
                }
                return Err(WorldStepError::Cutting(error));
            }
        };
        self.change = Some(BodyCut {
            before: self.trial.clone(),
            after: self.state.clone(),
            energy: cutter.totals().energy() - energy,
        });
        super::forces::carry(&mut self.inputs, &self.undriven, &changed)?;
        self.undriven = Arc::new(changed);
        self.topology_epoch += 1;
        self.body = Arc::clone(&self.undriven);
        if drives_loads {
            let driven = self.driven(&self.undriven);
            self.body = driven.map_err(|error| WorldStepError::Driven(error.to_string()))?;
        }
        self.method.stable_step = OnceCell::new();
        self.parked = None;
        Ok(())
    }

    /// Sets the poses of all tools that a user steers, at the end (s) of a step that begins at `t` (s).
    fn move_tools(&mut self, t: f64, end: f64) -> Result<(), WorldStepError> {
        let last = self.state.clock.last_step().unwrap_or(0.0);
        for (index, hand) in self.tools.iter_mut().enumerate() {
            let Some((position, rotation_vector)) = hand.target else {
                continue;
            };
            if !hand.is_steered {
                // A tool that is a body of its own is coupled to the user's tool pose: that one is steered.
                let own = self.body.model().tools();
                let own = own.and_then(|tools| tools.tools().get(index));
                let own = own.map_or(Pose::identity(), |tool| tool.motion.at(t, &self.inputs));
                hand.steering
                    .set(&mut self.inputs, t, own.position(), own.rotation_vector())?;
                hand.is_steered = true;
            }
            hand.steering
                .set(&mut self.inputs, end, position, rotation_vector)?;
            // Contact looks back by the step before.
            hand.steering
                .forget_before(&mut self.inputs, t - 2.0 * last);
        }
        Ok(())
    }
}
