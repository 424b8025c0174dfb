//! The frame that all methods have in common.

use std::sync::Arc;

use sinew_cnn::{Machine, Program};
use sinew_core::spectrum::Spectrum;
use sinew_core::{
    Batch, CostClock, Fact, Guarding, Integrator, LoadOverStep, Prepared, Properties, SetupError,
    StableStep, State, StepError, StepReport, System, VelocityTime,
};

use sinew_machines::{Chosen, Kind, PrecisionName, Settings};

use crate::contact::METHODS_WITH_CONTACT;
use crate::numerical_dissipation::NumericalDissipation;
use crate::rounding::f32_rounding;
use crate::scheme::{Scheme, StepByHand, Steps};
use crate::stepper::Stepper;

/// A method as an integrator: checks, set-up once per system and step, the machine that runs its
/// program.
pub struct Frame<M: Scheme> {
    scheme: M,
    machine: Settings,
    prepared: Prepared,
    ready: Ready<M::ByHand>,
    /// Error (relative) of rounding that is to be expected, in single precision.
    rounding: Option<f64>,
}

enum Ready<S> {
    Not,
    Program(Box<Loaded>),
    ByHand(Box<S>),
}

/// A program and the machine that runs it.
struct Loaded {
    program: Arc<Program>,
    machine: Chosen,
    /// Limits of the guarded program that the machine runs, with its step (s).
    guarded_by: Option<(Arc<[f64]>, f64)>,
}

impl<M: Scheme> Frame<M> {
    /// An integrator that uses this method.
    #[must_use]
    pub fn new(scheme: M) -> Self {
        Self {
            scheme,
            machine: Settings::default(),
            prepared: Prepared::default(),
            ready: Ready::Not,
            rounding: None,
        }
    }

    /// Runs its programs on a machine with these settings.
    #[must_use]
    pub fn on(self, machine: Settings) -> Self {
        Self { machine, ..self }
    }

    /// The method.
    #[must_use]
    pub fn scheme(&self) -> &M {
        &self.scheme
    }

    /// The method's steps, if set-up produced steps that are no program.
    #[must_use]
    pub fn by_hand(&self) -> Option<&M::ByHand> {
        match &self.ready {
            Ready::ByHand(steps) => Some(steps),
            Ready::Not | Ready::Program(_) => None,
        }
    }
}

impl<M: Scheme> Stepper for Frame<M> {
    fn program(&self) -> Option<Program> {
        match &self.ready {
            Ready::Program(loaded) => Some(Program::clone(&loaded.program)),
            Ready::Not | Ready::ByHand(_) => None,
        }
    }

    fn numerical_dissipation(&self) -> Option<NumericalDissipation> {
        self.scheme.numerical_dissipation()
    }

    fn stable_step_of(&self, spectrum: &Spectrum) -> StableStep {
        self.scheme.stable_step_of(spectrum)
    }

    fn computed_by(&self) -> Vec<String> {
        let Ready::Program(loaded) = &self.ready else {
            return Vec::new();
        };
        let kernels = format!("computed by {}", loaded.machine.in_words());
        let rounding = self.rounding.map(|rounding| {
            format!(
                "f32 rounds: expect displacements to be off by about {rounding:.1e} of their size after some periods, \
                 more in time, and without bound where the body has no support"
            )
        });
        std::iter::once(kernels).chain(rounding).collect()
    }

    fn without_program(&self) -> &'static str {
        match &self.ready {
            Ready::ByHand(steps) => steps.without_program(),
            Ready::Not | Ready::Program(_) => "it is not set up",
        }
    }
}

