//! Runs of viscoelastic tissue: creep, continued runs, static states, and refused inputs.

use crate::common::build;
use crate::common::tissue::body;
use sinew_core::{Inputs, Options, State, System};
use sinew_fem::hyperelastic::Parameters;
use sinew_fem::hyperelastic::fibres::{Fibres, Stiffening};
use sinew_fem::hyperelastic::prony::Term;
use sinew_fem::{
    Element, FibreFamily, Fixed, Law, LoadKind, LoadSpec, Memory, Model, Moduli, On, Problem,
    ViscousPart,
};
use sinew_integrators::static_solution_under;
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

const YOUNGS_MODULUS: f64 = 3500.0;
/// Share that relaxes, and its time (s).
const SHARE: f64 = 0.5;
const TIME: f64 = 1.0;
const LENGTH: f64 = 0.04;
/// Stress that pulls the bar (Pa).
const PULL: f64 = 3.5;

fn bar() -> TetMesh {
    structured::block([1, 1, 4], [0.01, 0.01, LENGTH], Split::Kuhn).unwrap()
}

/// A bar whose sides are free to move, pulled at its top from t = 0 on.
fn pulled(mesh: &TetMesh, element: Element) -> Problem {
    let mut problem = body(Law::hyperelastic(
        "neo-hookean",
        Parameters::new(YOUNGS_MODULUS, 0.3),
    ));
    problem.regions[0].element = element;
    problem.regions[0].tissue.memory = Some(Memory {
        terms: vec![Term {
            share: SHARE,
            time: TIME,
        }],
        part: ViscousPart::All,
        moduli: Moduli::Instantaneous,
    });
    problem.fixed = (0..3)
        .map(|axis| {
            Fixed::at(On::Nodes(
                (0..)
                    .zip(&mesh.points)
                    .filter(|(_, point)| point[axis] < 1e-9)
                    .map(|(node, _)| node)
                    .collect(),
            ))
            .along([0, 1, 2].map(|of| of == axis))
        })
        .collect();
    problem.loads = vec![LoadSpec::new("top", LoadKind::Traction([0.0, 0.0, PULL]))];
    problem.damping.mass = 40.0;
    problem
}

fn at_rest(model: &Model) -> State {
    let mut state = State::at_rest(model.dofs());
    state.internal = vec![0.0; model.internal_variables()];
    state
}

/// The mean displacement (m) of the top along the bar.
fn top(mesh: &TetMesh, model: &Model, u: &[f64]) -> f64 {
    let mut nodes = vec![[0.0; 3]; mesh.points.len()];
    model.to_nodes(u, &mut nodes).unwrap();
    let ends = nodes.iter().zip(&mesh.points);
    let ends = ends.filter(|(_, point)| point[2] > LENGTH - 1e-9);
    let ends: Vec<f64> = ends.map(|(u, _)| u[2]).collect();
    ends.iter().sum::<f64>() / ends.len() as f64
}

/// `1/(E (1 - g)) (1 - g exp(-(1 - g) t/tau))`: the strain per stress (1/Pa) of a bar under a constant stress from t =
/// 0 on, for a solid whose stress relaxes as `E (1 - g + g exp(-t/tau))` (Christensen, Theory of Viscoelasticity,
/// 1982).
fn compliance(t: f64) -> f64 {
    let left = 1.0 - SHARE;
    (1.0 - SHARE * f64::exp(-left * t / TIME)) / (YOUNGS_MODULUS * left)
}

