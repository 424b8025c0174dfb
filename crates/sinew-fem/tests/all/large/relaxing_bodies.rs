//! Bodies whose stress relaxes: the closed forms of a Prony series, on every element, and tangents of a step.

use crate::common::{
    ELEMENTS, at_most, body, build, dot, held, max_abs, moved, relative_difference, uneven_cube,
    waves,
};
use sinew_core::{
    BlockMatrix, ElasticLaw, ForceLaw, Inputs, Layers, LoadTime, State, System, TangentKind, Trial,
};
use sinew_fem::hyperelastic::Hyperelastic;
use sinew_fem::hyperelastic::fibres::{Fibres, Stiffening};
use sinew_fem::hyperelastic::prony::Term;
use sinew_fem::{
    Cause, Element, FibreFamily, Law, Memory, Model, Moduli, Problem, Tissue, ViscousPart,
};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

fn series(pairs: &[(f64, f64)], part: ViscousPart) -> Memory {
    let terms = pairs.iter().map(|&(share, time)| Term { share, time });
    Memory {
        terms: terms.collect(),
        part,
        moduli: Moduli::Instantaneous,
    }
}

/// Shares of .3 and .2 that relax in .05 s and .5 s.
fn memory(part: ViscousPart) -> Memory {
    series(&[(0.3, 0.05), (0.2, 0.5)], part)
}

/// A problem with E = 3500 Pa and nu = .45.
fn of(id: &'static str, element: Element, memory: Option<Memory>) -> Problem {
    let parameters = Hyperelastic::parameters(id, 3500.0, 0.45).unwrap();
    let mut problem = body(Law::hyperelastic(id, parameters));
    problem.regions[0].element = element;
    problem.regions[0].tissue.memory = memory;
    problem
}

fn with_fibres(mut problem: Problem) -> Problem {
    problem.regions[0].tissue.fibres = vec![FibreFamily::new(
        Fibres::new(Stiffening::Quadratic { eta: 2000.0 }).unwrap(),
        [1.0, 0.0, 2.0],
    )];
    problem
}

/// Laws with all of their stress relaxing and with only a part, with and without fibres, on every element.
fn all() -> impl Iterator<Item = (String, Problem)> {
    let cases = [
        ("neo-hookean", ViscousPart::All, true),
        ("corotational", ViscousPart::All, false),
        ("mooney-rivlin", ViscousPart::Deviatoric, true),
        ("neo-hookean-iso", ViscousPart::Deviatoric, false),
    ];
    cases.into_iter().flat_map(|(id, part, is_fibrous)| {
        ELEMENTS.map(|element| {
            let problem = of(id, element, Some(memory(part)));
            let problem = if is_fibrous {
                with_fibres(problem)
            } else {
                problem
            };
            (format!("{id}, {part:?}, {element}"), problem)
        })
    })
}

fn bent(mesh: &TetMesh, model: &Model, size: f64) -> Vec<f64> {
    crate::common::on_cells(model, |node| {
        let [x, y, z] = mesh.points[node];
        [
            size * (0.03 * (25.0 * z).sin() - 0.2 * x + 2.0 * y * z),
            size * (0.02 * (31.0 * x + 8.0 * y).cos() - 0.3 * z),
            size * (0.25 * z + 0.15 * y + 3.0 * x * x),
        ]
    })
}

/// A state with the history variables of rest.
fn at_rest(model: &Model) -> State {
    let mut state = State::at_rest(model.dofs());
    state.internal = vec![0.0; model.internal_variables()];
    state
}

/// A state that was bent one way at once and another way after that.
fn used(mesh: &TetMesh, model: &Model) -> State {
    let mut state = at_rest(model);
    for (size, dt) in [(0.5, 0.0), (-0.2, 0.03), (0.3, 0.2)] {
        state.u = bent(mesh, model, size);
        model.accept(&mut state, Inputs::none(), dt).unwrap();
    }
    state
}

fn at<'a>(state: &'a State, u: &'a [f64], dt: f64) -> Trial<'a> {
    Trial {
        load: LoadTime::at(0.0),
        dt,
        u,
        v: &state.v,
        internal: &state.internal,
    }
}

const DT: f64 = 0.02;

fn elastic(model: &Model, state: &State, u: &[f64]) -> (f64, Vec<f64>) {
    let mut force = vec![0.0; u.len()];
    let found = model.elastic_force(&at(state, u, DT), &mut force).unwrap();
    (found.energy, force)
}

