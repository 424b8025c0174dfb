//! Newton's method with conjugate gradients, compared with the same method with a factor.

use crate::common::tissue::{body, held};
use crate::common::{advance, build, plain, relative_error};
use sinew_core::{Fact, Integrator, Options, State, StepError, StepReport, System};
use sinew_fem::hyperelastic::Parameters;
use sinew_fem::{Element, Law, LoadKind, LoadSpec, Model, Problem, Rayleigh};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

const METHODS: [&str; 3] = ["newmark", "generalized-alpha", "implicit-euler"];

const ELEMENTS: [Element; 3] = [
    Element::P1,
    Element::Fbar { patch: None },
    Element::FbarEdge {
        edge_share: 0.9,
        patch: None,
    },
];

fn cube(cells: usize) -> TetMesh {
    structured::cube(cells, 0.1, Split::Kuhn).unwrap()
}

/// A neo-Hookean body of this Poisson's ratio, fixed at its bottom.
fn tissue(poissons_ratio: f64, element: Element) -> Problem {
    let parameters = Parameters::new(3500.0, poissons_ratio);
    let mut problem = body(Law::hyperelastic("neo-hookean", parameters));
    problem.regions[0].element = element;
    problem.fixed = vec![held("bottom", [true; 3])];
    problem
}

/// [`tissue`] whose top is pulled with a traction (Pa) from t = 0 on.
fn pulled(poissons_ratio: f64, element: Element, traction: [f64; 3]) -> Problem {
    let mut problem = tissue(poissons_ratio, element);
    problem.loads = vec![LoadSpec::new("top", LoadKind::Traction(traction))];
    problem
}

fn with_factor(word: &str) -> Options {
    plain().with_text("factor", word)
}

/// Displacements after each step, and the work.
fn run(
    integrator: &mut dyn Integrator,
    model: &Model,
    steps: usize,
    dt: f64,
) -> Result<(Vec<Vec<f64>>, StepReport), StepError> {
    let mut state = State::at_rest(model.dofs());
    let (mut seen, mut work) = (Vec::new(), StepReport::default());
    for _ in 0..steps {
        work += integrator.step(model, &mut state, dt)?;
        seen.push(state.u.clone());
    }
    Ok((seen, work))
}

/// The motion with an option equals that with a factor, and uses no factor.
#[track_caller]
fn assert_same(model: &Model, method: &str, factor: &str, (steps, dt): (usize, f64), most: f64) {
    let (expected, work) = run(
        &mut *build(method, &with_factor("always")),
        model,
        steps,
        dt,
    )
    .unwrap();
    assert!(work.factorizations >= steps as u64);
    let mut integrator = build(method, &with_factor(factor));
    let (found, work) = run(&mut *integrator, model, steps, dt).unwrap();
    assert_eq!(
        (work.factorizations, work.solves),
        (0, 0),
        "`{method}` {dt}"
    );
    let off = relative_error(&found, &expected);
    assert!(off < most, "`{method}`, {factor}, {dt} s: {off:e}");
    let is_count = |fact: &Fact| fact.name == "gradient_iterations_a_solution" && fact.value >= 1.0;
    assert!(integrator.facts().iter().any(is_count));
}

#[test]
fn motions_are_those_with_a_factor_to_the_tolerance() {
    for element in ELEMENTS {
        let problem = pulled(0.45, element, [0.0, 0.0, 600.0]);
        let model = Model::build(&cube(4), &problem).unwrap();
        for dt in [1e-3, 5e-3, 16e-3] {
            for method in METHODS {
                assert_same(&model, method, "never", (12, dt), 5e-6);
            }
            assert_same(&model, "newmark", "auto", (12, dt), 5e-6);
        }
    }
}

/// Iterations handle the unsymmetric terms that damping and loads add to the derivative.
#[test]
fn so_are_they_under_stiffness_damping_and_pressure_that_follows_the_surface() {
    for element in ELEMENTS {
        let mut problem = tissue(0.45, element);
        problem.damping = Rayleigh::new(2.0, 4e-3);
        problem.loads = vec![
            LoadSpec::new("top", LoadKind::FollowingPressure(900.0)),
            LoadSpec::new("top", LoadKind::Traction([200.0, 0.0, 0.0])),
        ];
        let model = Model::build(&cube(3), &problem).unwrap();
        for dt in [1e-3, 5e-3, 16e-3] {
            for method in METHODS {
                assert_same(&model, method, "auto", (12, dt), 5e-6);
            }
        }
    }
}

