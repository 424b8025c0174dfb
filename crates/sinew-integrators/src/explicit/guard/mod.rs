//! `saturation`: a guard that bounds velocities whatever the step.

mod bound;
mod clamp;
mod limits;
mod load_work;
mod option;
mod unaccepted;

use sinew_core::{
    Fact, Integrator, Prepared, Properties, Revision, SetupError, StableStep, Start, State,
    StepError, StepReport, System,
};

use super::substeps::{Substeps, whole};
use bound::{LEAST_ROOM, room};
use clamp::Clamp;
use limits::Limits;
pub use option::{Guard, GuardOption};
use unaccepted::Unaccepted;

/// Most parts of a step where none is stable: a light cell's limit would ask for millions.
const MOST_PARTS_BY_SIZE: u32 = 1000;

/// An integrator whose velocities and displacements are clamped after each step: `|v_i| <= Q_i`
/// and `|u_i(t + dt) - u_i(t)| <= Q_i dt` for the vectors of each cell i, so that the result does not
/// depend on the axes' directions. Not a bit changes while nothing saturates.
///
/// With [`Guard::Auto`] a step longer than the method's stable one is cut into the fewest equal parts that are
/// at most nine tenths of it. The limits Q_i are those of the energy that the loads and the start of the motion
/// bring, with room for what a stable method makes of it, so that a stable step, or part of one, is never
/// clamped. Where a method knows no stable step, as forward Euler without damping, parts are so short that no
/// cell passes a fifth of its size in one, or a thousandth of the step, and the limits are what bounds the motion.
///
/// [`Guard::At`] clamps and does nothing else.
///
/// Where a method moves displacements with its new velocity, both clamps are the same; where with
/// the old one, that was clamped a step before. Staggered velocities stay where the method has
/// them, and an acceleration that a method keeps beside them is that of the clamped motion.
pub struct Guarded {
    inner: Box<dyn Integrator>,
    guard: Guard,
    prepared: Prepared,
    limits: Limits,
    clamp: Clamp,
    /// The method's stable step on the system at hand.
    stable: Option<(Revision, StableStep)>,
    parts: u32,
}

impl Guarded {
    /// Name of the fact that tells into how many parts a step is cut.
    pub const SUBSTEPS: &'static str = "guard_substeps";
    /// Name of the fact that tells the largest of all limits (m/s), which rises without end where a step nears the
    /// method's stable one.
    pub const LARGEST_LIMIT: &'static str = "guard_q_max";

    /// Guards `inner`.
    #[must_use]
    pub fn new(inner: Box<dyn Integrator>, guard: Guard) -> Self {
        Self {
            inner,
            guard,
            prepared: Prepared::default(),
            limits: Limits::default(),
            clamp: Clamp::default(),
            stable: None,
            parts: 1,
        }
    }

    /// What the motion began with. Kept in the state, for a run that is continued by a fresh
    /// integrator to have the same limits.
    fn start(&mut self, system: &dyn System, state: &mut State) -> Option<Start> {
        if let Guard::At(_) = self.guard {
            return None;
        }
        let known = state
            .start
            .filter(|start| start.system == system.revision());
        state.start = known.or_else(|| bound::start(system, state));
        state.start
    }

    /// The method's stable step, found once for each system.
    fn stable(&mut self, system: &dyn System) -> Result<StableStep, SetupError> {
        if let Some((revision, stable)) = self.stable
            && revision == system.revision()
        {
            return Ok(stable);
        }
        let stable = self.inner.stable_step(system)?;
        self.stable = Some((system.revision(), stable));
        Ok(stable)
    }

    /// Chooses the parts of a step, and limits that leave room for what the method makes of them.
    fn cut(&mut self, system: &dyn System, dt: f64) -> Result<(), SetupError> {
        if let Guard::At(_) = self.guard {
            return Ok(());
        }
        let (parts, limit) = match self.stable(system)? {
            StableStep::Any => (1, f64::INFINITY),
            StableStep::UpTo(limit) if dt <= limit => (1, limit),
            StableStep::UpTo(limit) if limit > 0.0 => (Substeps::parts_of(dt, limit), limit),
            StableStep::UpTo(_) | StableStep::Unknown => {
                self.limits.set_step(dt, LEAST_ROOM);
                let passed = dt * self.limits.largest_rate();
                self.parts = whole(passed / Limits::SHARE_OF_SIZE).min(MOST_PARTS_BY_SIZE);
                return Ok(());
            }
        };
        let part = dt / f64::from(parts);
        self.parts = parts;
        let room = room(part / limit, part * system.mass_damping());
        self.limits.set_step(part, room);
        Ok(())
    }
}

impl Integrator for Guarded {
    fn id(&self) -> &'static str {
        self.inner.id()
    }

    fn properties(&self) -> Properties {
        self.inner.properties()
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        if self.prepared.is_for(system, dt) {
            return Ok(StepReport::default());
        }
        let mut checked = Prepared::default();
        checked.check(self.inner.id(), system, dt)?;
        self.prepared = Prepared::default();
        self.limits.prepare(self.inner.id(), system, self.guard)?;
        self.clamp.prepare(system);
        self.cut(system, dt)?;
        let work = self.inner.prepare(system, dt / f64::from(self.parts))?;
        self.prepared = checked;
        Ok(work)
    }

    /// That of the method: the guard bounds the motion beyond it without making it right.
    fn stable_step(&self, system: &dyn System) -> Result<StableStep, SetupError> {
        self.inner.stable_step(system)
    }

    fn step(
        &mut self,
        system: &dyn System,
        state: &mut State,
        dt: f64,
    ) -> Result<StepReport, StepError> {
        let mut work = self.prepare(system, dt)?;
        Prepared::check_state(self.inner.id(), system, state)?;
        let start = self.start(system, state);
        if self.limits.set_start(start) {
            self.cut(system, dt)?;
        }
        let part = dt / f64::from(self.parts);
        let waiting = Unaccepted(system);
        for _ in 0..self.parts {
            self.clamp.remember(state, part);
            let done = self.inner.step(&waiting, state, part)?;
            let clamped = self.clamp.apply(self.limits.of_cells(), state, part);
            system.accept(state);
            work.add_part(StepReport {
                saturated: done.saturated.max(clamped),
                ..done
            });
        }
        Ok(work)
    }

    fn facts(&self) -> Vec<Fact> {
        let mut facts = self.inner.facts();
        if let Guard::Auto = self.guard {
            facts.extend([
                Fact {
                    name: Self::LARGEST_LIMIT,
                    value: self.limits.largest(),
                },
                Fact {
                    name: Self::SUBSTEPS,
                    value: f64::from(self.parts),
                },
            ]);
        }
        facts
    }

    fn remarks(&self) -> Vec<String> {
        let mut remarks = self.inner.remarks();
        if self.parts > 1 {
            let (parts, id) = (self.parts, self.inner.id());
            remarks.push(match self.stable {
                Some((_, StableStep::UpTo(limit))) if limit > 0.0 => format!(
                    "the guard took each step in {parts} parts: whole, it is longer than the stable step of `{id}`"
                ),
                _ => format!(
                    "the guard took each step in {parts} parts, so that cells pass little of their size in one: \
                     `{id}` knows no stable step here, and the motion is bounded, not accurate"
                ),
            });
        }
        remarks
    }
}