#[test]
fn in_a_step_forces_are_the_slope_of_an_energy_and_tangents_that_of_the_forces() {
    let mesh = uneven_cube();
    for (name, problem) in all() {
        let model = build(&mesh, &problem);
        let state = used(&mesh, &model);
        let u = bent(&mesh, &model, 0.6);
        let w = waves(u.len(), 1.7);
        let (_, force) = elastic(&model, &state, &u);
        let h = 1e-6;
        let before = elastic(&model, &state, &moved(&u, -h, &w));
        let after = elastic(&model, &state, &moved(&u, h, &w));
        let slope = (after.0 - before.0) / (2.0 * h);
        at_most(&name, (slope / dot(&force, &w) - 1.0).abs(), 2e-5);
        let ends = after.1.iter().zip(&before.1);
        let slope: Vec<f64> = ends.map(|(a, b)| (a - b) / (2.0 * h)).collect();
        let mut exact = vec![0.0; u.len()];
        let kind = TangentKind::Exact;
        let trial = at(&state, &u, DT);
        model.tangent_product(&trial, kind, &w, &mut exact).unwrap();
        at_most(&name, relative_difference(&exact, &slope), 1e-5);
    }
}

#[test]
fn tangents_with_memory_are_symmetric_and_definite_where_they_are_not_exact() {
    let mesh = uneven_cube();
    for (name, mut problem) in all() {
        problem.fixed = vec![held("bottom")];
        let model = build(&mesh, &problem);
        let state = used(&mesh, &model);
        let u = bent(&mesh, &model, 0.6);
        let (w, other) = (waves(u.len(), 1.3), waves(u.len(), 0.9));
        let trial = at(&state, &u, DT);
        for kind in [
            TangentKind::Exact,
            TangentKind::Projected,
            TangentKind::Frozen,
        ] {
            let mut matrix = BlockMatrix::zeros(model.pattern().clone(), Layers::Three);
            model.tangent(&trial, kind, &mut matrix).unwrap();
            let [mut by_matrix, mut by_product, mut back] = [(); 3].map(|()| vec![0.0; u.len()]);
            matrix.multiply(&w, &mut by_matrix);
            model
                .tangent_product(&trial, kind, &w, &mut by_product)
                .unwrap();
            at_most(&name, relative_difference(&by_matrix, &by_product), 1e-11);
            model
                .tangent_product(&trial, kind, &other, &mut back)
                .unwrap();
            let scale = dot(&by_product, &by_product).sqrt() * dot(&other, &other).sqrt();
            let difference = dot(&by_product, &other) - dot(&back, &w);
            at_most(&name, difference.abs() / scale, 1e-12);
            if kind != TangentKind::Exact {
                assert!(dot(&by_product, &w) >= 0.0 && dot(&back, &other) >= 0.0);
            }
        }
        let mut blocks = vec![0.0; 3 * u.len()];
        model.node_blocks(&trial, &mut blocks).unwrap();
        for block in blocks.chunks_exact(9) {
            let matrix = nalgebra::Matrix3::from_row_slice(block);
            assert!(matrix.symmetric_eigenvalues().min() > 0.0, "{name}");
        }
    }
}

fn stresses(model: &Model, state: &State) -> Vec<[f64; 6]> {
    let mut stress = vec![[0.0; 6]; model.mesh().tets.len()];
    let asked = model.with_memory(&state.internal);
    asked.stress(0.0, &state.u, &mut stress).unwrap();
    stress
}

/// Largest difference of two stresses, as a share of the largest stress.
fn apart(a: &[[f64; 6]], b: &[[f64; 6]]) -> f64 {
    let differences: Vec<f64> = a
        .as_flattened()
        .iter()
        .zip(b.as_flattened())
        .map(|(a, b)| a - b)
        .collect();
    max_abs(&differences) / max_abs(b.as_flattened())
}

/// A body under constant deformation for an infinite time has the long-term moduli. Its stresses, forces and energy
/// without history variables show them.
#[test]
fn in_the_long_term_a_body_has_the_long_term_moduli() {
    let mesh = uneven_cube();
    for element in ELEMENTS {
        let mut problem = of("neo-hookean", element, Some(memory(ViscousPart::All)));
        let model = build(&mesh, &problem);
        problem.regions[0].tissue = Tissue::default();
        problem.regions[0].law.scale_stiffness(0.5);
        let soft = build(&mesh, &problem);
        let mut state = used(&mesh, &model);
        model
            .accept(&mut state, Inputs::none(), f64::INFINITY)
            .unwrap();
        let mut expected = vec![[0.0; 6]; mesh.tets.len()];
        soft.stress(0.0, &state.u, &mut expected).unwrap();
        at_most("held", apart(&stresses(&model, &state), &expected), 1e-12);
        let mut without = vec![[0.0; 6]; mesh.tets.len()];
        model.stress(0.0, &state.u, &mut without).unwrap();
        at_most("asked without", apart(&without, &expected), 1e-12);
        let energy = |model: &Model| model.energy(&state.u, &state.v).unwrap().elastic;
        at_most(
            "energy",
            (energy(&model) / energy(&soft) - 1.0).abs(),
            1e-12,
        );
        // Given as long-term moduli they are these very ones.
        let mut longterm = memory(ViscousPart::All);
        longterm.moduli = Moduli::LongTerm;
        problem.regions[0].tissue.memory = Some(longterm);
        let again = build(&mesh, &problem);
        let mut at_once = vec![0.0; state.u.len()];
        let mut stated = at_once.clone();
        let rest = at_rest(&again);
        let trial = at(&rest, &state.u, 0.0);
        again.elastic_force(&trial, &mut at_once).unwrap();
        model.elastic_force(&trial, &mut stated).unwrap();
        at_most("at once", relative_difference(&at_once, &stated), 1e-12);
    }
}