impl<M: Scheme> Integrator for Frame<M> {
    fn id(&self) -> &'static str {
        M::ID
    }

    fn properties(&self) -> Properties {
        self.scheme.properties()
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        if self.scheme.refuses_contact() && system.needs_contact() {
            return Err(Self::no_contact());
        }
        let work = self.set_up(system, dt)?;
        self.check_contact(system)?;
        Ok(work)
    }

    fn stable_step_about(
        &self,
        system: &dyn System,
        state: Option<&State>,
    ) -> Result<StableStep, SetupError> {
        self.check_needs(system)?;
        self.scheme.stable_step(system, state)
    }

    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
        self.check_contact(batch.system())?;
        let needed = self.scheme.properties().changing_loads.needed();
        let Some(refused) = first_refused(needed, batch, state) else {
            return self.ready.run(batch, state);
        };
        let before = ((refused - state.t()) / batch.dt() + 1e-9).floor();
        batch.at_most(before.max(0.0) as usize, |batch| {
            self.ready.run(batch, state)
        })?;
        if !batch.goes_on() {
            return Ok(());
        }
        Err(StepError::Inaccurate {
            integrator: M::ID,
            t: state.t(),
            reason: format!(
                "a load changes at t = {refused} s, and is not {} of {} s; {}",
                needed.describe(),
                batch.dt(),
                self.scheme.load_remedy()
            ),
        })
    }

    fn facts(&self) -> Vec<Fact> {
        let mut facts = self.scheme.facts();
        if let Ready::ByHand(steps) = &self.ready {
            facts.extend(steps.facts());
        }
        facts
    }

    fn remarks(&self) -> Vec<String> {
        let mut remarks = self.scheme.remarks();
        if let Ready::ByHand(steps) = &self.ready {
            remarks.extend(steps.remarks());
        }
        remarks
    }

    fn kernel(&self) -> Option<String> {
        match &self.ready {
            Ready::Program(loaded) => Some(loaded.machine.kernel()),
            Ready::Not | Ready::ByHand(_) => None,
        }
    }

    fn cost_clock(&self) -> CostClock {
        match &self.ready {
            Ready::Program(loaded) => loaded.machine.cost_clock(),
            Ready::Not | Ready::ByHand(_) => CostClock::default(),
        }
    }
}

impl<M: Scheme> Frame<M> {
    /// Sets up for a system and a step; results for the same ones are reused.
    fn set_up(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        let same = if self.scheme.depends_on_loads() {
            self.prepared.is_for_loads(system, dt)
        } else {
            self.prepared.is_for(system, dt)
        };
        if same {
            return Ok(StepReport::default());
        }
        self.prepared.forget();
        let (before, machine) = match std::mem::replace(&mut self.ready, Ready::Not) {
            Ready::ByHand(steps) => (Some(*steps), None),
            Ready::Program(loaded) => (None, Some(loaded.machine)),
            Ready::Not => (None, None),
        };
        self.check_needs(system)?;
        Prepared::check(M::ID, system, dt)?;
        self.rounding = match self.machine.precision {
            PrecisionName::F64 => None,
            PrecisionName::F32 => Some(f32_rounding(system)),
        };
        let made = self.scheme.set_up(system, dt, before)?;
        self.ready = match made.steps {
            Steps::ByHand(steps) => {
                self.check_steps_by_hand(&*steps)?;
                Ready::ByHand(steps)
            }
            Steps::Program(program) => {
                self.check_machine(system)?;
                self.check_rounding()?;
                let program = Arc::new(program.complete());
                let mut machine = machine.unwrap_or_else(|| Chosen::new(self.machine));
                machine.load(Arc::clone(&program), system);
                Ready::Program(Box::new(Loaded {
                    program,
                    machine,
                    guarded_by: None,
                }))
            }
        };
        self.prepared.done(system, dt);
        let cells = system.dofs() / system.layers().count();
        Ok(StepReport {
            cells_set_up: cells as u64,
            ..made.work
        })
    }

    fn check_needs(&self, system: &dyn System) -> Result<(), SetupError> {
        let needs = self.scheme.properties().needs;
        needs
            .check(M::ID, system)
            .map_err(|_| self.scheme.lacking())
    }

    /// Refuses settings of machines for steps that no machine runs.
    fn check_steps_by_hand(&self, steps: &M::ByHand) -> Result<(), SetupError> {
        let reason = steps.without_program();
        if self.machine.precision != PrecisionName::F64 {
            return Err(SetupError::SinglePrecision {
                integrator: M::ID,
                reason,
            });
        }
        match self.machine.kind {
            Kind::AUTO | Kind::REFERENCE => Ok(()),
            _ => Err(SetupError::Machine {
                integrator: M::ID,
                reason: format!("no machine runs these steps: {reason}; leave `machine` out"),
            }),
        }
    }

