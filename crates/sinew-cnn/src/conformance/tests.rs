//! The suite for machines: as a machine's own tests use it, and with broken machines, each of which it has to detect.

use std::hint::black_box;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, LazyLock};

use crate::conformance::{self, Make, Method};
use crate::{LoadAt, Machine, Physics, Program, ReferenceMachine, Register, Sweep};
use sinew_core::{
    Batch, EnergyBehaviour, Needs, OtherDamping, Properties, State, StepError, StepReport, System,
    VelocityTime,
};

/// Symplectic Euler, and the leapfrog whose damping lags by half a step.
fn methods() -> Vec<Method> {
    let of_order = |order| Properties::of_order(order, Needs::Forces, EnergyBehaviour::Bounded);
    let leapfrog = Properties {
        accuracy: sinew_core::Accuracy::OrderByDamping {
            undamped: 2,
            damped: 1,
        },
        other_damping: OtherDamping::order(1),
        ..of_order(2)
    };
    vec![
        Method::new("symplectic Euler", of_order(1), |system, dt| {
            let (u, v) = (Register::U, Register::V);
            let mut program = Program::new(VelocityTime::Same);
            let force = program.net_force(&Physics::of(system), u, v, LoadAt::StartOf);
            program.step = vec![force.then(v.plus_q(dt)).then(u.plus(dt, v))];
            Some(program.complete())
        }),
        Method::new("leapfrog", leapfrog, |system, dt| {
            let (u, v) = (Register::U, Register::V);
            let physics = Physics::of(system);
            let mut program = Program::new(VelocityTime::MiddleOfStep);
            let start = program.net_force(&physics, u, v, LoadAt::From);
            let force = program.net_force(&physics, u, v, LoadAt::Around);
            program.start = vec![start.then(v.plus_q(dt / 2.0)).then(u.plus(dt, v))];
            program.step = vec![force.then(v.plus_q(dt)).then(u.plus(dt, v))];
            Some(program.complete())
        }),
    ]
}

static METHODS: LazyLock<Vec<Method>> = LazyLock::new(methods);

crate::machine_conformance!(reference, METHODS, || Box::new(ReferenceMachine::default()));

/// The reference machine with one fault.
#[derive(Debug)]
struct Broken {
    inner: ReferenceMachine,
    mistake: Mistake,
    refused: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Mistake {
    /// No fault: the laws hold for the wrapper itself.
    None,
    /// Executes the updates of a sweep in the wrong order.
    UpdatesBackwards,
    /// Exchanges the weights of an update's terms.
    WeightsExchanged,
    /// Registers that follow from the state are not recomputed when a batch begins.
    EntryForgotten,
    /// Treats the first step like any other.
    StartForgotten,
    /// Applies no clamps.
    ClampsForgotten,
    /// Omits the updates for the last step of a batch.
    LastStepForgotten,
    /// Executes sweeps even if a step does not need them.
    ConditionsForgotten,
    /// Takes a step as a whole that should be taken in substeps.
    RepeatsForgotten,
    /// A coefficient is off by 1e-10 relative.
    CoefficientOff,
    /// Each batch allocates.
    Allocates,
    /// Counts one sweep too many in each batch.
    CountsTooMuch,
    /// The velocity loses its last bit when a batch begins.
    RoundsWhenABatchBegins,
    /// Does not continue after a refused step.
    StopsAfterARefusal,
    /// Ignores a refused step without an error.
    HidesARefusal,
    /// Every step fails.
    FailsEveryStep,
    /// Takes no step, without an error.
    TakesNoStep,
}

impl Mistake {
    fn in_program(self, program: &Program) -> Program {
        let mut program = program.clone();
        let mut sweeps = |change: &dyn Fn(&mut Sweep)| {
            let all = program.start.iter_mut().chain(&mut program.step);
            all.for_each(change);
        };
        match self {
            Self::UpdatesBackwards => sweeps(&|sweep| sweep.updates.reverse()),
            Self::WeightsExchanged => sweeps(&|sweep| {
                for update in &mut sweep.updates {
                    let weights: Vec<_> =
                        update.terms.iter().rev().map(|term| term.weight).collect();
                    for (term, weight) in update.terms.iter_mut().zip(weights) {
                        term.weight = weight;
                    }
                }
            }),
            Self::ClampsForgotten => sweeps(&|sweep| {
                for update in &mut sweep.updates {
                    update.clamp = None;
                }
            }),
            Self::LastStepForgotten => {
                sweeps(&|sweep| sweep.updates.retain(|update| !update.last_only));
            }
            Self::ConditionsForgotten => sweeps(&|sweep| sweep.when = crate::When::Always),
            Self::CoefficientOff => sweeps(&|sweep| {
                for update in &mut sweep.updates {
                    update.of_q *= 1.0 + 1e-10;
                }
            }),
            Self::EntryForgotten => program.entry.clear(),
            Self::StartForgotten => program.start.clear(),
            Self::RepeatsForgotten => program.repeats = 1,
            _ => {}
        }
        program
    }
}

impl Machine for Broken {
    fn name(&self) -> &'static str {
        "broken"
    }