#[test]
fn nearly_incompressible_tissue_in_long_steps_takes_a_factor_by_name() {
    let problem = pulled(0.4999, Element::P1, [0.0, 0.0, 600.0]);
    let model = Model::build(&cube(4), &problem).unwrap();
    let mut by_itself = build("newmark", &plain());
    let (found, work) = run(&mut *by_itself, &model, 6, 0.016).unwrap();
    assert!(work.factorizations >= 6, "{work:?}");
    let remarks = by_itself.remarks().join("\n");
    let reason = "each iteration made a factor: conjugate gradients would take longer in steps of this length on this body";
    assert!(remarks.contains(reason), "{remarks}");
    let mut always = build("newmark", &with_factor("always"));
    assert_eq!(run(&mut *always, &model, 6, 0.016).unwrap().0, found);
}

/// A column that a dead load bends far: during the motion the tangent is indefinite in long steps.
#[test]
fn a_column_that_buckles_comes_to_the_same_rest() {
    let mesh = structured::block([2, 2, 12], [0.02, 0.02, 0.12], Split::Mirrored).unwrap();
    let mut problem = pulled(0.45, Element::P1, [0.01, 0.0, -400.0]);
    problem.damping = Rayleigh::new(5.0, 0.0);
    let model = Model::build(&mesh, &problem).unwrap();
    let at_end = |factor: &str| {
        let mut integrator = build("implicit-euler", &with_factor(factor));
        let (seen, work) = run(&mut *integrator, &model, 60, 0.1).unwrap();
        (seen[59..].to_vec(), work)
    };
    let (expected, work) = at_end("always");
    assert!(work.projected_solves > 0, "{work:?}");
    let aside = expected[0]
        .iter()
        .fold(0.0_f64, |most, u| most.max(u.abs()));
    assert!(aside > 0.05, "{aside} m");
    for factor in ["auto", "never"] {
        let (found, _) = at_end(factor);
        let off = relative_error(&found, &expected);
        assert!(off < 1e-5, "{factor}: {off:e}");
    }
}

#[test]
fn a_run_continued_from_a_saved_state_has_the_same_bits() {
    for (dt, word) in [(2.5e-3, "auto"), (16e-3, "auto"), (16e-3, "never")] {
        let problem = pulled(0.45, ELEMENTS[2], [300.0, 0.0, 600.0]);
        let model = Model::build(&cube(3), &problem).unwrap();
        for method in METHODS {
            let built = || build(method, &with_factor(word));
            let (mut whole, mut state) = (built(), State::at_rest(model.dofs()));
            advance(&mut *whole, &model, &mut state, 8, dt);
            let saved = state.to_bytes(&model).unwrap();
            advance(&mut *whole, &model, &mut state, 8, dt);
            let mut again = State::from_bytes(&saved, &model).unwrap();
            advance(&mut *built(), &model, &mut again, 8, dt);
            assert_eq!(again, state, "`{method}`, {word}, {dt} s");
        }
    }
}

/// Conjugate gradients are the only solver if no memory can contain a factor of the body.
#[test]
fn without_memory_for_a_factor_steps_go_on() {
    let problem = pulled(0.4999, Element::P1, [0.0, 0.0, 600.0]);
    let model = Model::build(&cube(4), &problem).unwrap();
    let none = sinew_integrators::Memory::of(1000);
    let never = run(
        &mut *build("newmark", &with_factor("never")),
        &model,
        3,
        0.016,
    )
    .unwrap();
    none.within(|| {
        let by_itself = run(&mut *build("newmark", &plain()), &model, 3, 0.016).unwrap();
        assert_eq!(by_itself.0, never.0);
        let refused = run(
            &mut *build("newmark", &with_factor("always")),
            &model,
            3,
            0.016,
        );
        assert!(refused.is_err());
    });
}