    /// Refuses contact for steps that do not support it.
    fn check_contact(&self, system: &dyn System) -> Result<(), SetupError> {
        let can_be_pushed = match &self.ready {
            Ready::Program(loaded) => loaded.program.inertia().is_some(),
            Ready::ByHand(steps) => steps.meets_contact(),
            Ready::Not => false,
        };
        if can_be_pushed || !system.needs_contact() {
            return Ok(());
        }
        Err(Self::no_contact())
    }

    fn no_contact() -> SetupError {
        SetupError::Contact {
            integrator: M::ID,
            reason: "this method does not support tools: contact needs one mass block for each node and a position update with the new velocity",
            methods: METHODS_WITH_CONTACT,
        }
    }

    /// Refuses an error that rounding exceeds, and rounding errors as large as the motion itself.
    fn check_rounding(&self) -> Result<(), SetupError> {
        if let Some(expected) = self.rounding.filter(|expected| *expected >= 1.0) {
            return Err(SetupError::Machine {
                integrator: M::ID,
                reason: format!(
                    "stiffnesses differ too much for f32, which may be off by {:.0} % here; take precision = \"f64\"",
                    100.0 * expected
                ),
            });
        }
        match (self.scheme.asked_error(), self.rounding) {
            (Some(asked), Some(expected)) if asked < expected => Err(SetupError::Rounding {
                integrator: M::ID,
                asked,
                expected,
            }),
            _ => Ok(()),
        }
    }

    /// Refuses a system that does not fit the machine's options.
    fn check_machine(&self, system: &dyn System) -> Result<(), SetupError> {
        self.machine
            .check(system)
            .map_err(|unfit| SetupError::Machine {
                integrator: M::ID,
                reason: unfit.to_string(),
            })
    }
}

/// The first instant (s) at which a load violates a method's condition over a step of the batch.
fn first_refused(needed: LoadOverStep, batch: &Batch<'_>, state: &State) -> Option<f64> {
    if needed == LoadOverStep::Any {
        return None;
    }
    let linear = batch.system().as_linear()?;
    let dt = batch.dt();
    // A staggered method reads loads a step back too.
    let back = if state.is_staggered_by(dt) { dt } else { 0.0 };
    let t = state.t() - back;
    let end = t + back + batch.parts_left() as f64 * dt;
    let inputs = batch.inputs();
    // A pulse that ends where the first step begins may miss it by rounding.
    let loads = linear.operators().loads_between(inputs, t - dt, end);
    let broken = loads.filter_map(|load| {
        let ramp = load.ramp.known(inputs);
        needed.first_broken(ramp, t, dt, end)
    });
    broken.reduce(f64::min)
}

impl<S: StepByHand> Ready<S> {
    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
        let staggered = match self {
            Self::Not => false,
            Self::Program(loaded) => loaded.program.velocity != VelocityTime::Same,
            Self::ByHand(steps) => steps.is_staggered(),
        };
        if batch.goes_on() && !(staggered && state.is_staggered_by(batch.dt())) {
            batch.synchronise(state)?;
        }
        match self {
            Self::Not => Err(StepError::NotPrepared),
            Self::ByHand(steps) => batch.each(state, |step, state| steps.step(&step, state)),
            Self::Program(loaded) => {
                loaded.guard(batch);
                loaded.machine.run(batch, state)?;
                batch.ended(loaded.machine.name(), state)
            }
        }
    }
}

impl Loaded {
    /// Gives the machine the guarded program if the batch is guarded, and the plain one otherwise.
    fn guard(&mut self, batch: &Batch<'_>) {
        let dt = batch.dt();
        let wanted = batch.guarding().map(Guarding::limits);
        let same = match (&self.guarded_by, wanted) {
            (None, None) => true,
            (Some((limits, step)), Some(wanted)) => Arc::ptr_eq(limits, wanted) && *step == dt,
            _ => false,
        };
        if same {
            return;
        }
        let program = match wanted {
            Some(limits) => Arc::new(self.program.guarded(Arc::clone(limits), dt)),
            None => Arc::clone(&self.program),
        };
        self.guarded_by = wanted.map(|limits| (Arc::clone(limits), dt));
        self.machine.load(program, batch.system());
    }
}