    fn load(&mut self, program: Arc<Program>, system: &dyn System) {
        let program = Arc::new(self.mistake.in_program(&program));
        self.inner.load(program, system);
    }

    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
        if self.refused && self.mistake == Mistake::StopsAfterARefusal {
            return Ok(());
        }
        match self.mistake {
            Mistake::FailsEveryStep => {
                return Err(StepError::Inaccurate {
                    integrator: "broken",
                    t: state.t(),
                    reason: "it always does".to_owned(),
                });
            }
            Mistake::TakesNoStep => return Ok(()),
            Mistake::Allocates => drop(black_box(vec![0.0; 3])),
            Mistake::CountsTooMuch => batch.count(StepReport {
                sweeps: 1,
                ..StepReport::default()
            }),
            Mistake::RoundsWhenABatchBegins => {
                for v in &mut state.v {
                    *v = f64::from_bits(v.to_bits() & !1);
                }
            }
            _ => {}
        }
        let done = self.inner.run(batch, state);
        self.refused |= done.is_err();
        match self.mistake {
            Mistake::HidesARefusal => Ok(()),
            _ => done,
        }
    }
}

type Law = fn(&[Method], &Make);

/// True if a law detects a mistake.
fn notices(law: Law, mistake: Mistake) -> bool {
    let make = move || -> Box<dyn Machine> {
        Box::new(Broken {
            inner: ReferenceMachine::default(),
            mistake,
            refused: false,
        })
    };
    catch_unwind(AssertUnwindSafe(|| law(&METHODS, &make))).is_err()
}

fn work_is_counted(_: &[Method], make: &Make) {
    conformance::work_is_counted(make);
}

fn a_machine_without_a_program_refuses(_: &[Method], make: &Make) {
    conformance::a_machine_without_a_program_refuses(make);
}

const LAWS: [Law; 8] = [
    conformance::steps_are_those_of_the_definition,
    conformance::steps_of_many_cells_are_those_of_the_definition,
    conformance::motions_converge_to_the_exact_ones,
    conformance::batches_change_not_a_bit,
    conformance::batches_allocate_nothing,
    work_is_counted,
    conformance::a_refused_trial_leaves_the_machine_usable,
    a_machine_without_a_program_refuses,
];

#[test]
fn a_machine_without_a_mistake_keeps_every_law() {
    for (number, law) in LAWS.into_iter().enumerate() {
        assert!(!notices(law, Mistake::None), "law {number}");
    }
}

#[test]
fn a_machine_that_fails_or_takes_no_step_breaks_every_law() {
    for mistake in [Mistake::FailsEveryStep, Mistake::TakesNoStep] {
        for (number, law) in LAWS.into_iter().enumerate() {
            assert!(notices(law, mistake), "law {number}: {mistake:?}");
        }
    }
}

/// Every law detects at least one of the faults for which it exists.
#[test]
fn every_law_notices_the_machines_that_break_it() {
    let [
        definition,
        many,
        converge,
        batches,
        allocate,
        counted,
        usable,
        _,
    ] = LAWS;
    let of_definition = [
        Mistake::UpdatesBackwards,
        Mistake::WeightsExchanged,
        Mistake::EntryForgotten,
        Mistake::StartForgotten,
        Mistake::ClampsForgotten,
        Mistake::LastStepForgotten,
        Mistake::ConditionsForgotten,
        Mistake::CoefficientOff,
        Mistake::CountsTooMuch,
    ];
    for mistake in of_definition {
        assert!(notices(definition, mistake), "definition: {mistake:?}");
    }
    for mistake in [Mistake::UpdatesBackwards, Mistake::CoefficientOff] {
        assert!(notices(many, mistake), "many cells: {mistake:?}");
    }
    // Updates in the wrong order are forward Euler in the place of symplectic Euler, of the same
    // order, and a leapfrog of order 1 instead of 2.
    for mistake in [Mistake::UpdatesBackwards, Mistake::StartForgotten] {
        assert!(notices(converge, mistake), "convergence: {mistake:?}");
    }
    let of_batches = [Mistake::EntryForgotten, Mistake::RoundsWhenABatchBegins];
    for mistake in of_batches {
        assert!(notices(batches, mistake), "batches: {mistake:?}");
    }
    assert!(notices(allocate, Mistake::Allocates));
    let of_counts = [
        Mistake::CountsTooMuch,
        Mistake::ClampsForgotten,
        Mistake::StartForgotten,
        Mistake::RepeatsForgotten,
    ];
    for mistake in of_counts {
        assert!(notices(counted, mistake), "counts: {mistake:?}");
    }
    for mistake in [Mistake::StopsAfterARefusal, Mistake::HidesARefusal] {
        assert!(notices(usable, mistake), "refusals: {mistake:?}");
    }
}
