//! Changes during a run cost no more than the changed part: other loads cost nothing, other rows cost those rows.

use std::sync::Arc;

use crate::common::build;
use crate::common::cube::cube;
use sinew_core::{
    Acceleration, ElementStiffness, LinearModel, LinearOperators, LinearSystem, Load, Options,
    Ramp, SetupError, State, StepError, StepReport, System, VelocityTime,
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

/// A spring between two neighbouring cells, made `by` stiffer along x.
fn stiffer(operators: &LinearOperators, by: f64) -> ElementStiffness {
    let first = 0_u32;
    let neighbours = operators.stiffness().pattern().neighbours(0);
    let second = *neighbours.iter().find(|cell| **cell != first).unwrap();
    let mut matrix = vec![0.0; 36];
    for (row, column, sign) in [(0, 0, 1.0), (0, 3, -1.0), (3, 0, -1.0), (3, 3, 1.0)] {
        matrix[6 * row + column] = sign * by;
    }
    ElementStiffness {
        cells: vec![first, second],
        matrix,
    }
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
fn other_rows_cost_those_rows_and_give_what_a_fresh_start_gives() {
    for id in sinew_integrators::ids() {
        let mut system = loaded(&operators(), 0.1);
        let mut integrator = build(id, &Options::new());
        let mut state = State::at_rest(system.dofs());
        integrator.step(&system, &mut state, DT).unwrap();
        let element = stiffer(system.operators(), 50.0);
        let before = system.revision();
        let changed = system.operators_mut();
        let last = changed.dofs() as u32 - 1;
        changed.add_elements(&[element], &[(last, 1e-4)]).unwrap();
        assert_ne!(system.revision(), before);
        assert_eq!(system.operators().changed_since(before).unwrap().len(), 3);

        let mut fresh_state = state.clone();
        let work = integrator.prepare(&system, DT).unwrap();
        match id {
            "forward-euler" | "symplectic-euler" | "central-difference" | "rk4"
            | "modified-leapfrog" | "cnn" | "cnn-symplectic" => assert_eq!(
                work,
                StepReport {
                    cells_set_up: 3,
                    ..StepReport::default()
                },
                "`{id}`"
            ),
            "implicit-euler" | "newmark" | "generalized-alpha" => {
                assert_eq!(work.factorizations, 1, "`{id}`");
            }
            _ => {}
        }
        let mut fresh = build(id, &Options::new());
        for _ in 0..3 {
            integrator.step(&system, &mut state, DT).unwrap();
            fresh.step(&system, &mut fresh_state, DT).unwrap();
        }
        assert_eq!(state, fresh_state, "`{id}`");
    }
}

#[test]
fn a_clone_keeps_its_rows() {
    let mut operators = operators();
    let before = operators.clone();
    let element = stiffer(&operators, 50.0);
    operators.add_elements(&[element], &[]).unwrap();
    assert_ne!(
        operators.stiffness().block(0, 0),
        before.stiffness().block(0, 0)
    );
    assert_eq!(
        before.stiffness().block(0, 0),
        cube(3).operators().stiffness().block(0, 0)
    );
    assert_eq!(operators.changed_since(operators.revision()), None);
}

#[test]
fn a_change_that_does_not_fit_changes_nothing() {
    let mut operators = operators();
    let (revision, sound) = (operators.revision(), stiffer(&operators, 1.0));
    let mut wrong = sound.clone();
    wrong.matrix.pop();
    let beyond = operators.dofs() as u32;
    assert!(
        operators
            .add_elements(&[sound.clone(), wrong], &[])
            .is_err()
    );
    assert!(
        operators
            .add_elements(std::slice::from_ref(&sound), &[(beyond, 1.0)])
            .is_err()
    );
    let mut endless = sound.clone();
    endless.matrix[3] = f64::INFINITY;
    assert!(operators.add_elements(&[endless], &[]).is_err());
    assert!(operators.add_elements(&[sound], &[(0, f64::NAN)]).is_err());
    assert_eq!(operators.revision(), revision);
    assert_eq!(
        operators.stiffness().block(0, 0),
        cube(3).operators().stiffness().block(0, 0)
    );
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
fn so_are_loads_that_are_replaced_together_with_rows() {
    let first = loaded(&operators(), 0.1);
    for id in sinew_integrators::ids() {
        let mut integrator = build(id, &Options::new());
        let mut state = State::at_rest(first.dofs());
        integrator.step(&first, &mut state, DT).unwrap();
        let mut second = loaded(first.operators(), 0.2);
        let element = stiffer(second.operators(), 50.0);
        second
            .operators_mut()
            .add_elements(&[element], &[])
            .unwrap();
        let staggered = state.velocity != VelocityTime::Same;
        let result = integrator.step(&second, &mut state, DT);
        let refused = matches!(result, Err(StepError::Setup(SetupError::OtherLoads { .. })));
        assert_eq!(refused, staggered, "`{id}`: {result:?}");
    }
}

#[cfg(feature = "implicit")]
#[test]
fn an_acceleration_is_not_kept_over_a_change_of_rows() {
    for id in ["newmark", "generalized-alpha"] {
        let mut system = loaded(&operators(), 0.1);
        let mut integrator = build(id, &Options::new());
        let mut state = State::at_rest(system.dofs());
        integrator.step(&system, &mut state, DT).unwrap();
        assert_eq!(state.acceleration, Acceleration::Same);
        let element = stiffer(system.operators(), 50.0);
        system
            .operators_mut()
            .add_elements(&[element], &[])
            .unwrap();
        let mut forgotten = state.clone();
        forgotten.acceleration = Acceleration::None;
        integrator.step(&system, &mut state, DT).unwrap();
        integrator.step(&system, &mut forgotten, DT).unwrap();
        assert_eq!(state, forgotten, "`{id}`");
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
