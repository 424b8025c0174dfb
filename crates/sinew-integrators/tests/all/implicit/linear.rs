//! Implicit methods against dense arithmetic, the data that they keep between steps, and equilibria.

use crate::common::cube::cube;
use crate::common::dense_methods::{Dense, STEPS};
use crate::common::{advance, build, largest, plain};
use proptest::prelude::*;
use sinew_core::{
    LinearModel, LinearOperators, LinearSystem, Load, LoadTime, Ramp, StableStep, State,
    StepReport, System,
};
use sinew_integrators::static_solution;
use sinew_testkit::body::{Body, bodies_up_to, fastest_time};

/// The largest difference over the largest value.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    let difference: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    largest(&difference) / largest(b)
}

/// 0.1 to 10 times the scale of an explicit step.
fn steps() -> impl Strategy<Value = f64> {
    (-1.0..1.0).prop_map(|power| 10.0_f64.powf(power))
}

/// Takes the same steps with an integrator and in dense arithmetic; both are compared after each,
/// relative to the largest value of the run.
fn compare(id: &str, body: &Body, share: f64, dense: impl Fn(&Dense, &State, f64) -> Vec<State>) {
    let model = body.model();
    // The body's loads rise for half a second; over steps that are short beside that they are taken
    // at instants, as in the textbooks.
    let dt = (share * fastest_time(&model)).min(0.2);
    let mut state = body.state(&model, 1e-3, 1e-3 / dt);
    let expected = dense(&Dense::of(&model), &state, dt);
    let mut integrator = build(id, &plain());
    let mut found = Vec::new();
    for _ in 0..STEPS {
        integrator.step(&model, &mut state, dt).unwrap();
        found.push(state.clone());
    }
    for part in [
        |state: &State| state.u.clone(),
        |state: &State| state.v.clone(),
    ] {
        let all = |states: &[State]| states.iter().flat_map(part).collect::<Vec<f64>>();
        let distance = distance(&all(&found), &all(&expected));
        assert!(distance <= 1e-10, "{distance:e}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn newmark_is_the_dense_method(body in bodies_up_to(2), share in steps()) {
        compare("newmark", &body, share, Dense::newmark);
    }

    #[test]
    fn implicit_euler_is_the_dense_method(body in bodies_up_to(2), share in steps()) {
        compare("implicit-euler", &body, share, Dense::implicit_euler);
    }

    #[test]
    fn a_static_solution_carries_its_load(body in bodies_up_to(3)) {
        let body = body.on_the_ground();
        let model = body.model();
        let mut load = vec![0.0; model.dofs()];
        model.operators().external_force(LoadTime::at(1.0), &mut load);
        let u = static_solution(&model, &load).unwrap();
        let mut force = vec![0.0; model.dofs()];
        model.operators().stiffness().multiply(&u, &mut force);
        let distance = distance(&force, &load);
        prop_assert!(distance <= 1e-9, "{distance:e}");
    }

    #[test]
    fn a_body_that_nothing_holds_has_no_static_solution(body in bodies_up_to(3)) {
        let body = body.free();
        let model = body.model();
        let mut load = vec![0.0; model.dofs()];
        model.operators().external_force(LoadTime::at(1.0), &mut load);
        // Whether rounding lets the factorisation pass is a matter of luck.
        let refusal = static_solution(&model, &load).unwrap_err();
        let (message, hint) = (refusal.to_string(), "add supports that prevent all rigid motions");
        prop_assert!(message.ends_with(hint), "{message}");
    }
}

#[test]
fn a_load_of_another_size_is_refused() {
    let model = cube(3);
    let refusal = static_solution(&model, &[1.0; 3]).unwrap_err();
    assert_eq!(
        refusal.to_string(),
        "the load has 3 degrees of freedom, the system has 48"
    );
}

/// One factor serves as long as the step and the system stay; it is computed again when one changes.
#[test]
fn factors_are_kept() {
    let model = cube(3);
    let operators = model.operators();
    // The same matrices under another load are another system.
    let load = Load {
        ramp: Ramp::Step,
        entries: vec![(2, 1.0)],
    };
    let other_load = LinearModel::new(operators.clone().with_loads(vec![load]).unwrap());
    let other_size = cube(2);
    let same_matrices = LinearModel::new(operators.clone());
    for id in ["newmark", "implicit-euler", "generalized-alpha"] {
        let mut integrator = build(id, &plain());
        let mut work = |system: &dyn System, dt: f64| {
            let mut state = State::at_rest(system.dofs());
            let mut work = StepReport::default();
            for _ in 0..25 {
                work += integrator.step(system, &mut state, dt).unwrap();
            }
            assert_eq!(work.solves, 25, "`{id}`");
            work.factorizations
        };
        assert_eq!(work(&model, 0.01), 1, "`{id}`: the first");
        assert_eq!(
            work(&model, 0.01),
            0,
            "`{id}`: a new state of the same system"
        );
        assert_eq!(work(&same_matrices, 0.01), 0, "`{id}`: the same matrices");
        assert_eq!(work(&model, 0.02), 1, "`{id}`: another step");
        assert_eq!(work(&other_load, 0.02), 0, "`{id}`: another load");
        assert_eq!(work(&other_size, 0.02), 1, "`{id}`: a smaller one");
        assert_eq!(work(&model, 0.02), 1, "`{id}`: back again");

        let mut prepared = build(id, &plain());
        assert_eq!(prepared.prepare(&model, 0.01).unwrap().factorizations, 1);
        let mut state = State::at_rest(model.dofs());
        let step = prepared.step(&model, &mut state, 0.01).unwrap();
        assert_eq!(step.factorizations, 0, "`{id}`: prepared before");
    }
}

/// A factor that was made for other systems in between gives the same bits as a fresh one.
#[test]
fn what_a_factor_was_used_for_before_leaves_no_trace() {
    let (model, smaller) = (cube(3), cube(2));
    let operators = model.operators();
    let stiffer = {
        let mut stiffness = operators.stiffness().as_ref().clone();
        stiffness.scale_rows(&vec![4.0; model.dofs()]);
        let (mass, damping) = (operators.mass().to_vec(), operators.damping().clone());
        LinearModel::new(LinearOperators::new(mass, stiffness, damping, vec![]).unwrap())
    };
    for id in ["newmark", "implicit-euler", "generalized-alpha"] {
        let mut used = build(id, &plain());
        for system in [&stiffer as &dyn System, &smaller] {
            let mut state = State::at_rest(system.dofs());
            advance(&mut *used, system, &mut state, 3, 0.01);
        }
        let (mut one, mut other) = (State::at_rest(model.dofs()), State::at_rest(model.dofs()));
        advance(&mut *used, &model, &mut one, 10, 0.005);
        advance(&mut *build(id, &plain()), &model, &mut other, 10, 0.005);
        assert!(one == other, "`{id}`");
    }
}

/// Every method, implicit or not, comes to rest at K u = F.
#[test]
fn damped_motion_ends_at_the_static_solution() {
    let model = cube(4);
    let mut load = vec![0.0; model.dofs()];
    model
        .operators()
        .external_force(LoadTime::at(1.0), &mut load);
    let expected = static_solution(&model, &load).unwrap();
    for id in sinew_integrators::ids() {
        let mut integrator = build(id, &plain());
        let dt = match integrator.stable_step(&model).unwrap() {
            StableStep::UpTo(limit) => 0.9 * limit,
            _ => 0.02,
        };
        let mut state = State::at_rest(model.dofs());
        let steps = (12.0 / dt) as usize;
        advance(&mut *integrator, &model, &mut state, steps, dt);
        let distance = distance(&state.u, &expected);
        assert!(distance <= 1e-8, "`{id}`: {distance:e}");
    }
}
