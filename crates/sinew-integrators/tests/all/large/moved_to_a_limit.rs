//! A support that pulls tissue towards the limit of its law.

use crate::common::tissue::{body, held};
use crate::common::{build, plain};
use sinew_core::{Acceleration, ForceLaw, LoadTime, Ramp, State, StepError, System, Trial};
use sinew_fem::hyperelastic::Parameters;
use sinew_fem::{Course, Law, Model, Moving};
use sinew_mesh::structured::{self, Split};

/// A block of gent's law with Jm = 1/2 whose top is pulled up at `speed` (m/s).
fn pulled(speed: f64) -> Model {
    let parameters = Parameters::default()
        .with("shear_modulus", &[1200.0])
        .with("limit", &[0.5])
        .with("bulk_modulus", &[35000.0]);
    block(("gent", parameters), speed)
}

/// A block of 100 x 100 x 200 mm whose top moves up at `speed` (m/s).
fn block((law, parameters): (&'static str, Parameters), speed: f64) -> Model {
    let mesh = structured::block([1, 1, 2], [0.1, 0.1, 0.2], Split::Kuhn).unwrap();
    let mut problem = body(Law::hyperelastic(law, parameters));
    problem.fixed = vec![held("bottom", [true; 3])];
    let course = Course::new([0.0, 0.0, speed], Ramp::Linear);
    problem.moves = vec![Moving::new("top", [course])];
    Model::build(&mesh, &problem).unwrap()
}

/// The tissue in the middle of the block has to follow within the step in which the support moves: if it stays at rest,
/// or if it continues as before, elements at the support are beyond the limit. A completed step balances inertia and
/// forces at its end, which defines both methods.
#[test]
fn steps_of_a_moved_support_are_solved_though_both_first_guesses_leave_the_laws_domain() {
    let model = pulled(1.0);
    for (id, dt, steps) in [
        ("newmark", 0.01, 13),
        ("implicit-euler", 0.01, 13),
        ("newmark", 0.06, 2),
        ("implicit-euler", 0.06, 2),
    ] {
        let mut integrator = build(id, &plain().with_text("factor", "always"));
        let mut state = State::at_rest(model.dofs());
        for step in 1..=steps {
            let before = state.v.clone();
            integrator.step(&model, &mut state, dt).unwrap();
            let mut net = vec![0.0; model.dofs()];
            let trial = Trial::of(&state, LoadTime::at(state.t()));
            model.net_force(&trial, &mut net).unwrap();
            let acceleration = |i: usize| match state.acceleration {
                Acceleration::Same => state.a[i],
                _ => (state.v[i] - before[i]) / dt,
            };
            let largest = net.iter().fold(0.0_f64, |most, f: &f64| most.max(f.abs()));
            for (i, (net, mass)) in net.iter().zip(model.mass()).enumerate() {
                let left = net - mass * acceleration(i);
                assert!(
                    left.abs() <= 1e-5 * largest,
                    "`{id}`, step {step} of {dt} s: {left} of {largest} N"
                );
            }
        }
    }
}

/// A support that keeps moving ends the run with an error that names the element and the limit.
#[test]
fn a_support_that_no_tissue_can_follow_is_refused_with_the_element_and_the_limit() {
    let model = pulled(100.0);
    for id in ["newmark", "implicit-euler", "generalized-alpha"] {
        let (mut integrator, mut state) = (build(id, &plain()), State::at_rest(model.dofs()));
        let refused = (0..20).find_map(|_| integrator.step(&model, &mut state, 0.01).err());
        let Some(StepError::Refused { source, .. }) = refused else {
            panic!("`{id}`: {refused:?}");
        };
        assert_ne!(source.element, 0, "`{id}`");
        assert!(source.reason.contains("`gent` ends where"), "{source}");
    }
}

/// Brain tissue by Ogden's law, pressed to a tenth of its height.
#[test]
fn a_law_that_stiffens_without_end_ends_a_run_with_the_element_and_its_stretches() {
    let parameters = Parameters::default()
        .with("terms", &[670.0, -19.0])
        .with("bulk_modulus", &[148_000.0]);
    let model = block(("ogden", parameters), -1.0);
    let by_stiffness = plain().with_text("substeps", "auto");
    for (id, options) in [
        ("newmark", plain()),
        ("implicit-euler", plain()),
        ("central-difference", by_stiffness),
    ] {
        let (mut integrator, mut state) = (build(id, &options), State::at_rest(model.dofs()));
        let error = (0..100).find_map(|_| integrator.step(&model, &mut state, 0.002).err());
        let said = error.unwrap().to_string();
        assert!(
            said.contains("element ") && said.contains("with principal stretches from"),
            "{said}"
        );
    }
}
