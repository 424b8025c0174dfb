//! Steps that a system refuses.

use std::sync::Arc;

use sinew_core::{
    Batch, EvaluationError, ForceLaw, ForceModel, Inputs, Layers, LinearModel, LinearSystem,
    LoadOverStep, LoadTime, State, StepError, Trial, VelocityTime,
};

use super::run::{bits, largest};
use super::systems::{Changing, Damped, Kind, SMALL, case};
use super::{Make, Method};
use crate::Machine;
use crate::program::{LoadAt, Physics, Program, Register};

/// A step that a system refuses ends the batch with its error, and the machine then continues from another state as if
/// nothing had happened.
pub fn a_refused_trial_leaves_the_machine_usable(methods: &[Method], make: &Make) {
    let kind = Kind {
        layers: Layers::Three,
        damped: Damped::ByMass,
        changing: Changing::Not,
        held: false,
        cells: SMALL,
    };
    let case = case(kind, 0.2, LoadOverStep::Any);
    let bound = 100.0 * largest(&case.start.u);
    let inner = case.system;
    let system = ForceModel::like(&inner.clone(), Refusing { bound, inner });
    let (u, v) = (Register::U, Register::V);
    let mut two_sweeps = Program::new(VelocityTime::Same);
    let stage = two_sweeps.register("stage");
    let physics = Physics::of(&system);
    let first = two_sweeps.net_force(&physics, u, v, LoadAt::Within(0.0));
    let second = two_sweeps.net_force(&physics, stage, v, LoadAt::Within(0.5));
    two_sweeps.step = vec![
        first.then(stage.becomes([(u, 1.0), (v, case.dt / 2.0)])),
        second.then(v.plus_q(case.dt)).then(u.plus(case.dt, v)),
    ];
    let mut programs = vec![("two sweeps".to_owned(), two_sweeps, false)];
    for method in methods {
        if let Some(program) = (method.program)(&system, case.dt) {
            programs.push((method.name.clone(), program, method.bounds));
        }
    }
    for (name, program, bounds) in programs {
        let program = Arc::new(program);
        let run = |machine: &mut dyn Machine, start: &State| {
            let mut state = start.clone();
            let mut batch = Batch::new(&system, Inputs::none(), case.dt, 10);
            let done = machine.run(&mut batch, &mut state);
            (done, state, batch.work())
        };
        let mut machine = make();
        machine.load(Arc::clone(&program), &system);
        let mut wild = case.start.clone();
        // A bounded motion gets beyond the bound in no step: it has to begin there.
        let wildly = if bounds { &mut wild.u } else { &mut wild.v };
        wildly.iter_mut().for_each(|value| *value *= 1e6);
        let (refused, ..) = run(&mut *machine, &wild);
        assert!(
            matches!(refused, Err(StepError::Refused { .. })),
            "{name}: {refused:?} beyond the law's domain"
        );
        let (done, state, work) = run(&mut *machine, &case.start);
        assert!(done.is_ok(), "{name}: {done:?} after a refused step");
        let mut fresh = make();
        fresh.load(Arc::clone(&program), &system);
        let (_, expected, expected_work) = run(&mut *fresh, &case.start);
        assert_eq!(bits(&state.u), bits(&expected.u), "{name}: u");
        assert_eq!(bits(&state.v), bits(&expected.v), "{name}: v");
        assert_eq!(work, expected_work, "{name}: work");
    }
}

/// A machine without a program takes no step, and returns an error.
pub fn a_machine_without_a_program_refuses(make: &Make) {
    let kind = Kind {
        layers: Layers::Three,
        damped: Damped::ByMass,
        changing: Changing::Not,
        held: false,
        cells: SMALL,
    };
    let case = case(kind, 0.2, LoadOverStep::Any);
    let mut state = case.start.clone();
    let mut batch = Batch::new(&case.system, Inputs::none(), case.dt, 3);
    let done = make().run(&mut batch, &mut state);
    assert!(matches!(done, Err(StepError::NotPrepared)), "{done:?}");
    assert_eq!(batch.taken(), 0, "steps taken");
    assert_eq!(bits(&state.u), bits(&case.start.u), "u");
}

/// The forces of a linear system, refused beyond a displacement (m).
struct Refusing {
    bound: f64,
    inner: LinearModel,
}

impl ForceLaw for Refusing {
    fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        if let Some(element) = trial.u.iter().position(|u| u.abs() > self.bound) {
            // What a law leaves behind when it refuses is nobody's business.
            out.fill(f64::NAN);
            return Err(EvaluationError {
                element: element as u64,
                reason: format!("a displacement beyond {} m", self.bound),
            });
        }
        self.inner
            .operators()
            .net_force(trial.load, trial.u, trial.v, out);
        Ok(())
    }

    fn external_force(&self, when: LoadTime<'_>, _u: &[f64], out: &mut [f64]) {
        self.inner.operators().external_force(when, out);
    }

    fn mass_damping(&self) -> f64 {
        self.inner.operators().damping().mass
    }
}
