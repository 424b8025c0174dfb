//! A machine that a program outside sinew's crates adds.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::common::cube::cube;
use sinew_cnn::{Machine, Program, ReferenceMachine};
use sinew_core::{Batch, Options, State, StepError, System};
use sinew_machines::{Kind, KnownMachine, PrecisionName, Unfit, register};

/// Number of steps that machines of this kind have taken.
static STEPS: AtomicUsize = AtomicUsize::new(0);

/// The reference machine, which counts steps.
#[derive(Debug, Default)]
struct Counting(ReferenceMachine);

impl Machine for Counting {
    fn name(&self) -> &'static str {
        "counting"
    }

    fn load(&mut self, program: Arc<Program>, system: &dyn System) {
        self.0.load(program, system);
    }

    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
        let before = batch.taken();
        let done = self.0.run(batch, state);
        STEPS.fetch_add(batch.taken() - before, Ordering::Relaxed);
        done
    }
}

const COUNTING: KnownMachine = KnownMachine {
    id: "counting",
    meaning: "plain loops that count",
    precisions: &[PrecisionName::F64],
    check: |_, system| match system.dofs() {
        1 => Err(Unfit::Other(
            "one degree of freedom is too few to count".into(),
        )),
        _ => Ok(()),
    },
    build: |_, _| Box::new(Counting::default()),
};

/// A machine that ends without an error and without a step.
#[derive(Debug)]
struct Idle;

impl Machine for Idle {
    fn name(&self) -> &'static str {
        "idle"
    }

    fn load(&mut self, _: Arc<Program>, _: &dyn System) {}

    fn run(&mut self, _: &mut Batch<'_>, _: &mut State) -> Result<(), StepError> {
        Ok(())
    }
}

#[test]
fn a_machine_that_is_added_runs_programs_by_its_id_and_refuses_in_its_own_words() {
    let kind = register(COUNTING).unwrap();
    assert_eq!(
        (Kind::of("counting"), kind.known().meaning),
        (Some(kind), COUNTING.meaning)
    );
    let again = register(COUNTING).unwrap_err().to_string();
    assert_eq!(
        again,
        "machine \"counting\": another kind has this id; take another"
    );
    assert!(
        register(KnownMachine {
            id: "auto",
            ..COUNTING
        })
        .is_err()
    );

    let on = |machine: &str| Options::new().with_text("machine", machine);
    let model = cube(3);
    let run = |machine: &str| {
        let mut method = sinew_integrators::build("central-difference", &on(machine)).unwrap();
        let mut state = State::at_rest(model.dofs());
        for _ in 0..5 {
            method.step(&model, &mut state, 1e-4).unwrap();
        }
        (state, method.kernel())
    };
    let (state, kernel) = run("counting");
    assert_eq!(
        (STEPS.load(Ordering::Relaxed), kernel.as_deref()),
        (5, Some("counting"))
    );
    assert_eq!(state, run("reference").0);

    let one = sinew_core::LinearOperators::oscillator(0.1, 100.0, 0.0).unwrap();
    let one = sinew_core::LinearModel::new(one);
    let mut method = sinew_integrators::build("central-difference", &on("counting")).unwrap();
    let refused = method.prepare(&one, 1e-4).unwrap_err().to_string();
    assert!(
        refused.contains("one degree of freedom is too few to count"),
        "{refused}"
    );

    let refused = |options: &Options| {
        let built = sinew_integrators::build("central-difference", options);
        built.err().unwrap().to_string()
    };
    let single = refused(&on("counting").with_text("precision", "f32"));
    assert!(
        single.ends_with("expected \"f64\", in which this machine computes"),
        "{single}"
    );
    let unknown = refused(&on("countin"));
    assert!(
        unknown.ends_with("or \"repeated\", or \"counting\""),
        "{unknown}"
    );

    // One that ends without an error and without a step is named. It is added last, since lists name all.
    let kind = KnownMachine {
        id: "idle",
        build: |_, _| Box::new(Idle),
        ..COUNTING
    };
    register(kind).unwrap();
    let options = Options::new().with_text("machine", "idle");
    let mut method = sinew_integrators::build("central-difference", &options).unwrap();
    let mut state = State::at_rest(model.dofs());
    let said = method
        .step(&model, &mut state, 1e-4)
        .unwrap_err()
        .to_string();
    assert!(said.starts_with("`idle` at t = 0 s: "), "{said}");
}
