//! Batches of steps, with the checks and the bookkeeping that all methods share.

use crate::guard::Guarding;
use crate::system::loads_revision;
use crate::{
    Acceleration, Contact, DampedAt, Inertia, Inputs, LoadTime, Meeting, Revision, SetupError,
    ShowCells, State, StepError, StepReport, SynchroniseError, System, Trial, VelocityTime, Watch,
};

/// Steps to take, and the work around each: checks sizes, keeps the clock, applies a guard, passes the result to the
/// system, samples degrees of freedom, detects divergence.
pub struct Batch<'a> {
    system: &'a dyn System,
    inputs: &'a Inputs,
    /// Length of a step, or of a substep (s).
    dt: f64,
    /// Identity of the loads.
    loads: Option<[Revision; 2]>,
    steps: usize,
    taken: usize,
    /// Number of substeps of a step, and of those already taken in the current step.
    parts: u32,
    parts_taken: u32,
    /// Number of substeps of the current step after which the batch pauses.
    pause: u32,
    /// Work of the current step.
    step_work: StepReport,
    work: StepReport,
    divergence_limit: f64,
    diverged: Option<usize>,
    watch: Option<&'a mut Watch>,
    guarding: Option<Guarding>,
}

/// One step of a batch.
#[derive(Clone, Copy)]
pub struct Step<'a> {
    /// The system.
    pub system: &'a dyn System,
    /// External inputs.
    pub inputs: &'a Inputs,
    /// Length (s).
    pub dt: f64,
}

/// Parts of the state that the host may read or change as a step ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HostNeeds<'a> {
    /// True if the host reads all of u, v and the acceleration.
    pub all: bool,
    /// Degrees of freedom whose displacement the host samples.
    pub watched: &'a [u32],
    /// Cells whose u and v contact may read and change: contact requests those near its tools ([`ShowCells`]).
    pub contact: &'a [u32],
}

impl HostNeeds<'_> {
    /// True if the host reads and changes nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.all && self.watched.is_empty() && self.contact.is_empty()
    }
}

/// Result of a step, as the method reports it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stepped {
    /// Work of the step.
    pub work: StepReport,
    /// The velocity's time.
    pub velocity: VelocityTime,
    /// Instants at which damping takes velocities.
    pub damped: DampedAt,
    /// Kind of acceleration that the state keeps.
    pub acceleration: Acceleration,
}

impl Stepped {
    /// Result of a step that gives u and v at the same time and keeps no acceleration.
    #[must_use]
    pub fn at_same_time(work: StepReport) -> Self {
        Self {
            work,
            velocity: VelocityTime::Same,
            damped: DampedAt::default(),
            acceleration: Acceleration::None,
        }
    }
}

impl<'a> Step<'a> {
    /// `out = f_ext - f_int` (N) at a trial point, one sweep.
    ///
    /// # Errors
    /// [`StepError::Refused`] when the system refuses the point.
    pub fn net_force(
        &self,
        load: LoadTime<'_>,
        trial_dt: f64,
        [u, v, internal]: [&[f64]; 3],
        out: &mut [f64],
    ) -> Result<(), StepError> {
        let trial = Trial {
            load: load.under(self.inputs),
            dt: trial_dt,
            u,
            v,
            internal,
        };
        let refused = |source| StepError::Refused {
            t: load.t(),
            source,
        };
        self.system.net_force(&trial, out).map_err(refused)
    }

    /// `out = M^-1 (f_ext - f_int)` (m/s^2) in a state, one sweep.
    ///
    /// # Errors
    /// [`StepError::Refused`] when the system refuses the state.
    pub fn acceleration(
        &self,
        load: LoadTime<'_>,
        state: &State,
        out: &mut [f64],
    ) -> Result<(), StepError> {
        self.net_force(load, 0.0, [&state.u, &state.v, &state.internal], out)?;
        for (value, mass) in out.iter_mut().zip(self.system.mass()) {
            *value /= mass;
        }
        Ok(())
    }
}

