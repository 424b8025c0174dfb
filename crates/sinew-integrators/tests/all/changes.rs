//! Tests that new loads during a run cost nothing if the method allows them, and are refused otherwise.

use std::sync::Arc;

use crate::common::build;
use crate::common::cube::cube;
use sinew_core::{
    Acceleration, LinearModel, LinearOperators, LinearSystem, Load, Options, Ramp, SetupError,
    State, StepError, StepReport, System, VelocityTime,
};

const DT: f64 = 1e-4;

fn loaded(operators: &LinearOperators, force: f64) -> LinearModel {
    let load = Load {
        ramp: Ramp::Step,
        entries: vec![(2, force)],
    };
    LinearModel::new(operators.with_loads(vec![load]).unwrap())
}

fn operators() -> LinearOperators {
    cube(3).operators().clone()
}

#[test]
fn another_load_costs_no_factor_and_no_set_up() {
    let operators = operators();
    let (first, second) = (loaded(&operators, 0.1), loaded(&operators, 0.2));
    assert!(Arc::ptr_eq(
        first.operators().stiffness(),
        second.operators().stiffness()
    ));
    assert_eq!(first.revision(), second.revision());
    for id in sinew_integrators::ids() {
        let mut integrator = build(id, &Options::new());
        integrator.prepare(&first, DT).unwrap();
        let work = integrator.prepare(&second, DT).unwrap();
        // Modes are chosen by the loads; series that know the number of loads are looked at again.
        let expected = match id {
            "modal" => continue,
            "propagator" => StepReport {
                cells_set_up: operators.stiffness().pattern().cells() as u64,
                ..StepReport::default()
            },
            _ => StepReport::default(),
        };
        assert_eq!(work, expected, "`{id}`");
    }
}

#[test]
fn loads_replaced_in_mid_run_are_refused_where_the_velocity_follows_from_those_before() {
    let operators = operators();
    let (first, second) = (loaded(&operators, 0.1), loaded(&operators, 0.2));
    for id in sinew_integrators::ids() {
        let mut integrator = build(id, &Options::new());
        let mut state = State::at_rest(first.dofs());
        for _ in 0..3 {
            integrator.step(&first, &mut state, DT).unwrap();
        }
        let staggered = state.velocity != VelocityTime::Same;
        let result = integrator.step(&second, &mut state, DT);
        let refused = matches!(result, Err(StepError::Setup(SetupError::OtherLoads { .. })));
        assert_eq!(refused, staggered, "`{id}`: {result:?}");
    }
}

#[test]
fn an_acceleration_of_another_size_is_refused() {
    let system = loaded(&operators(), 0.1);
    for id in sinew_integrators::ids() {
        let mut state = State::at_rest(system.dofs());
        state.acceleration = Acceleration::Same;
        let result = build(id, &Options::new()).step(&system, &mut state, DT);
        let refused = matches!(result, Err(StepError::Setup(SetupError::StateSize { .. })));
        assert!(refused, "`{id}`: {result:?}");
    }
}

#[test]
fn a_mean_velocity_of_long_steps_is_not_taken_for_one_at_an_instant() {
    use sinew_core::spectrum::critical_step;
    use sinew_core::{Inputs, OptionValue, SynchroniseError};
    let system = loaded(&operators(), 0.1);
    let limit = critical_step(system.operators());
    let options = Options::new().with("kind", OptionValue::Text("two-step".into()));
    for (factor, resolved) in [(0.5, true), (7.0, false)] {
        let mut state = State::at_rest(system.dofs());
        let mut two_step = build("propagator", &options);
        for _ in 0..3 {
            two_step.step(&system, &mut state, factor * limit).unwrap();
        }
        let mut work = vec![0.0; system.dofs()];
        let moved = state.synchronise(&system, Inputs::none(), &mut work);
        match resolved {
            true => assert_eq!(moved, Ok(true)),
            false => assert!(matches!(moved, Err(SynchroniseError::Mean { .. }))),
        }
    }
}