/// Remaining vibration, the effect of mass damping and the square of the strain are each below one per cent.
#[test]
fn a_bar_under_a_constant_load_creeps_as_the_standard_linear_solid() {
    let mesh = bar();
    let edges = Element::FbarEdge {
        edge_share: 0.9,
        patch: None,
    };
    let auto = Options::new().with_text("substeps", "auto");
    for (id, element, options, dt) in [
        ("central-difference", Element::P1, &auto, 0.01),
        ("rk4", Element::Fbar { patch: None }, &auto, 0.01),
        ("newmark", edges, &Options::new(), 0.01),
        ("generalized-alpha", Element::P1, &Options::new(), 0.01),
        ("implicit-euler", Element::P1, &Options::new(), 0.005),
    ] {
        let model = Model::build(&mesh, &pulled(&mesh, element)).unwrap();
        let (mut integrator, mut state) = (build(id, options), at_rest(&model));
        for until in [0.5, 1.0, 2.0] {
            while state.t() < until - 1e-9 {
                integrator.step(&model, &mut state, dt).unwrap();
            }
            let found = top(&mesh, &model, &state.u) / LENGTH / PULL;
            let ratio = found / compliance(until);
            assert!((ratio - 1.0).abs() < 0.008, "`{id}` at {until} s: {ratio}");
        }
    }
}

/// The bytes of a state half way contain all data on which the rest of the run depends.
#[test]
fn a_run_that_goes_on_from_bytes_has_the_bits_of_one_that_never_ended() {
    let mesh = bar();
    let auto = Options::new().with_text("substeps", "auto");
    for (id, options) in [
        ("central-difference", &auto),
        ("symplectic-euler", &auto),
        ("newmark", &Options::new()),
        ("generalized-alpha", &Options::new()),
        ("implicit-euler", &Options::new()),
    ] {
        let mut problem = pulled(&mesh, Element::Fbar { patch: None });
        problem.regions[0].tissue.fibres = vec![FibreFamily::new(
            Fibres::new(Stiffening::Quadratic { eta: 2000.0 }).unwrap(),
            [0.0, 0.0, 1.0],
        )];
        problem.loads[0].kind = LoadKind::Traction([0.0, 0.0, 500.0]);
        let model = Model::build(&mesh, &problem).unwrap();
        let (mut integrator, mut state) = (build(id, options), at_rest(&model));
        let mut bytes = Vec::new();
        for step in 0..40 {
            if step == 17 {
                bytes = state.to_bytes(&model).unwrap();
            }
            integrator.step(&model, &mut state, 0.004).unwrap();
        }
        let model = Model::build(&mesh, &problem).unwrap();
        let mut again = State::from_bytes(&bytes, &model).unwrap();
        let mut integrator = build(id, options);
        for _ in 17..40 {
            integrator.step(&model, &mut again, 0.004).unwrap();
        }
        assert!(again == state, "`{id}`");
        assert!(state.internal.iter().any(|value| *value != 0.0));
    }
}

/// Nothing moves if the initial state is the static one, which is fully relaxed.
#[test]
fn a_static_state_is_one_that_is_held_until_all_has_relaxed() {
    let mesh = bar();
    let model = Model::build(&mesh, &pulled(&mesh, Element::P1)).unwrap();
    let u = static_solution_under(&model, &model.full_loads(&[0])).unwrap();
    let strain = top(&mesh, &model, &u) / LENGTH;
    let expected = PULL / (YOUNGS_MODULUS * (1.0 - SHARE));
    assert!((strain / expected - 1.0).abs() < 0.004, "{strain}");
    let mut state = at_rest(&model);
    state.u.clone_from(&u);
    model
        .accept(&mut state, Inputs::none(), f64::INFINITY)
        .unwrap();
    let mut integrator = build("newmark", &Options::new());
    for _ in 0..50 {
        integrator.step(&model, &mut state, 0.01).unwrap();
    }
    let later = top(&mesh, &model, &state.u) / LENGTH;
    assert!((later / strain - 1.0).abs() < 1e-6, "{later}, {strain}");
}

#[test]
fn the_network_that_trusts_energies_refuses_memory_and_names_what_does_not() {
    let mesh = bar();
    let model = Model::build(&mesh, &pulled(&mesh, Element::P1)).unwrap();
    let mut integrator = build("cnn-energy", &Options::new());
    let error = integrator.prepare(&model, 0.01).unwrap_err().to_string();
    assert!(
        error.contains("stress that relaxes has none") && error.contains("`newmark`"),
        "{error}"
    );
}