impl<'a> Batch<'a> {
    /// `steps` steps of `dt` (s).
    #[must_use]
    pub fn new(system: &'a dyn System, inputs: &'a Inputs, dt: f64, steps: usize) -> Self {
        Self {
            system,
            inputs,
            dt,
            loads: loads_revision(system),
            steps,
            taken: 0,
            parts: 1,
            parts_taken: 0,
            pause: u32::MAX,
            step_work: StepReport::default(),
            work: StepReport::default(),
            divergence_limit: f64::INFINITY,
            diverged: None,
            watch: None,
            guarding: None,
        }
    }

    /// Ends at the first step after which a displacement is not finite or above `limit` (m).
    #[must_use]
    pub fn with_divergence_limit(mut self, limit: f64) -> Self {
        self.divergence_limit = limit;
        self
    }

    /// Samples degrees of freedom after every step that stays within the limit.
    #[must_use]
    pub fn with_watch(mut self, watch: &'a mut Watch) -> Self {
        self.watch = Some(watch);
        self
    }

    pub(crate) fn check(
        &self,
        integrator: &'static str,
        state: &mut State,
    ) -> Result<(), SetupError> {
        let dofs = self.system.dofs();
        let lengths = [state.u.len(), state.v.len()];
        if let Some(found) = lengths.into_iter().find(|length| *length != dofs) {
            return Err(SetupError::StateSize {
                integrator,
                state: found,
                system: dofs,
            });
        }
        if state.acceleration != Acceleration::None && state.a.len() != dofs {
            return Err(SetupError::StateSize {
                integrator,
                state: state.a.len(),
                system: dofs,
            });
        }
        if let (Some([matrices, loads]), Some(present)) = (state.loads, self.loads) {
            let is_same_body = present[0] == matrices;
            if is_same_body && present[1] != loads && state.velocity != VelocityTime::Same {
                return Err(SetupError::OtherLoads { integrator });
            }
            if is_same_body
                && present != [matrices, loads]
                && state.acceleration == Acceleration::Same
            {
                // It was kept under the loads or the rows before.
                state.acceleration = Acceleration::None;
            }
        }
        let internal = self.system.internal_variables();
        if state.internal.len() != internal {
            return Err(SetupError::Internal {
                integrator,
                state: state.internal.len(),
                system: internal,
            });
        }
        state
            .contact
            .resize(self.contact().map_or(0, Contact::kept), 0.0);
        if let Some(dof) = self.inputs.highest_dof()
            && dof as usize >= dofs
        {
            return Err(SetupError::ForceOutOfRange {
                integrator,
                dof,
                dofs,
            });
        }
        let loads = self.system.as_linear();
        let loads = loads.map_or(&[][..], |linear| linear.operators().loads());
        for load in loads {
            if let Some(channel) = load.ramp.missing_input(self.inputs) {
                return Err(SetupError::NoInput {
                    integrator,
                    channel: channel.0,
                });
            }
        }
        Ok(())
    }