#[test]
fn a_motion_as_one_leaves_memory_as_it_is() {
    let mesh = uneven_cube();
    let turned = |model: &Model, u: &[f64]| -> Vec<f64> {
        let (sin, cos) = 2.0_f64.sin_cos();
        crate::common::on_cells(model, |node| {
            let [x, y, z] = mesh.points[node];
            let [ux, uy, uz] = [0, 1, 2].map(|axis| u[3 * node + axis]);
            let [x1, y1, z1] = [x + ux, y + uy, z + uz];
            [cos * x1 - sin * y1 - x, sin * x1 + cos * y1 - y, z1 - z]
        })
    };
    for (name, problem) in all() {
        let model = build(&mesh, &problem);
        let mut state = used(&mesh, &model);
        let before = elastic(&model, &state, &state.u).1;
        let mut other = state.clone();
        other.u = turned(&model, &state.u);
        for state in [&mut state, &mut other] {
            model.accept(state, Inputs::none(), DT).unwrap();
        }
        let differences = moved(&state.internal, -1.0, &other.internal);
        at_most(
            &name,
            max_abs(&differences) / max_abs(&state.internal),
            1e-11,
        );
        assert!(max_abs(&before) > 0.0);
    }
}

#[test]
fn stress_that_relaxes_refuses_what_is_inverted_by_name() {
    let mesh = structured::cube(2, 0.1, Split::Kuhn).unwrap();
    for element in ELEMENTS {
        let memory = memory(ViscousPart::All);
        let model = build(
            &mesh,
            &of("stable-neo-hookean", element, Some(memory.clone())),
        );
        let state = at_rest(&model);
        let mut u = vec![0.0; model.dofs()];
        u[..3].fill(0.12);
        let mut out = vec![0.0; u.len()];
        let trial = at(&state, &u, DT);
        let kind = TangentKind::Exact;
        for answer in [
            model.net_force(&trial, &mut out),
            model.tangent_product(&trial, kind, &u, &mut out),
        ] {
            let error = answer.unwrap_err();
            assert!(error.element > 0 && error.reason.contains("stress that relaxes"));
        }
        // Nor is a state remembered that the elastic law has no stress for.
        let model = build(&mesh, &of("neo-hookean", element, Some(memory)));
        let mut state = at_rest(&model);
        state.u.clone_from(&u);
        let error = model.accept(&mut state, Inputs::none(), DT).unwrap_err();
        assert!(error.element > 0, "{error}");
    }
}

#[test]
fn series_that_are_none_are_refused() {
    let mesh = structured::cube(1, 0.1, Split::Kuhn).unwrap();
    let refused = |id, memory| {
        let error = Model::build(&mesh, &of(id, Element::P1, Some(memory))).unwrap_err();
        error.to_string()
    };
    let all = |pairs: &[(f64, f64)]| series(pairs, ViscousPart::All);
    let id = "neo-hookean";
    assert!(refused(id, all(&[(0.5, 1.0), (0.5, 2.0)])).contains("sum of shares = 1"));
    assert!(refused(id, all(&[(0.5, 0.0)])).contains("time = 0"));
    assert!(refused(id, all(&[])).contains("prony has 0 terms: expected 1 to 8"));
    assert!(refused(id, all(&[(0.01, 1.0); 9])).contains("prony has 9 terms"));
    let deviatoric = series(&[(0.5, 1.0)], ViscousPart::Deviatoric);
    assert!(refused(id, deviatoric).contains("no isochoric part that could relax alone"));
    let mut linear = of(id, Element::P1, Some(all(&[(0.5, 1.0)])));
    linear.regions[0].law = crate::common::linear(3500.0, 0.45);
    let error = Model::build(&mesh, &linear).unwrap_err();
    assert_eq!(*error.cause(), Cause::TissueOfSmallStrain);
}
