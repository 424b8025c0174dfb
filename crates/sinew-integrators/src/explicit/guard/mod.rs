//! `saturation`: a guard that bounds velocities at any step.

mod bound;
mod limits;
mod load_work;

use sinew_cnn::Program;
use sinew_core::spectrum::Spectrum;
use sinew_core::{
    Batch, CostClock, Fact, Guarding, Integrator, Prepared, Properties, Revision, SetupError,
    StableStep, Start, State, StepError, StepReport, System,
};

use crate::Stepper;

use super::substeps::{Substeps, whole};
pub use crate::guard_option::{Guard, GuardOption};
use bound::{LEAST_ROOM, room};
use limits::Limits;

/// Largest number of substeps of a step if none is stable: the limit of a light cell would need millions.
const MOST_PARTS_BY_SIZE: u32 = 1000;

/// An integrator whose velocities and displacements are clamped after each step: `|v_i| <= Q_i` and
/// `|u_i(t + dt) - u_i(t)| <= Q_i dt` for the vectors of each cell i, so that the result does not depend on the axes'
/// directions. While nothing saturates, the result is identical to the last bit.
///
/// With [`Guard::Auto`] a step longer than the method's stable one is divided into the fewest equal substeps of at most
/// nine tenths of the stable step. The limits Q_i follow from the energy of the loads and of the start of the motion,
/// with a factor for the larger velocities of a stable method, so that a stable step or substep is never clamped. If a
/// method has no stable step, as forward Euler without damping, substeps are so short that no cell moves by more than a
/// fifth of its size in one, but not shorter than a thousandth of the step, and the limits bound the motion.
///
/// [`Guard::At`] clamps and does nothing else.
///
/// If a method moves displacements with its new velocity, both clamps are the same; if it uses the old velocity, that
/// velocity was clamped a step before. Staggered velocities stay staggered, and an acceleration that a method keeps is
/// that of the clamped motion.
pub struct Guarded {
    inner: Box<dyn Stepper>,
    guard: Guard,
    prepared: Prepared,
    limits: Limits,
    guarding: Guarding,
    /// The method's stable step on the current system.
    stable: Option<(Revision, StableStep)>,
    parts: u32,
    /// Number of equal substeps into which each of them is divided further.
    finer: u32,
}

impl Guarded {
    /// Name of the fact for the number of substeps of a step.
    pub const SUBSTEPS: &'static str = "guard_substeps";
    /// Name of the fact for the largest of all limits (m/s), which tends to infinity as a step approaches the method's
    /// stable step.
    pub const LARGEST_LIMIT: &'static str = "guard_q_max";

    /// Guards `inner`.
    #[must_use]
    pub fn new(inner: Box<dyn Stepper>, guard: Guard) -> Self {
        Self {
            inner,
            guard,
            prepared: Prepared::default(),
            limits: Limits::default(),
            guarding: Guarding::default(),
            stable: None,
            parts: 1,
            finer: 1,
        }
    }

    /// Start of the motion, kept in the state so that a run continued by a fresh integrator has the same
    /// limits.
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

    /// The method's stable step, computed once for each system.
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

    /// Chooses the substeps of a step, and limits with a factor for the method's velocities at that length.
    fn cut(&mut self, system: &dyn System, dt: f64) -> Result<(), SetupError> {
        if let Guard::At(_) = self.guard {
            return Ok(());
        }
        let (parts, limit) = match self.stable(system)? {
            StableStep::Any => (1, f64::INFINITY),
            StableStep::UpTo(limit) if dt <= limit => (1, limit),
            StableStep::UpTo(limit) if limit > 0.0 => {
                let id = self.inner.id();
                let parts = Substeps::stable_parts_of(id, dt, limit, GuardOption::KEY)?;
                (parts, limit)
            }
            StableStep::UpTo(_) | StableStep::Unknown => {
                self.limits.set_step(dt, LEAST_ROOM);
                let passed = dt * self.limits.largest_rate();
                let parts = whole(passed / Limits::SHARE_OF_SIZE).min(MOST_PARTS_BY_SIZE);
                self.parts = self.finer * parts;
                return Ok(());
            }
        };
        self.parts = self.finer * parts;
        let part = dt / f64::from(self.parts);
        let room = room(part / limit, part * system.mass_damping());
        self.limits.set_step(part, room);
        Ok(())
    }
}

impl Stepper for Guarded {
    fn program(&self) -> Option<Program> {
        let (parts, limits) = (self.parts, self.limits.of_cells());
        let part = self.prepared.step()? / f64::from(parts);
        let guarded = self.inner.program()?.guarded(limits, part);
        Some(guarded.repeated(parts))
    }

    fn stable_step_of(&self, spectrum: &Spectrum) -> StableStep {
        self.inner.stable_step_of(spectrum)
    }

    fn refine(&mut self, times: u32) -> bool {
        if self.guard != Guard::Auto {
            return self.inner.refine(times);
        }
        self.prepared.forget();
        self.finer = times;
        true
    }

    fn computed_by(&self) -> Vec<String> {
        self.inner.computed_by()
    }

    fn without_program(&self) -> &'static str {
        self.inner.without_program()
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
        if self.prepared.is_for_loads(system, dt) {
            return Ok(StepReport::default());
        }
        self.prepared.forget();
        if system.needs_contact() {
            return Err(SetupError::Contact {
                integrator: self.inner.id(),
                reason: "tools do work that the limits of a guard do not know",
                methods: "saturation = \"off\", or leave it out",
            });
        }
        Prepared::check(self.inner.id(), system, dt)?;
        self.limits.prepare(self.inner.id(), system, self.guard)?;
        self.cut(system, dt)?;
        let work = self.inner.prepare(system, dt / f64::from(self.parts))?;
        self.prepared.done(system, dt);
        Ok(work)
    }

    /// The method's stable step: the guard bounds the motion beyond it without making it accurate.
    fn stable_step_about(
        &self,
        system: &dyn System,
        state: Option<&State>,
    ) -> Result<StableStep, SetupError> {
        self.inner.stable_step_about(system, state)
    }

    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
        let (system, dt) = (batch.system(), batch.dt());
        if self.guard == Guard::Auto && batch.inputs().forces().next().is_some() {
            return Err(StepError::Setup(SetupError::Lacks {
                integrator: self.inner.id(),
                needs: "forces that are known before the run for saturation = \"auto\" (give a number instead)",
            }));
        }
        let start = self.start(system, state);
        if self.limits.set_start(start) {
            self.cut(system, dt)?;
            let work = self.inner.prepare(system, dt / f64::from(self.parts))?;
            batch.count(work);
        }
        let mut guarding = std::mem::take(&mut self.guarding);
        guarding.set(self.limits.of_cells(), system.layers().count());
        let (guarding, result) = batch.in_parts(self.parts, |batch| {
            batch.guarded(guarding, |batch| self.inner.run(batch, state))
        });
        self.guarding = guarding;
        result
    }

    fn kernel(&self) -> Option<String> {
        self.inner.kernel()
    }

    fn cost_clock(&self) -> CostClock {
        self.inner.cost_clock()
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