    /// The system.
    #[must_use]
    pub fn system(&self) -> &'a dyn System {
        self.system
    }

    /// External inputs.
    #[must_use]
    pub fn inputs(&self) -> &'a Inputs {
        self.inputs
    }

    /// Length of a step, or of the current substep (s).
    #[must_use]
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Steps taken whole.
    #[must_use]
    pub fn taken(&self) -> usize {
        self.taken
    }

    /// Work of the steps taken.
    #[must_use]
    pub fn work(&self) -> StepReport {
        self.work
    }

    /// The degree of freedom farthest beyond the limit, if any. The last step taken is the first one that moved it
    /// there.
    #[must_use]
    pub fn diverged(&self) -> Option<usize> {
        self.diverged
    }

    /// True if there are steps left to take.
    #[must_use]
    pub fn goes_on(&self) -> bool {
        self.taken < self.steps && self.parts_taken < self.pause && self.diverged.is_none()
    }

    /// True if the next step or substep is the last, or the last before a pause.
    #[must_use]
    pub fn is_last(&self) -> bool {
        let next = self.parts_taken + 1;
        self.taken + 1 >= self.steps && next == self.parts || next == self.pause
    }

    /// Parts of the state that the host may read or change at the end of a step or substep: of the next one if `ahead`
    /// is 0, otherwise of the one `ahead` places after it.
    ///
    /// A machine with its own memory, such as a graphics processor, asks in advance: data that the host does not need
    /// can stay there. The last step of a batch shows all cells, and so does each step if the system reads the state
    /// after every step. A machine that finds a displacement beyond [`Batch::divergence_limit`], or an error, shows all
    /// cells as well.
    #[must_use]
    pub fn host_needs(&self, ahead: usize) -> HostNeeds<'_> {
        let next = self.parts_taken as usize + ahead + 1;
        let left = self.parts_left().min(match self.pause {
            u32::MAX => usize::MAX,
            pause => pause.saturating_sub(self.parts_taken) as usize,
        });
        let ends_step = next.is_multiple_of(self.parts.max(1) as usize);
        HostNeeds {
            all: self.looks_at_steps() || ahead + 1 >= left,
            watched: if ends_step { self.watched() } else { &[] },
            contact: self.contact().map_or(&[], Contact::cells),
        }
    }

    /// Number of coming steps or substeps after which the host reads and changes nothing.
    #[must_use]
    pub fn steps_alone(&self) -> usize {
        // Needs repeat from step to step, but for the end and a pause, which is within a step.
        let needs = |ahead: &usize| !self.host_needs(*ahead).is_empty();
        let first = (0..self.parts as usize).find(needs);
        first.unwrap_or(self.parts_left().saturating_sub(1))
    }

    /// The current step.
    #[must_use]
    pub fn step(&self) -> Step<'a> {
        Step {
            system: self.system,
            inputs: self.inputs,
            dt: self.dt,
        }
    }

    /// Limits of the guard that clamps the steps, if any.
    #[must_use]
    pub fn guarding(&self) -> Option<&Guarding> {
        self.guarding.as_ref()
    }

    /// Counts work that belongs to no step.
    pub fn count(&mut self, work: StepReport) {
        self.work += work;
    }

    /// Contact of the system, if any.
    #[must_use]
    pub fn contact(&self) -> Option<&'a dyn Contact> {
        self.system.contact()
    }

    /// Resolves contact on a trial state, before [`Batch::end_step`]; `pushed` receives the changed cells, and `cells`
    /// provides the cells that the contact requests. Components of velocities move displacements at a speed of at
    /// most
    /// `saturation` (m/s). `kick` is the time (s) by which a change of velocity is divided to correct the acceleration
    /// in the state.
    pub fn meet(
        &self,
        (state, cells): (&mut State, &mut dyn ShowCells),
        (inertia, saturation): (Inertia<'_>, f64),
        kick: Option<f64>,
        pushed: &mut Vec<u32>,
    ) {
        pushed.clear();
        if let Some(contact) = self.contact() {
            let meeting = Meeting {
                inputs: self.inputs,
                dt: self.dt,
                mass: self.system.mass(),
                inertia,
                kick,
                saturation,
                is_staggered: true,
            };
            contact.meet(&meeting, cells, state, pushed);
        }
    }

    /// Brings a staggered velocity to the displacement's time, for methods that do not stagger velocities. It acts only
    /// in the first step after another method advanced the state.
    ///
    /// # Errors
    /// [`StepError::Refused`] when the system refuses the state.
    pub fn synchronise(&mut self, state: &mut State) -> Result<(), StepError> {
        if state.velocity == VelocityTime::Same {
            return Ok(());
        }
        let mut buffer = vec![0.0; state.u.len()];
        let t = state.t();
        state
            .synchronise(self.system, self.inputs, &mut buffer)
            .map_err(|error| match error {
                SynchroniseError::Refused(source) => StepError::Refused { t, source },
                mean @ SynchroniseError::Mean { .. } => StepError::Synchronise(mean),
            })?;
        self.work += StepReport::ONE_FORCE;
        Ok(())
    }

    /// Takes all steps by calling `step` for each. `step` advances u, v and all other data of the state; the batch
    /// advances the clock.
    ///
    /// # Errors
    /// The error of the first step that fails.
    pub fn each(
        &mut self,
        state: &mut State,
        mut step: impl FnMut(Step<'a>, &mut State) -> Result<Stepped, StepError>,
    ) -> Result<(), StepError> {
        while self.goes_on() {
            if let Some(guarding) = &mut self.guarding {
                guarding.remember(state, self.dt);
            }
            let mut stepped = step(self.step(), state)?;
            if let Some(guarding) = &mut self.guarding {
                let clamped = guarding.apply(state, self.dt, stepped.acceleration);
                stepped.work.saturated = stepped.work.saturated.max(clamped);
            }
            self.end_step(state, stepped)?;
        }
        Ok(())
    }

    /// Ends a step or substep that has advanced the state and clamped it if necessary. [`Batch::each`] calls this
    /// function automatically.
    ///
    /// # Errors
    /// [`StepError::Refused`] when the system does not accept the state, which is then that of the end of the step.
    pub fn end_step(&mut self, state: &mut State, stepped: Stepped) -> Result<(), StepError> {
        if self.end_part(state, stepped)? {
            self.diverged = worst_beyond(&state.u, self.divergence_limit);
            self.sample(state);
        }
        Ok(())
    }

    /// Ends a step or substep of a machine that stores u and v in its own format and knows that no displacement is
    /// beyond
    /// [`Batch::divergence_limit`]. The state must hold the values that [`Batch::watched`] names, and all of u and v
    /// only if [`Batch::looks_at_steps`].
    ///
    /// # Errors
    /// The errors of [`Batch::end_step`].
    pub fn end_step_within_limit(
        &mut self,
        state: &mut State,
        stepped: Stepped,
    ) -> Result<(), StepError> {
        if self.end_part(state, stepped)? {
            self.sample(state);
        }
        Ok(())
    }

    /// Ends a substep, on the clock and for the system; returns true if it ends a step.
    fn end_part(&mut self, state: &mut State, stepped: Stepped) -> Result<bool, StepError> {
        state.end_step(self.dt, stepped.velocity, stepped.acceleration);
        state.damped = stepped.damped;
        state.loads = self.loads;
        let accepted = self.system.accept(state, self.inputs, self.dt);
        accepted.map_err(|source| StepError::Refused {
            t: state.t(),
            source,
        })?;
        self.step_work.add_part(stepped.work);
        self.parts_taken += 1;
        if self.parts_taken < self.parts {
            return Ok(false);
        }
        self.parts_taken = 0;
        self.taken += 1;
        self.work += std::mem::take(&mut self.step_work);
        Ok(true)
    }

    fn sample(&mut self, state: &State) {
        if let Some(watch) = &mut self.watch
            && self.diverged.is_none()
        {
            watch.sample(state);
        }
    }

    /// True if the system reads the state after every step or substep.
    #[must_use]
    pub fn looks_at_steps(&self) -> bool {
        self.system.looks_at_steps()
    }

    /// The degrees of freedom whose displacements are sampled after every step.
    #[must_use]
    pub fn watched(&self) -> &[u32] {
        self.watch.as_ref().map_or(&[], |watch| watch.dofs())
    }

    /// Displacement (m) beyond which the batch ends.
    #[must_use]
    pub fn divergence_limit(&self) -> f64 {
        self.divergence_limit
    }

    /// Substeps that are left.
    #[must_use]
    pub fn parts_left(&self) -> usize {
        (self.steps - self.taken) * self.parts as usize - self.parts_taken as usize
    }

    /// Runs `body` on at most the next `parts` substeps, rounded down to whole steps.
    pub fn at_most<R>(&mut self, parts: usize, body: impl FnOnce(&mut Self) -> R) -> R {
        let steps = self.steps;
        self.steps = steps.min(self.taken + parts / self.parts as usize);
        let result = body(self);
        self.steps = steps;
        result
    }

    /// Runs `body` on steps that are each divided into `parts` equal substeps.
    pub fn in_parts<R>(&mut self, parts: u32, body: impl FnOnce(&mut Self) -> R) -> R {
        let whole = (self.dt, self.parts, self.pause);
        self.dt /= f64::from(parts);
        self.parts = self.parts.saturating_mul(parts);
        self.parts_taken = self.parts_taken.saturating_mul(parts);
        self.pause = self.pause.saturating_mul(parts);
        let result = body(self);
        (self.dt, self.parts, self.pause) = whole;
        self.parts_taken /= parts;
        result
    }

    /// Runs `body` on the next step or substep only, divided into `parts` equal substeps; the step after it may have
    /// another number. The step is a trial until [`Batch::keep_trial`] or [`Batch::discard_trial`] is called: its work
    /// counts, but it does not count as taken and is not sampled.
    pub fn try_in_parts<R>(&mut self, parts: u32, body: impl FnOnce(&mut Self) -> R) -> R {
        let whole = (
            self.dt,
            self.steps,
            self.taken,
            self.parts,
            self.parts_taken,
        );
        let watch = self.watch.take();
        self.dt /= f64::from(parts);
        (self.steps, self.taken, self.parts, self.parts_taken) = (1, 0, parts, 0);
        let result = body(self);
        (
            self.dt,
            self.steps,
            self.taken,
            self.parts,
            self.parts_taken,
        ) = whole;
        self.watch = watch;
        result
    }

    /// Runs `body` on at most the next `parts` substeps of the step under way.
    pub fn next_parts<R>(&mut self, parts: u32, body: impl FnOnce(&mut Self) -> R) -> R {
        let pause = self.parts_taken.saturating_add(parts);
        // The end of a step is none.
        self.pause = if pause < self.parts { pause } else { u32::MAX };
        let result = body(self);
        self.pause = u32::MAX;
        result
    }

    /// Takes the step of a trial, which ended in this state.
    pub fn keep_trial(&mut self, state: &State) {
        self.parts_taken += 1;
        if self.parts_taken == self.parts {
            self.parts_taken = 0;
            self.taken += 1;
            self.sample(state);
        }
    }

    /// Discards a trial except the count of its work; the same step is then taken again.
    pub fn discard_trial(&mut self) {
        self.diverged = None;
        self.work += StepReport {
            saturated: 0,
            retaken: 1,
            ..std::mem::take(&mut self.step_work)
        };
    }

    /// Runs `body` on steps that are each clamped, and returns the guard afterwards.
    pub fn guarded<R>(
        &mut self,
        guarding: Guarding,
        body: impl FnOnce(&mut Self) -> R,
    ) -> (Guarding, R) {
        let before = self.guarding.replace(guarding);
        let result = body(self);
        let guarding = std::mem::replace(&mut self.guarding, before);
        (guarding.unwrap_or_default(), result)
    }
}

/// The degree of freedom farthest beyond `limit` (m); NaN is the farthest.
#[must_use]
pub fn worst_beyond(u: &[f64], limit: f64) -> Option<usize> {
    // Without a branch, in integers as wide as the values, so that several are compared at a time: this is done after
    // each step.
    let largest_finite = limit.min(f64::MAX);
    let fine = |all, value: &f64| all & u64::from(value.abs() <= largest_finite);
    if u.iter().fold(1, fine) == 1 {
        return None;
    }
    let distance = |value: f64| {
        if value.is_nan() {
            f64::INFINITY
        } else {
            value.abs()
        }
    };
    (0..u.len()).max_by(|&i, &j| distance(u[i]).total_cmp(&distance(u[j])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_degree_of_freedom_is_named() {
        assert_eq!(worst_beyond(&[1.0, -2.0], 3.0), None);
        assert_eq!(worst_beyond(&[1.0, -5.0, 4.0], 3.0), Some(1));
        assert_eq!(worst_beyond(&[1.0, 7.0, f64::NAN], 3.0), Some(2));
        assert_eq!(worst_beyond(&[f64::INFINITY], f64::INFINITY), Some(0));
    }
}
