//! Loads that come after a million steps.

use sinew_core::{
    Integrator, LinearModel, LinearOperators, Load, Options, Ramp, Run, SetupError, SimulateError,
    StableStep, State, StepError, simulate,
};

const DT: f64 = 1e-3;
const SPRING: f64 = 100.0;
const FORCE: f64 = 3.0;
/// Steps before a late load, and steps from its start on.
const LATE: u32 = 1_000_000;
const AFTER: usize = 40;

fn oscillator(ramp: Ramp) -> LinearModel {
    let load = Load {
        ramp,
        entries: vec![(0, FORCE)],
    };
    let operators = LinearOperators::oscillator(0.5, SPRING, 5.0).unwrap();
    LinearModel::new(operators.with_loads(vec![load]).unwrap())
}

/// The displacement (m) after `steps` steps; `None` if the method refuses the load.
fn displacement(
    integrator: &mut dyn Integrator,
    system: &LinearModel,
    steps: usize,
) -> Option<f64> {
    let mut state = State::at_rest(1);
    let run = Run {
        dt: DT,
        steps,
        divergence_limit: f64::INFINITY,
    };
    match simulate(system, integrator, &mut state, &run, &mut ()) {
        Ok(_) => Some(state.u[0]),
        Err(SimulateError::Step(StepError::Inaccurate { .. })) => None,
        Err(error) => panic!("{error}"),
    }
}

fn methods() -> Vec<(String, Box<dyn sinew_integrators::Stepper>)> {
    let mut methods: Vec<_> = sinew_integrators::entries()
        .iter()
        .map(|entry| (entry.id.to_owned(), entry.build(&Options::new()).unwrap()))
        .collect();
    for kind in ["two-step", "krylov"] {
        let kind_of = sinew_core::OptionValue::Text(kind.into());
        let options = Options::new().with("kind", kind_of);
        let built = sinew_integrators::build("propagator", &options).unwrap();
        methods.push((format!("propagator {kind}"), built));
    }
    methods
}

#[test]
fn a_pulse_and_a_table_after_a_million_steps_do_what_early_ones_do() {
    let at = |step: u32| {
        let t = |steps: u32| f64::from(step + steps) * DT;
        let table = Ramp::Table {
            times: vec![t(0), t(4), t(6), t(13)],
            values: vec![0.0, 1.0, 1.0, 0.0],
        };
        let pulse = Ramp::Pulse {
            from: t(0),
            to: t(2),
        };
        [pulse, table].map(oscillator)
    };
    let (early, late) = (at(600), at(LATE));
    for (id, mut integrator) in methods() {
        for (early, late) in early.iter().zip(&late) {
            let Some(expected) = displacement(&mut *integrator, early, 600 + AFTER) else {
                assert!(id.starts_with("propagator"), "`{id}` refuses");
                continue;
            };
            let found = displacement(&mut *integrator, late, LATE as usize + AFTER);
            let found = found.unwrap_or_else(|| panic!("`{id}` refuses the late one"));
            assert!(expected.abs() > 1e-6, "`{id}`: {expected}");
            let off = (found / expected - 1.0).abs();
            assert!(off < 1e-8, "`{id}`: {found} for {expected}");
        }
    }
}

/// Each method receives one of the two loads, its neighbours in the list the other.
#[test]
fn what_comes_to_stay_is_there_after_a_million_steps() {
    let ramps = [Ramp::Step, Ramp::Sin2 { rise: 0.25 }].map(oscillator);
    for (number, (id, mut integrator)) in methods().into_iter().enumerate() {
        let system = &ramps[number % 2];
        if let Ok(StableStep::UpTo(limit)) = integrator.stable_step(system) {
            assert!(limit > DT, "`{id}`");
        }
        if let Err(SetupError::Unresolved { .. }) = integrator.prepare(system, DT) {
            continue;
        }
        let Some(found) = displacement(&mut *integrator, system, LATE as usize) else {
            assert!(id.starts_with("propagator"), "`{id}` refuses");
            continue;
        };
        let off = (found / (FORCE / SPRING) - 1.0).abs();
        assert!(off < 1e-9, "`{id}`: {found}");
    }
}
